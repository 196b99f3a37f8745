// What lies under a point of the picture, by the field itself.
#pragma once

#include "sdf/evaluate.h"

#include <glm/vec2.hpp>

#include <optional>

namespace farfield {

/// Where a camera looks: unit vectors, and the tangent of half its field of view. Horizontal even where it looks
/// straight up or down; towards -z where it has no direction.
struct CameraBasis {
    explicit CameraBasis(const Camera& camera);
    glm::vec3 right, up, forward;
    float half_height;
    /// Unit direction through a point of the picture, (0, 0) its upper left and (1, 1) its lower right corner.
    glm::vec3 direction(glm::vec2 at, float aspect) const;
};

struct Pick {
    float distance;      ///< along the ray, metres
    glm::vec3 position;  ///< world
    Id node;             ///< the shape that shows there: a primitive or an instance
};

/// The first surface that the ray meets; direction is unit length. None where it meets nothing or gives up after 2,000
/// steps. `footprint`: how far off a hit may be for each metre travelled.
std::optional<Pick> pick(const FieldEvaluator& field, glm::vec3 origin, glm::vec3 direction, float footprint = 1e-4f);
/// The same of a scene, for rays near its camera, wherever that is (sdf/local_scene.h).
std::optional<Pick> pick(const Scene& scene, glm::vec3 origin, glm::vec3 direction, float footprint = 1e-4f);

}  // namespace farfield
