// The scene's tree of shapes: select, add, delete, change kind, and re-order by drag and drop.
#pragma once

#include "ui/ui.h"

namespace farfield {

Edits tree_panel(Ui& ui, const Scene& scene);

/// Selects the node, and has the tree show it.
void go_to(Ui& ui, Id node);

/// An edit that puts `node` where a user would expect it: into the selected node when that takes children, otherwise
/// after it; at the end of the root without a selection.
Edit insert_at_selection(const Ui& ui, const Scene& scene, Node node);

/// Edits for what is selected; empty when there is nothing to do.
Edits delete_selection(const Ui& ui, const Scene& scene);
Edits duplicate_selection(const Ui& ui, const Scene& scene);
/// Makes a definition of the selected node, or the selected instance independent.
Edits define_selection(const Ui& ui, const Scene& scene);
Edits free_selection(const Ui& ui, const Scene& scene);
/// Moves the selected node among its siblings, by -1 or 1.
Edits shift_selection(const Ui& ui, const Scene& scene, int by);

}  // namespace farfield
