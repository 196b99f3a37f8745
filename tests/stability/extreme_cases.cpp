// Values that nobody means and everybody meets: nothing at all, everything at once, and scenes too large to compile.
#include "renderer/gl.h"
#include "renderer/metrics.h"
#include "renderer/views.h"
#include "sdf/scene_file.h"
#include "tests/stability/case.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace farfield::stability {
namespace {

constexpr FrameOptions tiny{.size = {32, 32}};

glm::vec3 grid(int i) {
    return {1.5f * static_cast<float>(i % 6) - 4.0f, 0.6f, 1.5f * static_cast<float>(i / 6) - 4.0f};
}

/// A floor under a lamp and a sky, seen from above.
Built stand() {
    Built scene;
    scene.add(box({6.0f, 0.1f, 6.0f}));
    scene.add_point_light({0.0f, 5.0f, 0.0f}, glm::vec3(30.0f));
    scene.set_sky(1.0f);
    scene.settings.bounces = 2;
    scene.look({0.0f, 9.0f, 9.0f}, glm::vec3(0.0f));
    return scene;
}

/// Every kind of a role with all parameters at that value, as far as they go; kinds from `first` on, at most 12.
Built every(bool primitives, float value, std::size_t first) {
    Built scene = stand();
    std::size_t number = 0;
    for (const KindInfo& kind : node_kinds()) {
        if (kind.takes_children() == primitives || kind.role == Role::instance) continue;
        if (number++ / 12 != first) continue;
        Node node = make_node(kind.kind);
        const std::vector<Parameter> list = parameters(node);
        for (std::size_t i = 0; i < node.values.size(); ++i) node.values[i] = clamped(list[i], glm::vec3(value));
        if (kind.takes_children()) node.children = {beam(), ball()};
        scene.add(node, grid(static_cast<int>(number)));
    }
    return scene;
}

struct Degenerate {
    const char* name;
    Built (*scene)();
};

const Degenerate degenerates[] = {
    {"primitives of size 0, first", [] { return every(true, 0.0f, 0); }},
    {"primitives of size 0, second", [] { return every(true, 0.0f, 1); }},
    {"primitives of size 0, third", [] { return every(true, 0.0f, 2); }},
    {"primitives of a million metres", [] { return every(true, 1e6f, 0); }},
    {"operations by 0, first", [] { return every(false, 0.0f, 0); }},
    {"operations by 0, second", [] { return every(false, 0.0f, 1); }},
    {"operations by 0, third", [] { return every(false, 0.0f, 2); }},
    {"operations by a million, first", [] { return every(false, 1e6f, 0); }},
    {"operations by a million, second", [] { return every(false, 1e6f, 1); }},
    {"operations by minus a million", [] { return every(false, -1e6f, 2); }},
    {"coincident surfaces",
     [] {
         Built scene = stand();
         for (int i = 0; i < 3; ++i) scene.add(box({1.0f, 0.5f, 1.0f}), {0.0f, 0.6f, 0.0f});
         const Id cut = scene.add(make_node(NodeKind::subtract), {2.5f, 0.6f, 0.0f});
         for (int i = 0; i < 2; ++i) scene.add(box(glm::vec3(0.5f)), {}, cut);
         scene.materials[0].albedo = glm::vec3(1.0f);
         return scene;
     }},
    {"camera inside a solid",
     [] {
         Built scene = stand();
         scene.add(sphere(2.0f), {0.0f, 9.0f, 9.0f});
         return scene;
     }},
    {"camera at its target",
     [] {
         Built scene = stand();
         scene.look(glm::vec3(0.0f, 2.0f, 0.0f), glm::vec3(0.0f, 2.0f, 0.0f));
         return scene;
     }},
    {"lamp on a surface, camera at the lamp",
     [] {
         Built scene = stand();
         scene.add_point_light({0.0f, 0.1f, 0.0f}, glm::vec3(1.0f));
         scene.add_point_light({0.0f, 9.0f, 9.0f}, glm::vec3(1.0f));
         return scene;
     }},
    {"scales of 1e-4 and 1e4",
     [] {
         Built scene = stand();
         for (const float scale : {1e-4f, 1e4f}) {
             Node node = sphere(1.0f / scale);
             node.transform.scale = scale;
             scene.add(node, {2.0f, 1.0f, 0.0f});
         }
         return scene;
     }},
    {"an empty scene", [] { return Built{}; }},
};

std::vector<Point> degenerate_points() {
    std::vector<Point> points;
    for (const Degenerate& d : degenerates) points.emplace_back(static_cast<double>(points.size()), d.name);
    return points;
}

/// NaN and infinities in every view of every method.
Figures invalid_values(Stage& stage, const Scene& scene) {
    Figures figures;
    stage.render(scene, tiny, 2);
    for (const Method m : methods) {
        std::size_t count = 0;
        for (const ViewInfo& view : views()) count += count_invalid(stage.read(scene, tiny, m, view.view));
        figures[m] = static_cast<double>(count);
    }
    return figures;
}

struct Extreme {
    const char* name;
    Scene (*scene)();
};

Node nested(int depth, NodeKind kind, float radius) {
    Node node = make_node(kind);
    if (!node.values.empty()) node.values[0].x = radius;
    node.transform.translate = {0.05f, 0.02f, 0.03f};
    node.transform.rotate.y = 7.0f;
    Node other = sphere(0.4f);
    other.transform.translate = {0.2f * static_cast<float>(depth % 3), 0.3f, 0.1f};
    node.children = {depth > 1
                         ? nested(depth - 1, kind == NodeKind::union_ ? NodeKind::subtract : NodeKind::union_, radius)
                         : beam(),
                     other};
    return node;
}

const Extreme extremes[] = {
    {"blend radius 1e6 m",
     []() -> Scene {
         Built scene = stand();
         Node blend = shape(NodeKind::union_, {number(1e6)});
         blend.children = {beam(), ball()};
         scene.add(blend, {0.0f, 1.0f, 0.0f});
         return scene;
     }},
    {"CSG nested 10 levels, blended",
     []() -> Scene {
         Built scene = stand();
         scene.add(nested(10, NodeKind::union_, 0.05f), {0.0f, 1.0f, 0.0f});
         return scene;
     }},
    {"CSG nested 450 levels",
     []() -> Scene {
         Built scene = stand();
         scene.add(nested(450, NodeKind::union_, 0.0f), {0.0f, 1.0f, 0.0f});
         return scene;
     }},
    {"depth 1,000 in a file",
     []() -> Scene {
         std::string text = R"({"farfield":1,"root":)", end;
         for (int i = 0; i < 1000; ++i) text += R"({"kind":"union","children":[)", end += "]}";
         return parse_scene(text + end + "}", "deep.json");
     }},
    {"10,000 nodes",
     []() -> Scene {
         Built scene = stand();
         Node group = make_node(NodeKind::union_);
         for (int i = 0; i < 10000; ++i) {
             Node one = sphere(0.02f);
             one.transform.translate = glm::vec3(i % 100, 0.0f, i / 100) * 0.1f;
             group.children.push_back(one);
         }
         scene.add(group);
         return scene;
     }},
    {"2^20 nodes by instances of instances",
     []() -> Scene {
         Built scene = stand();
         Node pair = make_node(NodeKind::union_);
         pair.children = {sphere(0.1f), sphere(0.1f)};
         Id top = scene.add(pair);
         for (int i = 0; i < 19; ++i) {
             const Id instance = apply(scene, MakeDefinition{top});
             const Node* node = find_node(scene, instance);
             Node group = make_node(NodeKind::union_);
             group.children = {*node, *node};
             apply(scene, RemoveNode{instance});
             top = scene.add(group);
         }
         return scene;
     }},
    {"4,096 materials and 100 lights",
     []() -> Scene {
         Built scene = stand();
         while (scene.materials.size() < largest_material_count) scene.add_material(glm::vec3(0.5f));
         for (int i = 0; i < 100; ++i) scene.add_point_light(grid(i) + glm::vec3(0.0f, 3.0f, 0.0f), glm::vec3(0.1f));
         Node last = sphere(0.5f);
         last.material = scene.materials.back().id;
         scene.add(last, {0.0f, 0.6f, 0.0f});
         return scene;
     }},
};

std::vector<Point> extreme_points() {
    std::vector<Point> points;
    for (const Extreme& e : extremes) points.emplace_back(static_cast<double>(points.size()), e.name);
    return points;
}

/// Broken promises: a picture that is not finite, an error without a message, a good scene that does not render
/// afterwards.
Figures survives(Stage& stage, const Extreme& extreme) {
    int broken = 0;
    std::string note;
    const auto shows = [&](const Scene& scene) {
        const Pictures pictures = stage.render(scene, tiny, 1);
        for (const Image& image : pictures.result) broken += count_invalid(image) > 0;
        return mean(pictures.result[1]);
    };
    try {
        shows(extreme.scene());
        note = "works";
    } catch (const std::exception& error) {
        note = fmt::format("refused: {}", error.what());
        broken += std::string(error.what()).empty();
    }
    std::replace(note.begin(), note.end(), '\n', ' ');
    broken += !(shows(stand()) > 0.0);
    return shared(broken, note);
}

}  // namespace

std::vector<Case> extreme_cases() {
    return {{"degenerate", "zero size, coincident surfaces, camera inside: NaN", "scene", degenerate_points(),
             "NaN and infinities in all views",
             [](Stage& s, const Point& p) {
                 return invalid_values(s, degenerates[static_cast<std::size_t>(p.value)].scene());
             },
             at_most(0.0)},
            {"too-much", "huge blends, deep nesting, many nodes", "scene", extreme_points(),
             "broken promises: works, or a clear error, and the next scene renders",
             [](Stage& s, const Point& p) { return survives(s, extremes[static_cast<std::size_t>(p.value)]); },
             at_most(0.0)}};
}

}  // namespace farfield::stability
