// The one table of node kinds. File format, inspector, code generator, CPU evaluation, documentation and tests read it.
#pragma once

#include "sdf/box.h"
#include "sdf/parameter.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace farfield {

enum class NodeKind {
    sphere,
    box,
    rounded_box,
    torus,
    capsule,
    capped_cylinder,
    cone,
    plane,
    infinite_cylinder,
    box_frame,
    capped_torus,
    link,
    rounded_cylinder,
    capped_cone,
    round_cone,
    hexagonal_prism,
    triangular_prism,
    solid_angle,
    cut_sphere,
    cut_hollow_sphere,
    death_star,
    vesica,
    rhombus,
    octahedron,
    pyramid,
    ellipsoid,
    circle,
    rectangle,
    rounded_rectangle,
    polygon,
    star,
    ring,
    menger_sponge,
    mandelbulb,
    custom,
    union_,
    intersect,
    subtract,
    xor_,
    chamfer_union,
    chamfer_intersect,
    chamfer_subtract,
    round_union,
    round_intersect,
    round_subtract,
    stairs_union,
    stairs_intersect,
    stairs_subtract,
    columns_union,
    columns_intersect,
    columns_subtract,
    pipe,
    engrave,
    groove,
    tongue,
    morph,
    mirror,
    elongate,
    repeat,
    polar_repeat,
    twist,
    bend,
    taper,
    stretch,
    extrude,
    revolve,
    shell,
    round,
    displace_sine,
    displace_noise,
    instance,
};

/// How the generated code uses the kind's function of shapes.glsl or operations.glsl.
enum class Role {
    primitive,  ///< float f(vec3 p, parameters...): signed distance, no children; of `custom` the user's own code
    combine,    ///< float f(float a, float b, parameters...): folds the children from first to last
    domain,     ///< vec3 f(vec3 p, parameters...), or none: moves the point before the children (a hard union) see it
    repeat,     ///< vec3 f(vec3 p, parameters..., derived..., int cell): as domain, and the least over its cells counts
    distance,   ///< float f(float d, parameters...): changes the distance of the children (a hard union)
    instance,   ///< shows a definition (see Scene); no children, no function
};

/// Parameter values in code units (see to_code_units), in the table's order; the derived ones follow.
using Values = std::span<const glm::vec3>;

/// What a node's content, or a primitive, fills.
struct Extent {
    Box box;
    /// Per axis: the mirror image in the plane through the origin is the same.
    std::array<bool, 3> symmetric{};
    /// Per axis: the same all along it.
    std::array<bool, 3> constant{};
};

/// Which children bound what a combination fills.
enum class Gather { any, all, first };

