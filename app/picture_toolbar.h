// The tools over the picture's upper left corner: what a drag of the handles does, and what is drawn over the picture.
#pragma once

#include "ui/ui.h"

namespace farfield {

/// Returns the toolbar's height.
float picture_toolbar(Ui& ui, ImVec2 low);

}  // namespace farfield
