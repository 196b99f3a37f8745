// Scenes far from the origin, with their numbers counted from a point near the camera. Floats are 6e-5 m apart at 1,000
// m and 8 mm at 100,000: rays would stop that far off. So everything is moved to the camera, in double precision,
// before code is generated from it, and a scene there looks as it does at the origin.
//
// The translations of groups go down to where distances begin to depend on the place: through all that combines or
// shifts distances, into primitives, instances, and operations that move space. What these hold is as near to them as
// the file says.
#pragma once

#include "sdf/scene.h"

namespace farfield {

/// The point near a camera from which it counts: 0 as long as the camera is not several hundred times as far from the
/// origin as from its target. Moves in large steps, because new numbers are new code.
glm::vec3 local_origin(const Camera& camera);

/// The same scene moved by -local_origin(its camera). `tuned`: a node whose own translation takes in what is above it
/// and passes nothing on: only its numbers may change without new code.
Scene local_scene(const Scene& scene, Id tuned = 0);

}  // namespace farfield
