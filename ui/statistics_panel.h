// What the renderer reports, as a small translucent table over the picture.
#pragma once

#include "ui/ui.h"

namespace farfield {

/// Draws at the upper right end `corner` of the viewport, in `room` pixels at most; nothing where that is too small.
void statistics_overlay(Ui& ui, const Statistics& statistics, ImVec2 corner, ImVec2 room);

}  // namespace farfield
