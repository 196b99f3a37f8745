// Moves the camera as the mouse asks. Plain functions of a camera; the viewport turns the results into edits.
#pragma once

#include "sdf/edit.h"

#include <glm/vec2.hpp>

#include <vector>

namespace farfield {

/// Around the target; half a turn for a drag of `height` pixels.
Camera orbited(const Camera& camera, glm::vec2 drag, float height);
/// Sideways and up or down, so that what is at the target's distance stays under the mouse.
Camera panned(const Camera& camera, glm::vec2 drag, float height);
/// Towards the target for positive steps of the wheel.
Camera zoomed(const Camera& camera, float steps);

/// The edits that lead from one camera to the other.
std::vector<Edit> camera_edits(const Camera& from, const Camera& to);

}  // namespace farfield
