// What the scene has beside shapes: materials, lights, sky and camera, as a list to select from.
#pragma once

#include "ui/ui.h"

namespace farfield {

Edits objects_panel(Ui& ui, const Scene& scene);

}  // namespace farfield
