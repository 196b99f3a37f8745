// What other programs and shaders call the kinds of nodes, so that whoever looks for a word of theirs finds ours.
#pragma once

#include "sdf/node_kinds.h"

#include <string_view>

namespace farfield {

/// Words in small letters with a space between them; empty where the kind's own are all.
std::string_view other_words(NodeKind kind);

}  // namespace farfield
