// Where a node's frame is in the world: the chain of transforms above it.
#pragma once

#include "sdf/scene.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <optional>

namespace farfield {

/// world = rotation * (scale * p) + origin
struct Frame {
    glm::vec3 origin{0.0f};
    glm::mat3 rotation{1.0f};
    float scale = 1.0f;

    glm::vec3 to_world(glm::vec3 p) const { return rotation * (scale * p) + origin; }
    /// The frame that `transform` places in this one.
    Frame placed(const Transform& transform) const;
};

/// The frame that node `id` is placed in. Where something above bends or repeats space, that of the original copy;
/// inside a definition, as its first instance shows it, or in the definition's own frame where there is none. None for
/// unknown ids and where numbers are beyond what single precision holds.
std::optional<Frame> parent_frame(const Scene& scene, Id id);

}  // namespace farfield
