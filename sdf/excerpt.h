// Parts of a scene as text that can be pasted: into a chat, a file, or another running Farfield.
#pragma once

#include "sdf/edit.h"

#include <string>
#include <vector>

namespace farfield {

/// A scene of nothing but the topmost of these nodes, with the materials and definitions that they use; a definition
/// itself as an instance of it. Saved, it is a whole scene file.
Scene excerpt(const Scene& scene, const std::vector<Id>& nodes);

/// The scene in a text that was copied: a scene file, or nodes out of one, with commas between. Throws EditError with
/// what is wrong and where.
std::shared_ptr<const Scene> parse_excerpt(std::string text);

}  // namespace farfield
