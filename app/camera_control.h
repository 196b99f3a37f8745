// Moves the camera as the mouse asks. Plain functions of a camera; the viewport turns the results into edits.
#pragma once

#include "sdf/box.h"
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

/// In the same direction, so near that the box fills about 70 % of the picture's height, or of its width where that is
/// narrower than the box; aimed at its middle. `aspect`: width / height of the picture.
Camera framed(const Camera& camera, const Box& box, float aspect);

/// What to frame for an object: the world bounds of a node or of the lamp, without parts that have no end, such as the
/// ground, unless it is nothing else. The whole scene for what has no place.
Box framed_box(const Scene& scene, ObjectRef object);

/// The edits that lead from one camera to the other.
std::vector<Edit> camera_edits(const Camera& from, const Camera& to);

}  // namespace farfield
