// The menu of a node in the tree.
#pragma once

#include "ui/ui.h"

namespace farfield {

/// Draws its entries inside an open popup. The node is the primary selected one, so that its entries are about all that
/// is selected.
Edits tree_menu(Ui& ui, const Scene& scene, const Node& node);

}  // namespace farfield
