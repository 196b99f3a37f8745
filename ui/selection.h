// What is selected: one object, which the inspector shows, and further nodes that edits act on with it.
#pragma once

#include "sdf/edit.h"

#include <optional>
#include <string_view>
#include <vector>

namespace farfield {

/// Nodes selected beside the primary one. They count as long as that is the primary one that they were selected with:
/// whoever selects something else, selects that alone.
struct FurtherNodes {
    Id beside = 0;
    std::vector<Id> nodes;
    friend bool operator==(const FurtherNodes&, const FurtherNodes&) = default;
};

struct Selection {
    ObjectRef primary;
    FurtherNodes further;
    friend bool operator==(const Selection&, const Selection&) = default;
};

/// All selected nodes, the primary one last; none where that is no node. Not all of them need exist.
std::vector<Id> selected_nodes(const Selection& selection);
bool is_selected(const Selection& selection, Id node);

Selection select(ObjectRef object);
/// The last one becomes the primary one.
Selection select(const std::vector<Id>& nodes);
/// Adds the node, or takes it out unless it is the only one.
Selection toggled(const Selection& selection, Id node);
/// From the primary node to `node` as the rows follow each other; the primary one stays that.
Selection extended(const Selection& selection, const std::vector<Id>& rows, Id node);
/// All that is beside the primary node; if that is selected already, all that the root holds.
Selection everything(const Scene& scene, const Selection& selection);

/// What is selected after edits: what they added, what they took out of a dissolved group, a neighbour of what they
/// removed, otherwise the same as before. `results`: what apply returned for each.
Selection selection_after(const Scene& before, const Scene& after, std::span<const Edit> edits,
                          const std::vector<Id>& results, const Selection& selection);

/// Whether each word is part of the node's name or kind, whatever their case.
bool matches(const Scene& scene, const Node& node, std::string_view words);

}  // namespace farfield
