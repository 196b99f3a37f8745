// Instances on the GPU: the same picture as copies, and names that no compiler minds.
#include "renderer/context.h"
#include "renderer/renderer.h"
#include "renderer/trace_program.h"
#include "sdf/codegen.h"
#include "sdf/edit.h"
#include "tests/gl_test.h"
#include "tests/test_support.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cctype>
#include <set>

namespace farfield {
namespace {

using InstancesOnGpu = GlTest;

/// Two kinds of pieces on a floor, one of them made of the other, with materials of their own and of the instances.
Scene pieces() {
    Scene scene;
    const Id dark = apply(scene, AddMaterial{{0, "dark", glm::vec3(0.2f, 0.3f, 0.6f)}});
    const Id light = apply(scene, AddMaterial{{0, "light", glm::vec3(0.9f, 0.7f, 0.4f)}});
    apply(scene, InsertNode{scene.root.id, -1, make_node(NodeKind::plane)});
    Node pawn = make_node(NodeKind::union_), body = make_node(NodeKind::capped_cone),
         head = make_node(NodeKind::sphere);
    pawn.name = "pawn";
    pawn.values[0].x = 0.1f;
    pawn.transform.translate = {-0.8f, 0.5f, 0.0f};
    head.values[0].x = 0.3f;
    head.transform.translate = {0.0f, 0.6f, 0.0f};
    head.material = light;
    pawn.children = {body, head};
    const Id made = apply(scene, InsertNode{scene.root.id, -1, pawn});
    apply(scene, SetMaterial{apply(scene, MakeDefinition{made}), dark});
    Node pair = make_node(NodeKind::repeat);
    pair.name = "row";
    pair.values = {{0.9f, 0.0f, 0.0f}, {2.0f, 0.0f, 0.0f}};
    pair.transform.translate = {0.9f, 0.4f, 0.3f};
    pair.children = {make_instance(scene.definitions[0])};
    pair.children[0].transform = {{0.0f, 0.0f, 0.1f}, {0.0f, 30.0f, 10.0f}, 0.7f};
    const Id first = apply(scene, MakeDefinition{apply(scene, InsertNode{scene.root.id, -1, pair})});
    apply(scene,
          InsertNode{scene.root.id, -1, make_instance(*find_definition(scene, find_node(scene, first)->definition))});
    apply(scene, SetMaterial{first, dark});
    apply(scene, AddLight{Light{}});
    return scene;
}

TEST_F(InstancesOnGpu, GiveThePictureOfTheirCopiesInEveryTier) {
    const Scene scene = pieces(), copies = expanded(scene);
    ASSERT_EQ(scene.definitions.size(), 2u);
    FrameOptions literals, live, tuned;
    live.tier = Tier::live;
    tuned.tuned = scene.definitions[0].children[1].id;
    const auto picture = [&](const Scene& of, FrameOptions options, View view) {
        options.size = {64, 48};
        Renderer renderer;
        renderer.update(of, options);
        renderer.render_frame();
        return renderer.read(view);
    };
    for (const View view : {View::result, View::normals}) {
        const Image expected = picture(copies, literals, view);
        // Rounding differs, so single paths at edges may part ways; the picture must not.
        for (const FrameOptions& options : {literals, live, tuned})
            EXPECT_LE(compare(expected, picture(scene, options, view)).rmse, view == View::normals ? 2e-2 : 5e-3);
    }
}

TEST_F(InstancesOnGpu, EveryNameCompiles) {
    // All words of the program itself, keywords among them, and those that GLSL reserves.
    Scene scene = pieces();
    constexpr const char* kernels[] = {"trace.glsl", "surface.glsl"};
    std::string source;
    for (const char* kernel : kernels) source += scene_kernel_source(kernel, generate(scene, Tier::live));
    std::set<std::string> words{"gl_Position", "main", "sampler2D", "class", "template", "switch", "double", "highp",
                                "__LINE__",    "1st",  "no",        "scene", "ü",        "a\\",    "*/",     "\"q\""};
    std::string word;
    for (const char c : source + "\n") {
        if (std::isalnum(static_cast<unsigned char>(c)) || c == '_') {
            word += c;
            continue;
        }
        for (const char* end : {"", "_distance", "_surface", "_march"})
            if (const std::string_view ending = end; word.ends_with(ending) && word.size() > ending.size())
                words.insert(word.substr(0, word.size() - ending.size()));
        word.clear();
    }
    ASSERT_GT(words.size(), 200u);
    const Id light = scene.materials.back().id;
    for (const std::string& name : words) {
        Node group = make_node(NodeKind::union_);
        group.name = name;
        group.children = {make_node(NodeKind::sphere), make_node(NodeKind::box)};
        group.children[1].material = light;  // so that it has a function for the surface too
        group.id = scene.new_id();
        for (Node& child : group.children) child.id = scene.new_id();
        Node instance = make_instance(group);
        instance.id = scene.new_id();
        scene.definitions.push_back(group);
        // Called but once, and not at all by what is traced: every call would be inlined.
        scene.root.children.push_back(instance);
    }
    GeneratedScene generated = generate(scene, Tier::specialised);
    for (const char* kernel : kernels) {
        const std::string text = scene_kernel_source(kernel, generated);
        // The front end alone: what it accepts the driver can link.
        const GLuint shader = glCreateShader(GL_COMPUTE_SHADER);
        const char* pointer = text.c_str();
        glShaderSource(shader, 1, &pointer, nullptr);
        glCompileShader(shader);
        GLint compiled = GL_FALSE;
        glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
        char log[4096] = "";
        glGetShaderInfoLog(shader, sizeof log, nullptr, log);
        EXPECT_EQ(compiled, GL_TRUE) << kernel << ": " << log;
        glDeleteShader(shader);
    }
}

}  // namespace
}  // namespace farfield
