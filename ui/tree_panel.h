// The scene's tree of shapes: select, search, hide, lock, re-order by drag and drop, and a menu of what can be done.
#pragma once

#include "ui/ui.h"

namespace farfield {

Edits tree_panel(Ui& ui, const Scene& scene);

/// Selects the node, and has the tree show it.
void go_to(Ui& ui, Id node);

}  // namespace farfield
