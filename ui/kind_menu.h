// The list of all node kinds, by what they do, for adding a node and for changing its kind. What is typed while it is
// open searches it.
#pragma once

#include "ui/ui.h"

#include <functional>
#include <optional>

namespace farfield {

using KindFilter = std::function<bool(const KindInfo&)>;

/// The group of the menu that a kind stands in: "Shapes", "Profiles", "Combine", "Space", "Repeat" or "Distance".
const char* kind_group(const KindInfo& kind);

/// The kinds that `allowed` accepts whose label, key, group, other words or tip has every word of `text` in it: first
/// the one that is called so, then those whose label begins with it, then those with a word of the label that does,
/// then those with all words in the label, key or group, then those that others call so, then the rest; in the table's
/// order.
std::vector<const KindInfo*> matching_kinds(std::string_view text, const KindFilter& allowed);

/// Entries for every kind that `allowed` accepts, inside an open popup, and a field that has the keyboard and searches
/// them. Returns the one that was clicked, or the marked one on Enter.
std::optional<NodeKind> kind_menu(Ui& ui, const char* panel, const KindFilter& allowed);

/// The same with an instance of each definition, for adding: a node with default values.
std::optional<Node> node_menu(Ui& ui, const char* panel, const Scene& scene);

}  // namespace farfield
