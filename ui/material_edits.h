// Which nodes have a material, and how they come by one.
#pragma once

#include "ui/selection.h"

#include <unordered_map>

namespace farfield {

/// What a dragged material carries: its Id.
inline constexpr const char* material_payload = "material";

/// How many nodes name each of the materials, in the tree and in the definitions.
std::unordered_map<Id, int> material_uses(const Scene& scene);
/// The nodes that name it, in the order of the tree.
std::vector<Id> material_users(const Scene& scene, Id material);

/// Gives the selected nodes a material; empty where all have it or none is selected.
Edits give_material(const Scene& scene, const Selection& selection, Id material);
/// Gives it to one node, and to all that are selected if that is among them.
Edits drop_material(const Scene& scene, const Selection& selection, Id node, Id material);
/// Adds a material for the node, as it is otherwise.
Edits new_material(const Scene& scene, Id node);

/// What becomes of its nodes without it, as a sentence.
std::string without_material(const Scene& scene, Id material, int uses);

}  // namespace farfield
