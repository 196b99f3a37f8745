// How the scene is rendered: method, samples, filter, exposure, and which picture is shown.
#pragma once

#include "ui/ui.h"

namespace farfield {

Edits settings_panel(Ui& ui, const Scene& scene);

}  // namespace farfield
