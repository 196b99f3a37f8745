#include "sdf/pick.h"

#include "sdf/local_scene.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace farfield {

CameraBasis::CameraBasis(const Camera& camera) : half_height(std::tan(0.5f * glm::radians(camera.field_of_view))) {
    forward = camera.target - camera.position;
    forward = glm::length(forward) > 0.0f ? glm::normalize(forward) : glm::vec3(0.0f, 0.0f, -1.0f);
    right = glm::cross(forward, glm::vec3(0.0f, 1.0f, 0.0f));
    right = glm::length(right) > 1e-6f ? glm::normalize(right) : glm::vec3(1.0f, 0.0f, 0.0f);
    up = glm::cross(right, forward);
}

glm::vec3 CameraBasis::direction(glm::vec2 at, float aspect) const {
    const glm::vec2 q = 2.0f * at - 1.0f;
    return glm::normalize(forward + half_height * (q.x * aspect * right - q.y * up));
}

std::optional<Pick> pick(const FieldEvaluator& field, glm::vec3 origin, glm::vec3 direction, float footprint) {
    constexpr int most_steps = 2000;
    const Box box = field.tree().bounds().grown(1e-3f);
    // Where the ray is within the scene's bounds.
    float t = 0.0f, end = unbounded;
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0.0f) {
            if (origin[axis] < box.low[axis] || origin[axis] > box.high[axis]) return std::nullopt;
            continue;
        }
        const float a = (box.low[axis] - origin[axis]) / direction[axis],
                    b = (box.high[axis] - origin[axis]) / direction[axis];
        t = std::max(t, std::min(a, b));
        end = std::min(end, std::max(a, b));
    }
    for (int i = 0; i < most_steps && t <= end; ++i) {
        const glm::vec3 p = origin + t * direction;
        const float d = field.distance(p);
        if (d < std::max(footprint * t, 1e-6f)) return Pick{t, p, field.owner(p)};
        t += d;
    }
    return std::nullopt;
}

std::optional<Pick> pick(const Scene& scene, glm::vec3 origin, glm::vec3 direction, float footprint) {
    const glm::vec3 from = local_origin(scene.camera);
    auto hit = pick(FieldEvaluator(local_scene(scene)), origin - from, direction, footprint);
    if (hit) hit->position += from;
    return hit;
}

}  // namespace farfield
