#include "sdf/node_kinds.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>

#include <tuple>
#include <type_traits>
#include <utility>

namespace farfield {
namespace {

namespace shapes {
using namespace glm;
#include "sdf/shapes.glsl"
}  // namespace shapes

// Adapters from the functions of shapes.glsl to the uniform signatures of the table: the arguments that follow the
// fixed ones are taken from the parameter values in order, x for a float and all of a vec3.
template <class T>
T argument(glm::vec3 v) {
    if constexpr (std::is_same_v<T, float>) return v.x;
    else return v;
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
    }(std::make_index_sequence<Arguments::count>());
}

template <auto F>
float primitive(glm::vec3 p, Values v) { return call<F>(v, p); }
template <auto F>
float combine(float a, float b, Values v) { return call<F>(v, a, b); }
template <auto F>
glm::vec3 domain(glm::vec3 p, Values v, int) { return call<F>(v, p); }
template <auto F>
float modify(float d, glm::vec3, Values v) { return call<F>(v, d); }
template <auto F>
float safe_distance(float d, glm::vec3 p, Values v) { return call<F>(v, d, p); }
glm::vec3 repeat(glm::vec3 p, Values v, int cell) { return shapes::repeat(p, v[0], v[1], cell); }
int repeat_cells(Values v) { return shapes::repeat_cells(v[0], v[1]); }

constexpr auto metres = Unit::metres;
constexpr auto number = ParameterType::number;
constexpr auto vector = ParameterType::vector;

Parameter length(const char* key, const char* tip, float initial, float minimum = 0.0f) {
    return {key, tip, number, metres, minimum, largest_value, glm::vec3(initial, 0.0f, 0.0f)};
}
Parameter lengths(const char* key, const char* tip, float initial, float minimum = 0.0f) {
    return {key, tip, vector, metres, minimum, largest_value, glm::vec3(initial)};
}

const std::vector<Parameter> blend = {
    length("radius", "Width of the smooth blend; 0 gives a hard edge", 0.0f)};

KindInfo make_primitive(NodeKind kind, const char* key, const char* label, const char* tip, bool exact,
                        std::vector<Parameter> parameters, const char* function,
                        float (*evaluate)(glm::vec3, Values)) {
    KindInfo k{};
    k.kind = kind, k.key = key, k.label = label, k.tip = tip, k.role = Role::primitive, k.exact = exact;
    k.parameters = std::move(parameters), k.function = function, k.primitive = evaluate;
    return k;
}

KindInfo make_combination(NodeKind kind, const char* key, const char* label, const char* tip, bool exact,
                          const char* function, float (*evaluate)(float, float, Values), const char* weight,
                          float (*evaluate_weight)(float, float, Values), const char* hard,
                          const char* second_shows) {
    KindInfo k{};
    k.kind = kind, k.key = key, k.label = label, k.tip = tip, k.role = Role::combine, k.exact = exact;
    k.parameters = blend, k.function = function, k.combine = evaluate, k.secondary = weight;
    k.weight = evaluate_weight, k.when_zero = hard, k.second_shows = second_shows;
    return k;
}

KindInfo make_modifier(NodeKind kind, const char* key, const char* label, const char* tip, Role role, bool exact,
                       std::vector<Parameter> parameters, const char* function) {
    KindInfo k{};
    k.kind = kind, k.key = key, k.label = label, k.tip = tip, k.role = role, k.exact = exact;
    k.parameters = std::move(parameters), k.function = function;
    return k;
}

#define FUNCTION(adapter, name) #name, adapter<shapes::name>

std::vector<KindInfo> make_table() {
    using K = NodeKind;
    std::vector<KindInfo> t;
    t.push_back(make_primitive(K::sphere, "sphere", "Sphere", "All points within a radius", true,
                               {length("radius", "Radius", 0.5f)}, FUNCTION(primitive, sphere)));
    t.push_back(make_primitive(K::box, "box", "Box", "A box with sharp edges", true,
                               {lengths("half_size", "Half the edge lengths", 0.5f)}, FUNCTION(primitive, box)));
    t.push_back(make_primitive(K::rounded_box, "rounded_box", "Rounded box", "A box with rounded edges", true,
                               {lengths("half_size", "Half the edge lengths, rounding included", 0.5f),
                                length("radius", "Radius of the edges, at most the smallest half size", 0.1f)},
                               FUNCTION(primitive, rounded_box)));
    t.push_back(make_primitive(K::torus, "torus", "Torus", "A ring around the y axis", true,
                               {length("major_radius", "From the axis to the middle of the tube", 0.5f),
                                length("minor_radius", "Radius of the tube", 0.15f)},
                               FUNCTION(primitive, torus)));
    t.push_back(make_primitive(K::capsule, "capsule", "Capsule", "A cylinder along y with round ends", true,
                               {length("radius", "Radius", 0.25f),
                                length("half_height", "Half the length of the straight part", 0.25f)},
                               FUNCTION(primitive, capsule)));
    t.push_back(make_primitive(K::capped_cylinder, "capped_cylinder", "Cylinder", "A cylinder along y with flat ends",
                               true,
                               {length("radius", "Radius", 0.4f), length("half_height", "Half the height", 0.5f)},
                               FUNCTION(primitive, capped_cylinder)));
    t.push_back(make_primitive(K::cone, "cone", "Cone", "A cone along y, tip up, with a flat base", true,
                               {length("radius", "Radius of the base", 0.5f),
                                length("half_height", "Half the height", 0.5f)},
                               FUNCTION(primitive, cone)));
    t.push_back(make_primitive(K::plane, "plane", "Plane", "Everything at and below y = 0", true, {},
                               FUNCTION(primitive, plane)));
    t.push_back(make_primitive(K::ellipsoid, "ellipsoid", "Ellipsoid", "A sphere stretched along the axes", false,
                               {lengths("radii", "Half the lengths along x, y and z", 0.5f, 1e-3f)},
                               FUNCTION(primitive, ellipsoid)));

    t.push_back(make_combination(K::union_, "union", "Union", "All of the children together", true,
                                 FUNCTION(combine, smooth_union), FUNCTION(combine, union_weight), "min({0}, {1})",
                                 "{1} < {0}"));
    t.push_back(make_combination(K::intersect, "intersect", "Intersect", "What all children have in common", false,
                                 FUNCTION(combine, smooth_intersect), FUNCTION(combine, intersect_weight),
                                 "max({0}, {1})", "{1} > {0}"));
    t.push_back(make_combination(K::subtract, "subtract", "Subtract", "The first child without the others", false,
                                 FUNCTION(combine, smooth_subtract), FUNCTION(combine, subtract_weight),
                                 "max({0}, -{1})", "-{1} > {0}"));

    KindInfo mirror = make_modifier(
        K::mirror, "mirror", "Mirror", "Shows the content of the positive side on both sides", Role::domain, true,
        {{"axes", "Axes to mirror along", ParameterType::flags, Unit::none, 0.0f, 1.0f, {1.0f, 0.0f, 0.0f}}},
        "mirror");
    mirror.domain = domain<shapes::mirror>;
    t.push_back(mirror);

    KindInfo repeat_kind = make_modifier(
        K::repeat, "repeat", "Repeat", "Copies of the content at even spacing; it must fit into its cell",
        Role::repeat, true,
        {{"spacing", "Distance between copies; 0 does not repeat along that axis", vector, metres, 0.0f, largest_value,
          {1.0f, 0.0f, 0.0f}},
         {"count", "Number of copies, centred; 0 repeats without end", ParameterType::count, Unit::none, 0.0f, 1e5f,
          {3.0f, 0.0f, 0.0f}}},
        "repeat");
    repeat_kind.domain = repeat;
    repeat_kind.cells = repeat_cells;
    repeat_kind.secondary = "repeat_cells";
    t.push_back(repeat_kind);

    KindInfo twist = make_modifier(
        K::twist, "twist", "Twist", "Turns the content about the y axis as it goes up", Role::domain, false,
        {{"rate", "Turn for each metre of height", number, Unit::degrees_per_metre, -36000.0f, 36000.0f,
          {90.0f, 0.0f, 0.0f}}},
        "twist");
    twist.domain = domain<shapes::twist>;
    twist.secondary = "twist_distance";
    twist.distance = safe_distance<shapes::twist_distance>;
    t.push_back(twist);

    KindInfo shell = make_modifier(K::shell, "shell", "Shell", "Hollows the content to a skin", Role::distance, true,
                                   {length("thickness", "Thickness of the skin, half on either side", 0.05f)}, "shell");
    shell.distance = modify<shapes::shell>;
    t.push_back(shell);

    KindInfo round = make_modifier(K::round, "round", "Round", "Grows the content and rounds its edges",
                                   Role::distance, true, {length("radius", "How far the surface moves out", 0.05f)},
                                   "inflate");
    round.distance = modify<shapes::inflate>;
    t.push_back(round);
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

std::uint32_t blend_materials(std::uint32_t a, std::uint32_t b, float share_of_b) {
    return shapes::blend_materials(a, b, share_of_b);
}

}  // namespace farfield
