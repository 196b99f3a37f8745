// Moves the camera as the mouse asks. Plain functions of a camera; the viewport turns the results into edits.
#pragma once

#include "sdf/box.h"
#include "sdf/edit.h"

#include <glm/vec2.hpp>

#include <vector>

namespace farfield {

/// Around a point of the world, which keeps its place in the picture; position and target turn together. Half a turn
/// for a drag of `height` pixels.
Camera orbited(const Camera& camera, glm::vec3 pivot, glm::vec2 drag, float height);
/// Sideways and up or down, so that `held` stays under the mouse.
Camera panned(const Camera& camera, glm::vec3 held, glm::vec2 drag, float height);
/// Towards `about` for positive steps of the wheel; it keeps its place in the picture, and position and target come
/// nearer to it alike.
Camera zoomed(const Camera& camera, glm::vec3 about, float steps);

/// Moves by metres to the right, up and forward, and turns the eyes by a drag of the mouse, a quarter turn for `height`
/// pixels.
Camera flown(const Camera& camera, glm::vec3 move, glm::vec2 drag, float height);

/// Looks at the target from as far as before, along `direction` (unit length).
Camera looking(const Camera& camera, glm::vec3 direction);

/// In the same direction, so near that the box fills about 70 % of the picture's height, or of its width where that is
/// narrower than the box; aimed at its middle. `aspect`: width / height of the picture.
Camera framed(const Camera& camera, const Box& box, float aspect);

/// What to frame for an object: the world bounds of a node or of the lamp, without parts that have no end, such as the
/// ground, unless it is nothing else. The whole scene for what has no place.
Box framed_box(const Scene& scene, ObjectRef object);

/// The edits that lead from one camera to the other.
std::vector<Edit> camera_edits(const Camera& from, const Camera& to);

}  // namespace farfield
