// Signs of the lights over the picture: a sun where a point light stands, an arrow towards what the camera looks at the
// way a directional light comes.
#pragma once

#include "app/picture_view.h"
#include "ui/ui.h"

#include <vector>

namespace farfield {

struct LightSign {
    Id light = 0;
    LightKind kind = LightKind::point;
    glm::vec2 from{0.0f}, to{0.0f};  ///< pixels; the same for a point light
};

/// Of the lights in sight: all with ui.tools.lights, otherwise the selected one.
std::vector<LightSign> light_signs(const Ui& ui, const Scene& scene, const PictureView& view);

/// The light whose sign is under the mouse; 0 for none.
Id light_at(const Ui& ui, const std::vector<LightSign>& signs, glm::vec2 mouse);

void draw_light_signs(Ui& ui, const Scene& scene, const std::vector<LightSign>& signs, Id hovered);

}  // namespace farfield
