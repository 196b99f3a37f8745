// The list of all node kinds, by what they do, for adding a node and for changing its kind.
#pragma once

#include "ui/ui.h"

#include <functional>
#include <optional>

namespace farfield {

/// Entries for every kind that `allowed` accepts, inside an open popup. Returns the one that was clicked.
std::optional<NodeKind> kind_menu(Ui& ui, const char* panel, const std::function<bool(const KindInfo&)>& allowed);

/// The same with an instance of each definition, for adding: a node with default values.
std::optional<Node> node_menu(Ui& ui, const char* panel, const Scene& scene);

}  // namespace farfield
