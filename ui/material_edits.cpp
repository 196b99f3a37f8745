#include "ui/material_edits.h"

#include <fmt/format.h>

namespace farfield {
std::unordered_map<Id, int> material_uses(const Scene& scene) {
    std::unordered_map<Id, int> uses;
    visit_all_nodes(scene, [&](const Node& node) {
        if (node.material != 0) ++uses[node.material];
    });
    return uses;
}

std::vector<Id> material_users(const Scene& scene, Id material) {
    std::vector<Id> users;
    visit_all_nodes(scene, [&](const Node& node) {
        if (node.material == material) users.push_back(node.id);
    });
    return users;
}

Edits give_material(const Scene& scene, const Selection& selection, Id material) {
    Edits edits;
    for (const Id id : selected_nodes(selection))
        if (const Node* node = find_node(scene, id); node && node->material != material)
            edits.push_back(SetMaterial{id, material});
    return edits;
}

Edits drop_material(const Scene& scene, const Selection& selection, Id node, Id material) {
    return give_material(scene, is_selected(selection, node) ? selection : select(ObjectRef{ObjectType::node, node}),
                         material);
}

Edits new_material(const Scene& scene, Id node) { return {AddMaterial{}, SetMaterial{node, scene.next_id}}; }

std::string without_material(const Scene& scene, Id material, int uses) {
    const bool first = !scene.materials.empty() && scene.materials[0].id == material;
    std::string text;
    if (uses > 0)
        text =
            fmt::format("Without it {} that {} it {} the material of {} group.", uses == 1 ? "the node" : "the nodes",
                        uses == 1 ? "has" : "have", uses == 1 ? "takes" : "take", uses == 1 ? "its" : "their");
    if (first && scene.materials.size() > 1)
        text += fmt::format("{}Nodes without any then have {}.", text.empty() ? "" : " ", scene.materials[1].name);
    if (first && scene.materials.size() == 1) text = "The last material stays.";
    return text;
}

}  // namespace farfield
