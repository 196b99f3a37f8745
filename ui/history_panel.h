// The list of steps: what was done, what was taken back, and the way to any state between.
#pragma once

#include "sdf/history.h"
#include "ui/ui.h"

#include <optional>

namespace farfield {

/// Draws the window while ui.show_history. The step to go to, when one was clicked.
std::optional<std::size_t> history_panel(Ui& ui, const History& history);

}  // namespace farfield
