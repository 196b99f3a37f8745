// A scene that was written by another program, or read again, has ids of its own. What is meant to be the same object
// is told by its name or, for nodes without one, by its place and kind.
#pragma once

#include "sdf/scene.h"

namespace farfield {

/// `scene` with the ids that its nodes, materials and lights have in `old`; what is not there gets ids that `old` never
/// used.
Scene with_ids_of(Scene scene, const Scene& old);

}  // namespace farfield
