// What the scene has beside shapes: materials, lights, sky and camera, as a list to select from.
#pragma once

#include "ui/ui.h"

namespace farfield {

/// A point light that is seen, over what the camera looks at and nearer to it.
Light light_in_view(const Camera& camera);

Edits objects_panel(Ui& ui, const Scene& scene);

}  // namespace farfield
