// Placements one inside the other.
#pragma once

#include "sdf/scene.h"

namespace farfield {

/// What `inner` is in the frame that `outer` is placed in.
Transform composed(const Transform& outer, const Transform& inner);
/// The transform whose composition with `outer` is `placed`.
Transform relative_to(const Transform& outer, const Transform& placed);

/// Where a node's children's frame is in the world, or in the frame of the definition that it is in, by the placements
/// of the node and of all that it is in; operations that move space are not looked at.
Transform frame_of(const Scene& scene, Id node);
/// A child of `from` as a child of `to`, in the same place.
Transform moved_transform(const Scene& scene, const Transform& transform, Id from, Id to);

}  // namespace farfield
