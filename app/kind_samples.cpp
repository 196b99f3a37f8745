#include "app/kind_samples.h"

#include "sdf/edit.h"
#include "sdf/evaluate.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace farfield {
namespace {

using glm::vec2;
using glm::vec3;

struct Palette {
    Id main, second, floor;
};

Palette add_palette(Scene& scene) {
    Material& main = scene.materials.front();
    const Id id = main.id;
    main.name = "main";
    main.albedo = {0.66f, 0.25f, 0.13f};
    main.specular = 0.05f;
    const Id second = apply(scene, AddMaterial{{0, "second", {0.16f, 0.4f, 0.46f}, 0.05f}});
    const Id floor = apply(scene, AddMaterial{{0, "floor", vec3(0.42f)}});
    return {id, second, floor};
}

Node shape(NodeKind kind, vec3 size, Id material, vec3 translate = vec3(0.0f)) {
    Node node = make_node(kind);
    node.values.at(0) = size;
    node.material = material;
    node.transform.translate = translate;
    return node;
}

/// Something that shows where the parameter's default does nothing.
vec3 visible_value(const Parameter& parameter) {
    if (parameter.initial != vec3(0.0f)) return parameter.initial;
    switch (parameter.unit) {
        case Unit::metres:
            return clamped(parameter, vec3(0.1f));
        case Unit::degrees:
        case Unit::degrees_per_metre:
            return clamped(parameter, vec3(45.0f));
        default:
            return clamped(parameter, vec3(parameter.is_whole() ? 3.0f : 0.5f));
    }
}

/// The size of a cell: the least distance among the parameters, but those that are 0.
float cell_size(const Node& node) {
    float least = 1.0f;
    const KindInfo& kind = info(node.kind);
    for (std::size_t i = 0; i < kind.parameters.size(); ++i)
        for (int c = 0; kind.parameters[i].unit == Unit::metres && c < kind.parameters[i].components(); ++c)
            if (const float size = node.values[i][c]; size > 0.0f) least = std::min(least, size);
    return least;
}

// The slab and the ball on it that combinations are shown with.
constexpr float slab_height = 0.22f;
constexpr float ball_radius = 0.3f;
constexpr vec3 ball_centre{0.0f, slab_height, 0.0f};

Node sample(const KindInfo& kind, const Palette& palette) {
    using K = NodeKind;
    Node node = make_node(kind.kind);
    if (kind.role == Role::primitive) {
        node.material = palette.main;
        if (!kind.flat) return node;
        Node body = make_node(K::extrude);  // a profile has no end
        body.children = {node};
        return body;
    }
    for (std::size_t i = 0; i < kind.parameters.size(); ++i) node.values[i] = visible_value(kind.parameters[i]);
    switch (kind.role) {
        case Role::combine:
            node.children = {shape(K::box, vec3(0.42f, slab_height, 0.42f), palette.main),
                             shape(K::sphere, vec3(ball_radius), palette.second, ball_centre)};
            break;
        case Role::distance:
            node.children = {shape(K::box, vec3(0.4f), palette.main)};
            break;
        default:
            node.children = {shape(K::box, vec3(0.35f, 0.45f, 0.12f), palette.main),
                             shape(K::sphere, vec3(0.15f), palette.second, vec3(0.35f, 0.22f, 0.0f))};
            break;
    }
    if (kind.flat) {
        node.children = {shape(K::star, vec3(5.0f), palette.main)};
        node.children[0].transform.scale = 0.5f;
    }
    if (kind.role == Role::repeat)
        for (Node& child : node.children) {
            const float scale = 0.85f * cell_size(node);
            child.transform.scale *= scale;
            child.transform.translate *= scale;
        }
    return node;
}

/// A definition and three instances of it, one with a material of its own.
void add_instances(Scene& scene, const Palette& palette) {
    Node peg = make_node(NodeKind::union_);
    peg.children = {shape(NodeKind::box, vec3(0.2f, 0.12f, 0.2f), 0),
                    shape(NodeKind::sphere, vec3(0.14f), 0, vec3(0.0f, 0.2f, 0.0f))};
    peg.transform.translate = {-0.5f, 0.0f, 0.0f};
    peg.material = palette.main;
    const Id first = apply(scene, InsertNode{scene.root.id, -1, peg});
    Node instance = *find_node(scene, apply(scene, MakeDefinition{first}));
    instance.transform.translate = {0.05f, 0.0f, 0.0f};
    instance.transform.rotate = {0.0f, 45.0f, 0.0f};
    instance.material = palette.second;
    apply(scene, InsertNode{scene.root.id, -1, instance});
    instance.transform = {{0.55f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, 0.6f};
    instance.material = palette.main;
    apply(scene, InsertNode{scene.root.id, -1, instance});
}

/// Whether there is a cavity that nobody can see: the box of distance operations hollow, or all of a combination's box
/// and ball but what they share.
bool is_hollow(const FieldEvaluator& field, Role role) {
    const auto solid = [&](vec3 p) { return field.distance(p) < 0.0f; };
    if (role == Role::distance) return !solid(vec3(0.0f));
    if (role != Role::combine) return false;
    const vec3 rise(0.0f, 0.4f * ball_radius, 0.0f);
    return solid(ball_centre + rise) && !solid(ball_centre - rise) && solid(vec3(0.38f, 0.0f, 0.38f));
}

struct Occupied {
    vec3 low{std::numeric_limits<float>::max()};
    vec3 high{-std::numeric_limits<float>::max()};
    std::vector<vec3> cells;  ///< their centres
};

/// The cells of a grid that the surface or inside may touch. Divided by its slope, a lower bound of the distance comes
/// nearer to the truth.
Occupied occupied(const FieldEvaluator& field, vec3 low, vec3 high, int cells) {
    const vec3 cell = (high - low) / static_cast<float>(cells);
    const float reach = 0.5f * glm::length(cell);
    const auto slope = [&](vec3 p) {
        vec3 gradient;
        for (int i = 0; i < 3; ++i) {
            vec3 step(0.0f);
            step[i] = 0.01f * reach;
            gradient[i] = (field.distance(p + step) - field.distance(p - step)) / (0.02f * reach);
        }
        return glm::clamp(glm::length(gradient), 0.01f, 1.0f);
    };
    Occupied found;
    for (int x = 0; x < cells; ++x)
        for (int y = 0; y < cells; ++y)
            for (int z = 0; z < cells; ++z) {
                const vec3 centre = low + cell * (vec3(x, y, z) + 0.5f);
                const float distance = field.distance(centre);
                if (distance > reach || distance > reach * slope(centre)) continue;
                found.low = glm::min(found.low, centre - 0.5f * cell);
                found.high = glm::max(found.high, centre + 0.5f * cell);
                found.cells.push_back(centre);
            }
    return found;
}

/// The height of the lowest point: a plane rises from below by the least distance above it until it touches.
float lowest(const FieldEvaluator& field, const Occupied& extent) {
    constexpr int steps = 64;
    float height = extent.low.y - 0.01f;
    for (int i = 0; i < 8; ++i) {
        float least = std::numeric_limits<float>::max();
        for (int x = 0; x <= steps; ++x)
            for (int z = 0; z <= steps; ++z) {
                const vec3 at = glm::mix(extent.low, extent.high, vec3(x, 0, z) / static_cast<float>(steps));
                least = std::min(least, field.distance({at.x, height, at.z}));
            }
        height += std::max(least, 0.0f);
    }
    return height;
}

/// Looks from `direction` with all cells in the middle of the picture, as near as possible. A cell p is in the picture
/// where |p.xy - eye.xy| <= slope (eye.z - p.z), in the camera's axes with z towards it: two planes for each side, of
/// which the outermost count.
void look_at(Camera& camera, const Occupied& extent, vec3 direction, float aspect) {
    const vec3 backward = glm::normalize(direction);
    const vec3 right = glm::normalize(glm::cross(vec3(0.0f, 1.0f, 0.0f), backward));
    const glm::mat3 axes(right, glm::cross(backward, right), backward);
    constexpr float filled = 0.75f;  // of the picture
    const vec2 slope = filled * std::tan(glm::radians(0.5f * camera.field_of_view)) * vec2(aspect, 1.0f);
    vec2 above(-std::numeric_limits<float>::max()), below = above;
    for (const vec3& cell : extent.cells) {
        const vec3 p = cell * axes;
        above = glm::max(above, vec2(p) + slope * p.z);
        below = glm::max(below, -vec2(p) + slope * p.z);
    }
    const vec2 distance = (above + below) / (2.0f * slope);
    camera.position = axes * vec3(0.5f * (above - below), std::max(distance.x, distance.y));
    camera.target = camera.position - backward;
}

}  // namespace

Scene sample_scene(const KindInfo& kind, float aspect) {
    Scene scene;
    const Palette palette = add_palette(scene);
    Id id = 0;
    if (kind.role == Role::instance)
        add_instances(scene, palette);
    else
        id = apply(scene, InsertNode{scene.root.id, -1, sample(kind, palette)});
    if (is_hollow(FieldEvaluator(scene), kind.role)) {
        const Id opened = apply(scene, InsertNode{scene.root.id, -1, make_node(NodeKind::subtract)});
        apply(scene, MoveNode{id, opened, -1});
        apply(scene, InsertNode{opened, -1, shape(NodeKind::box, vec3(1.0f), palette.floor, vec3(1.0f))});
    }

    // Nothing that ends is larger than this; of what does not end a part is shown, low enough to see the horizon.
    constexpr float reach = 3.0f;
    constexpr float shown = 0.8f;
    const FieldEvaluator field(scene);
    Occupied extent = occupied(field, vec3(-reach), vec3(reach), 40);
    const auto within = [](vec3 v) { return glm::all(glm::lessThan(glm::abs(v), vec3(reach - 0.01f))); };
    const bool ends = within(extent.low) && within(extent.high);
    if (!ends) extent = {glm::max(extent.low, vec3(-shown)), glm::min(extent.high, vec3(shown)), {}};
    extent = occupied(field, extent.low, extent.high, 40);
    if (ends) extent.low.y = lowest(field, extent);

    Node floor = make_node(NodeKind::plane);
    floor.material = palette.floor;
    floor.transform.translate.y = extent.low.y;
    apply(scene, InsertNode{scene.root.id, -1, floor});
    scene.camera.field_of_view = 24.0f;
    look_at(scene.camera, extent, ends ? vec3(0.6f, 0.55f, 1.0f) : vec3(0.6f, 0.15f, 1.0f), aspect);

    Light key;
    key.name = "key";
    key.kind = LightKind::directional;
    key.direction = {0.55f, -1.0f, -0.6f};
    key.intensity = {2.4f, 2.2f, 1.9f};
    apply(scene, AddLight{key});
    scene.sky = {vec3(0.36f, 0.4f, 0.46f), vec3(0.42f, 0.5f, 0.62f)};
    scene.settings.ao_radius = 0.3f * glm::length(extent.high - extent.low);
    return scene;
}

}  // namespace farfield
