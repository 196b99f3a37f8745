// What emits, as boxes that rays are sent to more often than by chance (guided_ray in shaders/common.glsl).
#pragma once

#include "renderer/records.h"
#include "sdf/field_tree.h"
#include "sdf/scene.h"

#include <cstddef>
#include <vector>

namespace farfield {

/// Each ray weighs all of them, so only those that give most: the others are met by chance, as without this.
inline constexpr std::size_t most_emitters = 16;

/// Boxes around the shapes with an emissive material, relative to local_origin of the scene's camera; none around what
/// has no end. Conservative, so that what is cut from a shape is still within. `geometry`: the scene's.
std::vector<EmitterRecord> find_emitters(const Scene& scene, const FieldTree& geometry);

}  // namespace farfield
