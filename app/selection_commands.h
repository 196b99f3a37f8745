// Which edits the commands come to that act on what is selected.
#pragma once

#include "app/editor_commands.h"
#include "ui/selection.h"

#include <optional>

namespace farfield {

/// None for commands that are no mere edits; empty where there is nothing to do.
std::optional<Edits> edits_for(CommandId command, const Scene& scene, const Selection& selection);

}  // namespace farfield
