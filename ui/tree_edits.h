// What can be done with the selected nodes. Each returns the edits, which belong together: all are carried out or none;
// empty when there is nothing to do. Where one selected node is in another, the outer one counts.
#pragma once

#include "ui/selection.h"

namespace farfield {

/// Which of its parent's children it is.
int index_in(const Node& parent, Id child);

/// Where a user would expect it: in the selected node when that takes children, otherwise after it; at the end of the
/// root without a selection.
Edit insert_at_selection(const Scene& scene, const Selection& selection, Node node);

/// These two for materials and lights too.
Edits delete_selection(const Scene& scene, const Selection& selection);
Edits duplicate_selection(const Scene& scene, const Selection& selection);

/// The selected nodes as text for the clipboard; empty without one. See excerpt.h.
std::string copied_selection(const Scene& scene, const Selection& selection);
/// After the selected nodes, at the end of the root without any. Throws EditError where the text holds no nodes.
Edits paste_at_selection(const Scene& scene, const Selection& selection, const std::string& text);
/// At the end of what is in `parent`.
Edits paste_into(Id parent, const std::string& text);

/// Makes definitions of the selected nodes, or the selected instances independent.
Edits define_selection(const Scene& scene, const Selection& selection);
Edits free_selection(const Scene& scene, const Selection& selection);

/// Moves the selected nodes among their siblings, by -1 or 1.
Edits shift_selection(const Scene& scene, const Selection& selection, int by);
/// Moves nodes before child `index` of `parent`, -1 for its end, in their order. They stay where they are in space.
Edits move_nodes(const Scene& scene, const std::vector<Id>& nodes, Id parent, int index);

/// Puts the selected nodes into a group that keeps the picture: siblings combine as they do in their parent, those that
/// are only taken away and all others make a union. But for blends, pipes and the like of nodes that are not the first.
Edits group_selection(const Scene& scene, const Selection& selection);
/// Puts them into a new operation.
Edits wrap_selection(const Scene& scene, const Selection& selection, NodeKind kind);
/// Takes out what is in the selected groups.
Edits dissolve_selection(const Scene& scene, const Selection& selection);

/// Hides what shows of the selected nodes; shows them where all are hidden.
Edits hide_selection(const Scene& scene, const Selection& selection);
/// Where nothing else shows already, everything.
Edits show_only_selection(const Scene& scene, const Selection& selection);
Edits show_everything(const Scene& scene);
/// Locks what is not locked of the selected nodes; unlocks them where all are locked.
Edits lock_selection(const Scene& scene, const Selection& selection);

/// What an edit of the primary node comes to for all selected nodes: they get the same material, the same kind, and
/// values of their own kind as far as they changed; they move, turn and scale by as much.
Edits for_all_selected(const Scene& scene, const Selection& selection, Edits edits);

}  // namespace farfield
