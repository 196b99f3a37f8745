// What the renderer reports, as a small translucent table over the picture.
#pragma once

#include "ui/ui.h"

namespace farfield {

/// Draws at the upper right end `corner` of the viewport, `room` pixels high at most.
void statistics_overlay(Ui& ui, const Statistics& statistics, ImVec2 corner, float room);

}  // namespace farfield
