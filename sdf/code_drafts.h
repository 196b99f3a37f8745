// Work on custom code before it is code.
#pragma once

#include "sdf/scene.h"

#include <map>
#include <string>

namespace farfield {

/// Text that was typed as the code of a node and not handed in.
using CodeDrafts = std::map<Id, std::string>;

}  // namespace farfield
