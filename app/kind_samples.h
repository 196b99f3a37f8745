// A picture's scene for any node kind, made from the table alone, so that a new kind needs nothing here.
#pragma once

#include "sdf/scene.h"

namespace farfield {

/// The kind with what makes it recognisable, on a neutral floor in daylight, filling a picture of this aspect (width /
/// height). A primitive stands alone; a combination gets a slab with a ball on it, a modifier a slab with a ball at its
/// edge, what changes distances a box; what is hollow inside is cut open. Parameters have their defaults,
/// those of operations that would do nothing a value that shows.
Scene sample_scene(const KindInfo& kind, float aspect);

}  // namespace farfield