struct KindInfo {
    NodeKind kind;
    const char* key;    ///< in files
    const char* label;  ///< in the user interface
    const char* tip;
    Role role;
    /// Primitives: the exact distance on both sides. Others: exact outside, with exact children and default parameters.
    /// Otherwise a lower bound. Every field is 1-Lipschitz where those of its children are.
    bool exact;
    /// Primitives: a profile in the xy plane, the same at every z. Operations: made for such; they see the
    /// cross-section of their children at z = 0, and `exact` is promised for profiles.
    bool flat;
    std::vector<Parameter> parameters;  ///< of `custom` those that every code has; see parameters(Node)
    const char* function;               ///< in shapes.glsl or operations.glsl; null: none
    /// Primitives whose field is a convex function, or null: vec2 f(vec3 p, vec3 v, parameters...), the distance and
    /// outside of the shape its slope along the unit vector v (at a crease any between those on both sides).
    const char* along;
    /// Of some of these: float f(vec3 p, vec3 v, float depth, parameters...), how far along v the distance stays below
    /// -depth.
    const char* within;
    /// Of those that a line crosses in closed form: vec2 f(vec3 p, vec3 v, parameters...), from where to where on the
    /// line p + t v it is inside the shape; the first is larger than the second if it nowhere is.
    const char* span;
    /// A second function from there, or null. combine: float f(a, b, parameters...), the fraction of b's material;
    /// domain: float f(d, p, parameters..., derived...), a safe distance; repeat: int f(parameters..., derived...), the
    /// number of cells.
    const char* secondary;
    /// repeat: float f(d, p, parameters..., derived..., low, high) of one copy and of the nearest, with the corners of
    /// the node's region; where the content's distance is no exact one or it is cut off (FieldNode::guarded).
    const char* guard_copy;
    const char* guard_nearest;
    /// domain and repeat: float f(vec3 p, vec3 v, parameters..., derived...), how far a ray from p along v is one
    /// straight ray for the content too, with no parameter but those that `straight` allows; null: not at all. And vec3
    /// f(vec3 p, vec3 v, parameters...), its direction there; null: the same.
    const char* way;
    const char* direction;
    bool (*straight)(Values v);
    /// combine: GLSL of the distances {0} and {1} to use when all parameters are known to be 0, for the distance and
    /// for whether the second one's material shows; or null: the functions serve then too.
    const char* when_zero;
    const char* second_shows;
    /// The same functions on the CPU, whichever the role uses.
    float (*primitive)(glm::vec3 p, Values v);
    glm::vec2 (*slope)(glm::vec3 p, glm::vec3 direction, Values v);
    float (*stay)(glm::vec3 p, glm::vec3 direction, float depth, Values v);
    glm::vec2 (*crossed)(glm::vec3 p, glm::vec3 direction, Values v);
    float (*combine)(float a, float b, Values v);
    float (*weight)(float a, float b, Values v);
    glm::vec3 (*domain)(glm::vec3 p, Values v, int cell);
    float (*distance)(float d, glm::vec3 p, Values v);
    int (*cells)(Values v);
    float (*guarded_copy)(float d, glm::vec3 p, Values v, const Box& region);
    float (*guarded_nearest)(float d, glm::vec3 p, Values v, const Box& region);

    // What a node fills, conservatively, in its own frame: where its field is at most a level r >= 0.
    /// primitive: at most 0; a higher level lies within that box grown by r.
    Extent (*extent)(Values v);
    /// domain and repeat: where the content `content` shows.
    Extent (*image)(const Extent& content, Values v);
    Gather gather;             ///< the others
    float (*reach)(Values v);  ///< how much the level rises for the children (for each after the first), or null: 0

    // What follows from parameters and content; further arguments of `secondary`, and of `function` where it needs
    // them.
    std::vector<Parameter> derived;
    bool function_takes_derived;
    void (*derive)(const Extent& content, Values v, std::span<glm::vec3> derived);
    /// How much steps are shortened at most, to be safe: the Lipschitz constant of the field before `secondary` divides
    /// by it, where the content is; null: 1.
    float (*stretch)(Values v);
    float (*turns)(Values v);  ///< of the loops in its functions, for one evaluation at most; null: there are none
    /// Whether that grows away from the content, so that the content is evaluated at the point of its bounds nearest to
    /// p: with c that point, sqrt(|p - c|² + d(c)²) is 1-Lipschitz where d is, because a projection on a convex set is
    /// firmly nonexpansive.
    bool confined;

    // What an audit tells (sdf/audit.h).
    /// Where `stretch` comes from, as a sentence with the numbers; set where `stretch` is.
    std::string (*explain)(Values v);
    /// What is wrong with parameters and content that are valid, one sentence each; null: nothing ever is. `shapes`:
    /// how many of the children add one.
    std::vector<std::string> (*warnings)(const Extent& content, std::size_t shapes, Values v);

    bool takes_children() const { return role != Role::primitive && role != Role::instance; }
};

std::span<const KindInfo> node_kinds();
const KindInfo& info(NodeKind kind);
std::optional<NodeKind> find_kind(std::string_view key);

/// beyond of operations.glsl: the distance at p from that at the point of its bounds nearest to p; away is their
/// difference.
float beyond(float d, glm::vec3 away);

/// Of operations.glsl: where custom code is evaluated for p, and the distance at p from its value there.
glm::vec3 nearest_custom(glm::vec3 p, glm::vec3 bounds);
float custom_distance(float value, float lipschitz, glm::vec3 p, glm::vec3 nearest, glm::vec3 bounds);

/// blend_materials of operations.glsl: two material indices and the share of the second in one code.
std::uint32_t blend_materials(std::uint32_t a, std::uint32_t b, float share_of_b);
inline constexpr std::size_t largest_material_count = 4096;

}  // namespace farfield
