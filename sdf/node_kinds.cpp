#include "sdf/kind_table.h"

namespace farfield {
namespace {

const std::vector<KindInfo>& table() {
    static const std::vector<KindInfo> table = [] {
        std::vector<KindInfo> t;
        add_primitives(t), add_combinations(t), add_modifiers(t);
        return t;
    }();
    return table;
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

glm::vec3 nearest_custom(glm::vec3 p, glm::vec3 bounds) { return shapes::nearest_custom(p, bounds); }

float custom_distance(float value, float lipschitz, glm::vec3 p, glm::vec3 nearest, glm::vec3 bounds) {
    return shapes::custom_distance(value, lipschitz, p, nearest, bounds);
}

std::uint32_t blend_materials(std::uint32_t a, std::uint32_t b, float share_of_b) {
    return shapes::blend_materials(a, b, share_of_b);
}

}  // namespace farfield
