// The scene as the picture on screen shows it: from points of the world to pixels and back. Pixels are ImGui's units, y
// down; the picture's upper left corner is at `low`.
#pragma once

#include "sdf/pick.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace farfield {

/// The grid of a view: the power of ten that is some fifth of how far the eye is from what it looks at.
inline float grid_step(const Camera& camera) {
    const float distance = glm::distance(camera.position, camera.target);
    if (!std::isfinite(distance) || !(distance > 0.0f)) return 1.0f;
    return std::clamp(std::pow(10.0f, std::floor(std::log10(distance / 1.5f))), 1e-3f, 1e5f);
}

struct Ray {
    glm::vec3 origin, direction;  ///< unit direction
};

struct PictureView {
    PictureView(const Camera& camera, glm::vec2 upper_left, glm::vec2 extent)
        : eye(camera.position), basis(camera), low(upper_left), size(glm::max(extent, glm::vec2(1.0f))) {}

    glm::vec3 eye;
    CameraBasis basis;
    glm::vec2 low, size;

    float aspect() const { return size.x / size.y; }
    /// Metres in front of the camera; negative behind it.
    float depth(glm::vec3 p) const { return glm::dot(p - eye, basis.forward); }
    /// None for points that are behind the camera or as good as in it.
    std::optional<glm::vec2> project(glm::vec3 p) const {
        const float d = depth(p);
        if (!(d > 1e-5f)) return std::nullopt;
        const float pixels = 0.5f * size.y / (d * basis.half_height);
        const glm::vec2 at =
            low + 0.5f * size + pixels * glm::vec2(glm::dot(p - eye, basis.right), -glm::dot(p - eye, basis.up));
        // Far outside lines lose their way to the pixels of the picture.
        if (!(std::abs(at.x) < 1e5f && std::abs(at.y) < 1e5f)) return std::nullopt;
        return at;
    }
    Ray ray(glm::vec2 pixel) const { return {eye, basis.direction((pixel - low) / size, aspect())}; }
    /// What a pixel is wide at the distance of p; 0 where `project` has no answer.
    float metres_per_pixel(glm::vec3 p) const {
        return project(p) ? 2.0f * depth(p) * basis.half_height / size.y : 0.0f;
    }
};

}  // namespace farfield
