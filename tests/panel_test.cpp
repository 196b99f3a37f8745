// What the panels work out, without a window.
#include "sdf/codegen.h"
#include "sdf/pick.h"
#include "sdf/scene_file.h"
#include "tests/test_support.h"
#include "ui/glsl_tokens.h"
#include "ui/kind_menu.h"
#include "ui/number_field.h"
#include "ui/objects_panel.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <sstream>

namespace farfield {
namespace {

/// The line with each run in brackets and the first letter of what it is before them.
std::string marked(std::string_view line) {
    std::string text;
    const std::vector<GlslRun> runs = glsl_runs(line);
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const std::size_t end = i + 1 < runs.size() ? runs[i + 1].start : line.size();
        text += "pktnfc"[static_cast<int>(runs[i].token)];
        text += "[" + std::string(line.substr(runs[i].start, end - runs[i].start)) + "]";
    }
    return text;
}

TEST(GlslRuns, TellKeywordsTypesNumbersFunctionsAndComments) {
    EXPECT_EQ(marked(""), "");
    EXPECT_EQ(marked("    return d0;"), "p[    ]k[return]p[ d0;]");
    EXPECT_EQ(marked("float d1 = box(p2 - vec3(-1.5e-05, .2, 3u));  // a box(1)"),
              "t[float]p[ d1 = ]f[box]p[(p2 - ]t[vec3]p[(-]n[1.5e-05]p[, ]n[.2]p[, ]n[3u]p[));  ]c[// a box(1)]");
    EXPECT_EQ(marked("for (int i = 0; i < 0x1f; ++i)"), "k[for]p[ (]t[int]p[ i = ]n[0]p[; i < ]n[0x1f]p[; ++i)]");
    EXPECT_EQ(marked("vec3 returned = float3 - 1.0f-2.0;"), "t[vec3]p[ returned = float3 - ]n[1.0f]p[-]n[2.0]p[;]");
}

TEST(GlslRuns, CoverEveryLineOfGeneratedCode) {
    for (const char* name : {"still_life", "helix", "cornell"}) {
        std::istringstream text(
            generate(load_scene(std::string(FARFIELD_SCENES) + "/" + name + ".json"), Tier::live).text);
        for (std::string line; std::getline(text, line);) {
            const std::vector<GlslRun> runs = glsl_runs(line);
            ASSERT_EQ(runs.empty(), line.empty()) << line;
            for (std::size_t i = 0; i < runs.size(); ++i) {
                ASSERT_LT(runs[i].start, line.size()) << line;
                ASSERT_TRUE(i == 0 ? runs[i].start == 0 : runs[i].start > runs[i - 1].start) << line;
            }
        }
    }
}

TEST(TypedNumber, IsReadAsPeopleTypeIt) {
    EXPECT_EQ(typed_number("1.5", ""), 1.5f);
    EXPECT_EQ(typed_number(" +1.5 m ", "m"), 1.5f);
    EXPECT_EQ(typed_number("-16.6°", "°"), -16.6f);
    EXPECT_EQ(typed_number("0,25", "m"), 0.25f);
    EXPECT_EQ(typed_number("1e-3", ""), 1e-3f);
    EXPECT_EQ(typed_number("2*0.75", ""), 1.5f);
    EXPECT_EQ(typed_number("1 + 2 * 3 - 4 / 8 m", "m"), 6.5f);
    EXPECT_EQ(typed_number("-(1,5 - 3) * (2+(1))", ""), 4.5f);
    EXPECT_EQ(typed_number("360/7 °", "°"), 360.0f / 7.0f);
    EXPECT_EQ(typed_number("2*-3", ""), -6.0f);
    EXPECT_EQ(typed_number("1e2-1", ""), 99.0f);
    for (const char* text :
         {"",    " ",   "m",  "1.5 x", "1,000.5", "1,000,5", "+-1", "nan",         "inf", "1e99", "1/0",
          "0/0", "1 2", "2*", "(1",    "1)",      "()",      "*2",  "1e200*1e200", "--1", "0x10"})
        EXPECT_EQ(typed_number(text, "m"), std::nullopt) << text;
}

TEST(NewLight, IsSeenAndLightsWhatIsLookedAt) {
    std::mt19937 random(5);
    for (int i = 0; i < 200; ++i) {
        Scene scene;
        Camera& camera = scene.camera;
        const float size = std::pow(10.0f, static_cast<float>(i % 6) - 3.0f);
        for (const Field<Camera>& field : fields<Camera>())
            if (field.parameter.components() == 3) field.set(camera, size * random_value(field.parameter, random));
        if (i % 20 == 0) camera.target = camera.position;
        const Id id = apply(scene, AddLight{light_in_view(camera)});
        const Light& light = *find_light(scene, id);
        EXPECT_GT(light.intensity.x, 0.0f);
        if (i % 20 == 0 ||
            std::abs(camera.target.y - camera.position.y) > 0.9f * glm::distance(camera.target, camera.position))
            continue;
        const CameraBasis basis(camera);
        const glm::vec3 to = light.position - camera.position;
        const float depth = glm::dot(to, basis.forward);
        EXPECT_GT(depth, 0.0f);
        EXPECT_LT(std::abs(glm::dot(to, basis.up)), depth * basis.half_height);
        EXPECT_LT(std::abs(glm::dot(to, basis.right)), depth * basis.half_height);
        const float distance = glm::distance(light.position, camera.target);
        EXPECT_NEAR(light.intensity.x / (distance * distance), 3.0f, 2.0f);
    }
}

std::vector<std::string> found_kinds(std::string_view text) {
    std::vector<std::string> keys;
    for (const KindInfo* kind : matching_kinds(text, [](const KindInfo&) { return true; })) keys.push_back(kind->key);
    return keys;
}

TEST(KindMenu, FindsKindsByWhatIsTyped) {
    const std::pair<const char*, const char*> first[] = {
        {"sph", "sphere"},
        {"BOX", "box"},
        {"tw", "twist"},

        {"round sub", "round_subtract"},
        {"polar", "polar_repeat"},
        {"frame", "box_frame"},
        {"repeat", "repeat"},
        {" torus ", "torus"},
        {"union", "union"},
        {"stairs u", "stairs_union"},
        {"waves", "displace_sine"},
        // What they are called elsewhere.
        {"smooth", "union"},
        {"smin", "union"},
        {"smooth sub", "subtract"},
        {"difference", "subtract"},
        {"intersection", "intersect"},
        {"cube", "box"},
        {"ball", "sphere"},
        {"array", "repeat"},
        {"radial", "polar_repeat"},
        {"lathe", "revolve"},
        {"onion", "shell"},
        {"glsl", "custom"},
    };
    for (const auto& [text, key] : first) {
        ASSERT_FALSE(found_kinds(text).empty()) << text;
        EXPECT_EQ(found_kinds(text)[0], key) << text;
    }
    EXPECT_TRUE(found_kinds("no such thing").empty());
    EXPECT_EQ(found_kinds("").size(), node_kinds().size() - 1);  // instances are offered by what they show
    EXPECT_EQ(found_kinds("profiles").size(), 6u);
    for (const KindInfo* kind : matching_kinds("union", [](const KindInfo& k) { return k.role == Role::primitive; }))
        EXPECT_EQ(kind->role, Role::primitive);
}

TEST(KindMenu, EveryKindIsFoundFirstByItsLabel) {
    for (const KindInfo& kind : node_kinds())
        if (kind.role != Role::instance) {
            EXPECT_EQ(found_kinds(kind.label)[0], kind.key);
        }
}

}  // namespace
}  // namespace farfield
