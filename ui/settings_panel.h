// How the scene is rendered: method, samples, filter, exposure, and which picture is shown.
#pragma once

#include "renderer/statistics.h"
#include "ui/ui.h"

namespace farfield {

/// `statistics` of the picture: what the bounces add.
Edits settings_panel(Ui& ui, const Scene& scene, const Statistics& statistics);

}  // namespace farfield
