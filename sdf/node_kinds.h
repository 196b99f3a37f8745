// The one table of node kinds. File format, inspector, code generator, CPU evaluation, documentation and tests read it.
#pragma once

#include "sdf/parameter.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace farfield {

enum class NodeKind {
    sphere, box, rounded_box, torus, capsule, capped_cylinder, cone, plane, ellipsoid,
    union_, intersect, subtract,
    mirror, repeat, twist, shell, round,
};

/// How the generated code uses the kind's function of shapes.glsl.
enum class Role {
    primitive,  ///< float f(vec3 p, parameters...): signed distance, no children
    combine,    ///< float f(float a, float b, parameters...): folds the children from first to last
    domain,     ///< vec3 f(vec3 p, parameters...): moves the point before the children (a hard union) see it
    repeat,     ///< vec3 f(vec3 p, parameters..., int cell): as domain, and the least over its cells counts
    distance,   ///< float f(float d, parameters...): changes the distance of the children (a hard union)
};

/// Parameter values in code units (see to_code_units), in the table's order.
using Values = std::span<const glm::vec3>;

struct KindInfo {
    NodeKind kind;
    const char* key;    ///< in files
    const char* label;  ///< in the user interface
    const char* tip;
    Role role;
    bool exact;  ///< the exact distance (of exact children); otherwise a lower bound of it
    std::vector<Parameter> parameters;
    const char* function;  ///< in shapes.glsl
    /// A second function of shapes.glsl, or null. combine: float f(a, b, parameters...), the fraction of b's material;
    /// domain: float f(d, p, parameters...), a safe distance; repeat: int f(parameters...), the number of cells.
    const char* secondary;
    /// combine: GLSL of the distances {0} and {1} to use when all parameters are known to be 0, for the distance and for
    /// whether the second one's material shows.
    const char* when_zero;
    const char* second_shows;
    /// The same functions on the CPU, whichever the role uses.
    float (*primitive)(glm::vec3 p, Values v);
    float (*combine)(float a, float b, Values v);
    float (*weight)(float a, float b, Values v);
    glm::vec3 (*domain)(glm::vec3 p, Values v, int cell);
    float (*distance)(float d, glm::vec3 p, Values v);
    int (*cells)(Values v);

    bool takes_children() const { return role != Role::primitive; }
};

std::span<const KindInfo> node_kinds();
const KindInfo& info(NodeKind kind);
std::optional<NodeKind> find_kind(std::string_view key);

/// blend_materials of shapes.glsl: two material indices and the share of the second in one code.
std::uint32_t blend_materials(std::uint32_t a, std::uint32_t b, float share_of_b);
inline constexpr std::size_t largest_material_count = 4096;

}  // namespace farfield
