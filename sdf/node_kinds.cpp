#include "sdf/node_kinds.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <type_traits>
#include <utility>

namespace farfield {
namespace {

namespace shapes {
using namespace glm;
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"  // GLSL has no parameters without a name
#include "sdf/shapes.glsl"
#include "sdf/operations.glsl"
#pragma GCC diagnostic pop
}  // namespace shapes

// Adapters from the functions of shapes.glsl and operations.glsl to the uniform signatures of the table: the arguments
// that follow the fixed ones are taken from the parameter values in order, x for a float and all of a vec3.
template <class T>
T argument(glm::vec3 v) {
    if constexpr (std::is_same_v<T, float>)
        return v.x;
    else
        return v;
}

template <class Signature, class... Fixed>
struct Rest;
template <class R, class... All, class... Fixed>
struct Rest<R (*)(All...), Fixed...> {
    static constexpr std::size_t count = sizeof...(All) - sizeof...(Fixed);
    template <std::size_t I>
    using type = std::tuple_element_t<I + sizeof...(Fixed), std::tuple<All...>>;
};

template <auto F, class... Fixed>
auto call(Values v, Fixed... fixed) {
    using Arguments = Rest<decltype(F), Fixed...>;
    return [&]<std::size_t... I>(std::index_sequence<I...>) {
        return F(fixed..., argument<typename Arguments::template type<I>>(v[I])...);
    }
    (std::make_index_sequence<Arguments::count>());
}

template <auto F>
float primitive(glm::vec3 p, Values v) {
    return call<F>(v, p);
}
template <auto F>
float combine(float a, float b, Values v) {
    return call<F>(v, a, b);
}
template <auto F>
glm::vec3 domain(glm::vec3 p, Values v, int) {
    return call<F>(v, p);
}
template <auto F>
float modify(float d, glm::vec3, Values v) {
    return call<F>(v, d);
}
template <auto F>
float safe_distance(float d, glm::vec3 p, Values v) {
    return call<F>(v, d, p);
}
glm::vec3 repeat(glm::vec3 p, Values v, int cell) { return shapes::repeat(p, v[0], v[1], v[2], v[3], cell); }
int repeat_cells(Values v) { return shapes::repeat_cells(v[0], v[1], v[2], v[3]); }

// What modifiers make of their content's bounds, and what they derive from them.
Extent mirror_image(const Extent& content, Values v) {
    Extent image = content;
    for (int axis = 0; axis < 3; ++axis)
        if (v[0][axis] > 0.5f) {
            image.box.high[axis] = std::max(content.box.high[axis], 0.0f);
            image.box.low[axis] = -image.box.high[axis];
            image.symmetric[axis] = true;
        }
    return image;
}

Extent repeat_image(const Extent& content, Values v) {
    Extent image = content;
    for (int axis = 0; axis < 3; ++axis) {
        if (v[0][axis] <= 0.0f || v[1][axis] == 1.0f) continue;
        const float to_last = v[1][axis] > 0.0f ? 0.5f * (v[1][axis] - 1.0f) * v[0][axis] : unbounded;
        image.box.low[axis] -= to_last;
        image.box.high[axis] += to_last;
    }
    image.box = image.box.valid();
    return image;
}

// Of content that is `width` wide, each point has its nearest copy among the 1 + ceil(width / spacing) copies whose
// middles are nearest: a copy further off is at least its half width further than one between. Content that fits into
// its cell and is its own mirror image needs one: the planes between cells are mirrors, and what lies beyond is as far
// or further. Content without end along the axis is taken to be the same all along it.
void derive_repeat(const Extent& content, Values v, std::span<glm::vec3> derived) {
    constexpr float most_cells = 16.0f;  // of content that wide; copies beyond do not show
    for (int axis = 0; axis < 3; ++axis) {
        const float spacing = v[0][axis], count = v[1][axis], width = content.box.size()[axis];
        float& cells = derived[0][axis];
        cells = 1.0f;
        derived[1][axis] = 0.0f;
        if (spacing <= 0.0f || count == 1.0f) continue;
        if (content.symmetric[axis] && width <= spacing) continue;
        const bool bounded = content.box.is_bounded(axis);
        cells = bounded ? std::min(1.0f + std::ceil(width / spacing), most_cells) : 2.0f;
        if (count > 0.0f) cells = std::min(cells, count);
        if (bounded) derived[1][axis] = content.box.centre()[axis];
    }
}

float reach_from_y(const Box& box) {
    const glm::vec3 far = glm::max(glm::abs(box.low), glm::abs(box.high));
    return std::min(glm::length(glm::vec2(far.x, far.z)), unbounded);
}

Extent twist_image(const Extent& content, Values v) {
    return {{{-v[1].x, content.box.low.y, -v[1].x}, {v[1].x, content.box.high.y, v[1].x}}, {}};
}

constexpr auto metres = Unit::metres;
constexpr auto number = ParameterType::number;
constexpr auto vector = ParameterType::vector;

Parameter length(const char* key, const char* tip, float initial, float minimum = 0.0f) {
    return {key, tip, number, metres, minimum, largest_value, glm::vec3(initial, 0.0f, 0.0f)};
}
Parameter lengths(const char* key, const char* tip, float initial, float minimum = 0.0f) {
    return {key, tip, vector, metres, minimum, largest_value, glm::vec3(initial)};
}

Parameter angle(const char* key, const char* tip, float initial) {
    return {key, tip, number, Unit::degrees, 0.0f, 360.0f, glm::vec3(initial, 0.0f, 0.0f)};
}

/// Parameters of the profiled combinations.
const Parameter blend = length("radius", "Width of the smooth blend; 0 gives a hard edge", 0.0f);
const Parameter profile = length("radius", "How far from the edge the profile begins", 0.1f);
Parameter whole(const char* key, const char* tip, float initial) {
    return {key, tip, ParameterType::integer, Unit::none, 1.0f, 1000.0f, glm::vec3(initial, 0.0f, 0.0f)};
}
const Parameter steps = whole("steps", "Number of steps", 3.0f);
const Parameter columns = whole("columns", "Number of columns", 3.0f);

/// GLSL of a combination of the distances {0} and {1} when all of its parameters are 0; see KindInfo.
struct Hard {
    const char* when_zero;
    const char* second_shows;
    Gather gather;
};
constexpr Hard hard_union{"min({0}, {1})", "{1} < {0}", Gather::any};
constexpr Hard hard_intersect{"max({0}, {1})", "{1} > {0}", Gather::all};
constexpr Hard hard_subtract{"max({0}, -{1})", "-{1} > {0}", Gather::first};
constexpr Hard never_hard(Gather gather) { return {nullptr, nullptr, gather}; }

// What primitives fill, centred on the origin unless they say otherwise; their mirror symmetries.
using Symmetry = std::array<bool, 3>;
constexpr Symmetry xyz{true, true, true}, xz{true, false, true}, yz{false, true, true}, xy{true, true, false};
Extent within(glm::vec3 half_size, Symmetry symmetric = xyz) { return {{-half_size, half_size}, symmetric}; }
Extent turned(float radius, float low, float high) { return {{{-radius, low, -radius}, {radius, high, radius}}, xz}; }

Extent cut_ball(float radius, float cut_height, bool above) {
    const float h = glm::clamp(cut_height, -radius, radius);
    const float widest = (h > 0.0f) == above ? std::sqrt(radius * radius - h * h) : radius;
    return above ? turned(widest, h, radius) : turned(widest, -radius, h);
}

// How far combinations reach beyond their children: the most that a profile fills.
float quarter_radius(Values v) { return 0.25f * v[0].x; }
float whole_radius(Values v) { return v[0].x; }

KindInfo make_primitive(NodeKind kind, const char* key, const char* label, const char* tip, bool exact,
                        std::vector<Parameter> parameters, Extent (*extent)(Values), const char* function,
                        float (*evaluate)(glm::vec3, Values)) {
    KindInfo k{};
    k.kind = kind, k.key = key, k.label = label, k.tip = tip, k.role = Role::primitive, k.exact = exact;
    k.parameters = std::move(parameters), k.extent = extent, k.function = function, k.primitive = evaluate;
    return k;
}

KindInfo make_combination(NodeKind kind, const char* key, const char* label, const char* tip, bool exact,
                          std::vector<Parameter> parameters, const char* function,
                          float (*evaluate)(float, float, Values), const char* weight,
                          float (*evaluate_weight)(float, float, Values), Hard hard, float (*reach)(Values) = nullptr) {
    KindInfo k{};
    k.kind = kind, k.key = key, k.label = label, k.tip = tip, k.role = Role::combine, k.exact = exact;
    k.parameters = std::move(parameters), k.function = function, k.combine = evaluate, k.secondary = weight;
    k.weight = evaluate_weight, k.when_zero = hard.when_zero, k.second_shows = hard.second_shows;
    k.gather = hard.gather, k.reach = reach;
    return k;
}

KindInfo make_modifier(NodeKind kind, const char* key, const char* label, const char* tip, Role role, bool exact,
                       std::vector<Parameter> parameters, const char* function) {
    KindInfo k{};
    k.kind = kind, k.key = key, k.label = label, k.tip = tip, k.role = role, k.exact = exact;
    k.parameters = std::move(parameters), k.function = function;
    return k;
}

#define FUNCTION(adapter, name) #name, adapter < shapes::name>

std::vector<KindInfo> make_table() {
    using K = NodeKind;
    std::vector<KindInfo> t;
    t.push_back(make_primitive(
        K::sphere, "sphere", "Sphere", "All points within a radius", true, {length("radius", "Radius", 0.5f)},
        [](Values v) { return within(glm::vec3(v[0].x)); }, FUNCTION(primitive, sphere)));
    t.push_back(make_primitive(
        K::box, "box", "Box", "A box with sharp edges", true, {lengths("half_size", "Half the edge lengths", 0.5f)},
        [](Values v) { return within(v[0]); }, FUNCTION(primitive, box)));
    t.push_back(make_primitive(
        K::rounded_box, "rounded_box", "Rounded box", "A box with rounded edges", true,
        {lengths("half_size", "Half the edge lengths, rounding included", 0.5f),
         length("radius", "Radius of the edges, at most the smallest half size", 0.1f)},
        [](Values v) { return within(v[0]); }, FUNCTION(primitive, rounded_box)));
    t.push_back(make_primitive(
        K::torus, "torus", "Torus", "A ring around the y axis", true,
        {length("major_radius", "From the axis to the middle of the tube", 0.5f),
         length("minor_radius", "Radius of the tube", 0.15f)},
        [](Values v) { return turned(v[0].x + v[1].x, -v[1].x, v[1].x); }, FUNCTION(primitive, torus)));
    t.push_back(make_primitive(
        K::capsule, "capsule", "Capsule", "A cylinder along y with round ends", true,
        {length("radius", "Radius", 0.25f), length("half_height", "Half the length of the straight part", 0.25f)},
        [](Values v) { return turned(v[0].x, -v[0].x - v[1].x, v[0].x + v[1].x); }, FUNCTION(primitive, capsule)));
    t.push_back(make_primitive(
        K::capped_cylinder, "capped_cylinder", "Cylinder", "A cylinder along y with flat ends", true,
        {length("radius", "Radius", 0.4f), length("half_height", "Half the height", 0.5f)},
        [](Values v) {
            return within({v[0].x, v[1].x, v[0].x});
        },
        FUNCTION(primitive, capped_cylinder)));
    t.push_back(make_primitive(
        K::cone, "cone", "Cone", "A cone along y, tip up, with a flat base", true,
        {length("radius", "Radius of the base", 0.5f), length("half_height", "Half the height", 0.5f)},
        [](Values v) { return turned(v[0].x, -v[1].x, v[1].x); }, FUNCTION(primitive, cone)));
    t.push_back(make_primitive(
        K::plane, "plane", "Plane", "Everything at and below y = 0", true, {},
        [](Values) {
            return Extent{{glm::vec3(-unbounded), {unbounded, 0.0f, unbounded}}, xz};
        },
        FUNCTION(primitive, plane)));
    t.push_back(make_primitive(
        K::infinite_cylinder, "infinite_cylinder", "Infinite cylinder", "A cylinder along y without ends", true,
        {length("radius", "Radius", 0.25f)},
        [](Values v) {
            return within({v[0].x, unbounded, v[0].x});
        },
        FUNCTION(primitive, infinite_cylinder)));
    t.push_back(make_primitive(
        K::box_frame, "box_frame", "Box frame", "The twelve edges of a box, as bars", true,
        {lengths("half_size", "Half the edge lengths", 0.5f),
         length("thickness", "Width of the bars, at most the smallest half size", 0.1f)},
        [](Values v) { return within(v[0]); }, FUNCTION(primitive, box_frame)));
    t.push_back(make_primitive(
        K::capped_torus, "capped_torus", "Capped torus", "A part of a ring around the y axis, with round ends", true,
        {length("major_radius", "From the axis to the middle of the tube", 0.5f),
         length("minor_radius", "Radius of the tube", 0.15f),
         angle("angle", "How much of the ring is there, half on either side of the x axis", 220.0f)},
        [](Values v) {
            return within({v[0].x + v[1].x, v[1].x, v[0].x + v[1].x}, yz);
        },
        FUNCTION(primitive, capped_torus)));
    t.push_back(make_primitive(
        K::link, "link", "Link", "A link of a chain, standing along y", true,
        {length("major_radius", "From the middle of the bend to the middle of the tube", 0.25f),
         length("minor_radius", "Radius of the tube", 0.1f),
         length("half_height", "Half the length of the straight parts", 0.2f)},
        [](Values v) {
            return within({v[0].x + v[1].x, v[0].x + v[1].x + v[2].x, v[1].x});
        },
        FUNCTION(primitive, link)));
    t.push_back(make_primitive(
        K::rounded_cylinder, "rounded_cylinder", "Rounded cylinder", "A cylinder along y with rounded rims", true,
        {length("radius", "Radius", 0.4f), length("half_height", "Half the height", 0.5f),
         length("edge_radius", "Radius of the rims, at most radius and half height", 0.1f)},
        [](Values v) {
            return within({v[0].x, v[1].x, v[0].x});
        },
        FUNCTION(primitive, rounded_cylinder)));
    t.push_back(make_primitive(
        K::capped_cone, "capped_cone", "Capped cone", "A cone along y without its tip", true,
        {length("lower_radius", "Radius of the lower end", 0.5f),
         length("upper_radius", "Radius of the upper end", 0.25f), length("half_height", "Half the height", 0.5f)},
        [](Values v) { return turned(glm::max(v[0].x, v[1].x), -v[2].x, v[2].x); }, FUNCTION(primitive, capped_cone)));
    t.push_back(make_primitive(
        K::round_cone, "round_cone", "Round cone", "Two balls and all between them, along y", true,
        {length("lower_radius", "Radius of the lower ball", 0.35f),
         length("upper_radius", "Radius of the upper ball", 0.2f),
         length("half_height", "Half the distance of the balls' centres", 0.25f)},
        [](Values v) {
            return turned(glm::max(v[0].x, v[1].x), glm::min(-v[2].x - v[0].x, v[2].x - v[1].x),
                          glm::max(v[2].x + v[1].x, v[0].x - v[2].x));
        },
        FUNCTION(primitive, round_cone)));
    t.push_back(make_primitive(
        K::hexagonal_prism, "hexagonal_prism", "Hexagonal prism", "A regular hexagon in the xz plane, with height",
        true,
        {length("inradius", "From the axis to the middle of a side", 0.45f),
         length("half_height", "Half the height", 0.4f)},
        [](Values v) {
            return within({1.1547006f * v[0].x, v[1].x, v[0].x});
        },
        FUNCTION(primitive, hexagonal_prism)));
    t.push_back(make_primitive(
        K::triangular_prism, "triangular_prism", "Triangular prism",
        "An equilateral triangle in the xz plane, with height", true,
        {length("inradius", "From the axis to the middle of a side", 0.3f),
         length("half_height", "Half the height", 0.4f)},
        [](Values v) {
            return within({1.7320509f * v[0].x, v[1].x, 2.0f * v[0].x}, xy);
        },
        FUNCTION(primitive, triangular_prism)));
    t.push_back(make_primitive(
        K::solid_angle, "solid_angle", "Solid angle", "The part of a ball within a cone, tip down", true,
        {length("radius", "Radius of the ball", 0.7f), angle("angle", "Opening angle of the cone", 80.0f)},
        [](Values v) { return turned(v[0].x, glm::min(v[0].x * std::cos(0.5f * v[1].x), 0.0f), v[0].x); },
        FUNCTION(primitive, solid_angle)));
    t.push_back(make_primitive(
        K::cut_sphere, "cut_sphere", "Cut sphere", "The part of a ball above a plane", true,
        {length("radius", "Radius of the ball", 0.5f),
         length("cut_height", "Height of the cut above the centre", -0.1f, -largest_value)},
        [](Values v) { return cut_ball(v[0].x, v[1].x, true); }, FUNCTION(primitive, cut_sphere)));
    t.push_back(make_primitive(
        K::cut_hollow_sphere, "cut_hollow_sphere", "Cut hollow sphere",
        "A hollow ball, open above a plane, with a round rim", true,
        {length("radius", "Radius at the middle of the wall", 0.5f),
         length("cut_height", "Height of the cut above the centre", 0.1f, -largest_value),
         length("thickness", "Thickness of the wall", 0.08f)},
        [](Values v) {
            return Extent{cut_ball(v[0].x, v[1].x, false).box.grown(0.5f * v[2].x), xz};
        },
        FUNCTION(primitive, cut_hollow_sphere)));
    t.push_back(make_primitive(
        K::death_star, "death_star", "Death star", "A ball with a round hollow on top", true,
        {length("radius", "Radius of the ball", 0.5f),
         length("carving_radius", "Radius of the ball that is carved away", 0.35f),
         length("offset", "Height of the carved ball's centre", 0.6f)},
        [](Values v) { return turned(v[0].x, -v[0].x, v[0].x); }, FUNCTION(primitive, death_star)));
    t.push_back(make_primitive(
        K::vesica, "vesica", "Vesica", "A lens-shaped spindle along y with pointed ends", true,
        {length("radius", "Radius in the middle, at most half height", 0.25f),
         length("half_height", "From the middle to a tip", 0.5f)},
        [](Values v) {
            return within({glm::min(v[0].x, v[1].x), v[1].x, glm::min(v[0].x, v[1].x)});
        },
        FUNCTION(primitive, vesica)));
    t.push_back(make_primitive(
        K::rhombus, "rhombus", "Rhombus", "A rhombus in the xz plane, with height", true,
        {length("half_length", "Half the diagonal along x", 0.5f),
         length("half_width", "Half the diagonal along z", 0.3f), length("half_height", "Half the height", 0.15f)},
        [](Values v) {
            return within({v[0].x, v[2].x, v[1].x});
        },
        FUNCTION(primitive, rhombus)));
    t.push_back(make_primitive(
        K::octahedron, "octahedron", "Octahedron", "A regular octahedron, corners on the axes", true,
        {length("radius", "From the centre to a corner", 0.6f)}, [](Values v) { return within(glm::vec3(v[0].x)); },
        FUNCTION(primitive, octahedron)));
    t.push_back(make_primitive(
        K::pyramid, "pyramid", "Pyramid", "A square base and a tip above it", true,
        {length("half_width", "Half the edge length of the base", 0.5f),
         length("half_height", "Half the height", 0.4f)},
        [](Values v) { return turned(v[0].x, -v[1].x, v[1].x); }, FUNCTION(primitive, pyramid)));
    t.push_back(make_primitive(
        K::ellipsoid, "ellipsoid", "Ellipsoid", "A sphere stretched along the axes", false,
        {lengths("radii", "Half the lengths along x, y and z", 0.5f, 1e-3f)}, [](Values v) { return within(v[0]); },
        FUNCTION(primitive, ellipsoid)));

    t.push_back(make_combination(K::union_, "union", "Union", "All of the children together", true, {blend},
                                 FUNCTION(combine, smooth_union), FUNCTION(combine, union_weight), hard_union,
                                 quarter_radius));
    t.push_back(make_combination(K::intersect, "intersect", "Intersect", "What all children have in common", false,
                                 {blend}, FUNCTION(combine, smooth_intersect), FUNCTION(combine, intersect_weight),
                                 hard_intersect));
    t.push_back(make_combination(K::subtract, "subtract", "Subtract", "The first child without the others", false,
                                 {blend}, FUNCTION(combine, smooth_subtract), FUNCTION(combine, subtract_weight),
                                 hard_subtract));
    t.push_back(make_combination(K::xor_, "xor", "Exclusive or", "What belongs to an odd number of children", false, {},
                                 FUNCTION(combine, exclusive_or), FUNCTION(combine, exclusive_or_weight),
                                 never_hard(Gather::any)));
    t.push_back(make_combination(
        K::chamfer_union, "chamfer_union", "Chamfer union", "All of the children together, bevelled where they meet",
        false, {profile}, FUNCTION(combine, chamfer_union), FUNCTION(combine, union_weight), hard_union, whole_radius));
    t.push_back(make_combination(K::chamfer_intersect, "chamfer_intersect", "Chamfer intersect",
                                 "What all children have in common, bevelled where they meet", false, {profile},
                                 FUNCTION(combine, chamfer_intersect), FUNCTION(combine, intersect_weight),
                                 hard_intersect));
    t.push_back(make_combination(K::chamfer_subtract, "chamfer_subtract", "Chamfer subtract",
                                 "The first child without the others, bevelled where they meet", false, {profile},
                                 FUNCTION(combine, chamfer_subtract), FUNCTION(combine, subtract_weight),
                                 hard_subtract));
    t.push_back(make_combination(K::round_union, "round_union", "Round union",
                                 "All of the children together, rounded by a circle where they meet", false, {profile},
                                 FUNCTION(combine, round_union), FUNCTION(combine, union_weight), hard_union,
                                 whole_radius));
    t.push_back(make_combination(K::round_intersect, "round_intersect", "Round intersect",
                                 "What all children have in common, rounded by a circle where they meet", false,
                                 {profile}, FUNCTION(combine, round_intersect), FUNCTION(combine, intersect_weight),
                                 hard_intersect));
    t.push_back(make_combination(K::round_subtract, "round_subtract", "Round subtract",
                                 "The first child without the others, rounded by a circle where they meet", false,
                                 {profile}, FUNCTION(combine, round_subtract), FUNCTION(combine, subtract_weight),
                                 hard_subtract));
    t.push_back(make_combination(K::stairs_union, "stairs_union", "Stairs union",
                                 "All of the children together, with steps where they meet", false, {profile, steps},
                                 FUNCTION(combine, stairs_union), FUNCTION(combine, stepped_union_weight), hard_union,
                                 whole_radius));
    t.push_back(make_combination(K::stairs_intersect, "stairs_intersect", "Stairs intersect",
                                 "What all children have in common, with steps where they meet", false,
                                 {profile, steps}, FUNCTION(combine, stairs_intersect),
                                 FUNCTION(combine, stepped_intersect_weight), hard_intersect));
    t.push_back(make_combination(K::stairs_subtract, "stairs_subtract", "Stairs subtract",
                                 "The first child without the others, with steps where they meet", false,
                                 {profile, steps}, FUNCTION(combine, stairs_subtract),
                                 FUNCTION(combine, stepped_subtract_weight), hard_subtract));
    t.push_back(make_combination(K::columns_union, "columns_union", "Columns union",
                                 "All of the children together, with columns where they meet", false,
                                 {profile, columns}, FUNCTION(combine, columns_union),
                                 FUNCTION(combine, stepped_union_weight), hard_union, whole_radius));
    t.push_back(make_combination(K::columns_intersect, "columns_intersect", "Columns intersect",
                                 "What all children have in common, with columns where they meet", false,
                                 {profile, columns}, FUNCTION(combine, columns_intersect),
                                 FUNCTION(combine, stepped_intersect_weight), hard_intersect));
    t.push_back(make_combination(K::columns_subtract, "columns_subtract", "Columns subtract",
                                 "The first child without the others, with columns where they meet", false,
                                 {profile, columns}, FUNCTION(combine, columns_subtract),
                                 FUNCTION(combine, stepped_subtract_weight), hard_subtract));
    t.push_back(make_combination(K::pipe, "pipe", "Pipe", "A tube along the curve in which the surfaces meet", false,
                                 {length("radius", "Radius of the tube", 0.05f)}, FUNCTION(combine, pipe),
                                 FUNCTION(combine, pipe_weight), never_hard(Gather::all), whole_radius));
    t.push_back(make_combination(
        K::engrave, "engrave", "Engrave", "The first child with a V-shaped notch where the others' surfaces meet it",
        false, {length("depth", "Depth of the notch, and half its width", 0.05f)}, FUNCTION(combine, engrave),
        FUNCTION(combine, engrave_weight), never_hard(Gather::first)));
    t.push_back(make_combination(
        K::groove, "groove", "Groove", "The first child with a channel where the others' surfaces meet it", false,
        {length("depth", "Depth", 0.05f), length("width", "Width", 0.1f)}, FUNCTION(combine, groove),
        FUNCTION(combine, groove_weight), never_hard(Gather::first)));
    t.push_back(make_combination(
        K::tongue, "tongue", "Tongue", "The first child with a ridge where the others' surfaces meet it", false,
        {length("height", "Height", 0.05f), length("width", "Width", 0.1f)}, FUNCTION(combine, tongue),
        FUNCTION(combine, tongue_weight), never_hard(Gather::first), whole_radius));

    KindInfo mirror = make_modifier(
        K::mirror, "mirror", "Mirror", "Shows the content of the positive side on both sides", Role::domain, true,
        {{"axes", "Axes to mirror along", ParameterType::flags, Unit::none, 0.0f, 1.0f, {1.0f, 0.0f, 0.0f}}}, "mirror");
    mirror.domain = domain<shapes::mirror>;
    mirror.image = mirror_image;
    t.push_back(mirror);

    KindInfo repeat_kind =
        make_modifier(K::repeat, "repeat", "Repeat", "Copies of the content at even spacing; it must fit into its cell",
                      Role::repeat, true,
                      {{"spacing",
                        "Distance between copies; 0 does not repeat along that axis",
                        vector,
                        metres,
                        0.0f,
                        largest_value,
                        {1.0f, 0.0f, 0.0f}},
                       {"count",
                        "Number of copies, centred; 0 repeats without end",
                        ParameterType::count,
                        Unit::none,
                        0.0f,
                        1e5f,
                        {3.0f, 0.0f, 0.0f}}},
                      "repeat");
    repeat_kind.domain = repeat;
    repeat_kind.cells = repeat_cells;
    repeat_kind.image = repeat_image;
    repeat_kind.derived = {{"cells", "Copies along each axis that can be nearest", ParameterType::count},
                           {"centre", "Middle of one copy", vector, metres}};
    repeat_kind.derive = derive_repeat;
    repeat_kind.secondary = "repeat_cells";
    t.push_back(repeat_kind);

    KindInfo twist = make_modifier(K::twist, "twist", "Twist", "Turns the content about the y axis as it goes up",
                                   Role::domain, false,
                                   {{"rate",
                                     "Turn for each metre of height",
                                     number,
                                     Unit::degrees_per_metre,
                                     -36000.0f,
                                     36000.0f,
                                     {90.0f, 0.0f, 0.0f}}},
                                   "twist");
    twist.domain = domain<shapes::twist>;
    twist.secondary = "twist_distance";
    twist.distance = safe_distance<shapes::twist_distance>;
    twist.image = twist_image;
    twist.derived = {{"reach", "How far the content reaches from the axis", number, metres}};
    twist.derive = [](const Extent& content, Values, std::span<glm::vec3> derived) {
        derived[0].x = reach_from_y(content.box);
    };
    twist.stretch = [](Values v) { return shapes::twist_stretch(v[0].x, v[1].x); };
    t.push_back(twist);

    KindInfo shell = make_modifier(K::shell, "shell", "Shell", "Hollows the content to a skin", Role::distance, true,
                                   {length("thickness", "Thickness of the skin, half on either side", 0.05f)}, "shell");
    shell.distance = modify<shapes::shell>;
    shell.reach = [](Values v) { return 0.5f * v[0].x; };
    t.push_back(shell);

    KindInfo round = make_modifier(K::round, "round", "Round", "Grows the content and rounds its edges", Role::distance,
                                   true, {length("radius", "How far the surface moves out", 0.05f)}, "inflate");
    round.distance = modify<shapes::inflate>;
    round.reach = whole_radius;
    t.push_back(round);

    t.push_back(make_modifier(K::instance, "instance", "Instance",
                              "A definition, shown here as if it were copied; materials that it leaves open are the "
                              "instance's",
                              Role::instance, true, {}, ""));
    return t;
}

const std::vector<KindInfo>& table() {
    static const std::vector<KindInfo> t = make_table();
    return t;
}

}  // namespace

std::span<const KindInfo> node_kinds() { return table(); }

const KindInfo& info(NodeKind kind) { return table()[static_cast<std::size_t>(kind)]; }

std::optional<NodeKind> find_kind(std::string_view key) {
    for (const KindInfo& k : table())
        if (key == k.key) return k.kind;
    return std::nullopt;
}

float beyond(float d, glm::vec3 away) { return shapes::beyond(d, away); }

std::uint32_t blend_materials(std::uint32_t a, std::uint32_t b, float share_of_b) {
    return shapes::blend_materials(a, b, share_of_b);
}

}  // namespace farfield
