#include "sdf/local_scene.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>

namespace farfield {
namespace {

/// Whether its field depends on the place only through the children's.
bool is_placeless(const Node& node) {
    const Role role = info(node.kind).role;
    return role == Role::combine || role == Role::distance;
}

/// Moves a node by this, in its parent's frame.
void move(Node& node, glm::dvec3 by, Id tuned) {
    const glm::dvec3 to = glm::dvec3(node.transform.translate) + by;
    if (!is_placeless(node) || node.id == tuned) {
        node.transform.translate = to;
        return;
    }
    node.transform.translate = glm::vec3(0.0f);
    const glm::dvec3 below =
        glm::transpose(exact_rotation_matrix(node.transform)) * to / static_cast<double>(node.transform.scale);
    for (Node& child : node.children) move(child, below, tuned);
}

}  // namespace

glm::vec3 local_origin(const Camera& camera) {
    const float distance = glm::distance(camera.position, camera.target);
    if (!std::isfinite(distance)) return glm::vec3(0.0f);
    // A power of 16, 16 to 256 times the distance: within half of that a float tells what the view can show.
    constexpr float least = 1.0f, octaves = 4.0f;
    const float step = std::exp2(octaves * std::ceil(std::log2(16.0f * std::max(distance, least)) / octaves));
    const glm::vec3 p = camera.position;
    if (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < 2.0f * step) return glm::vec3(0.0f);
    return step * glm::round(p / step);
}

Scene local_scene(const Scene& scene, Id tuned) {
    Scene local = scene;
    const glm::vec3 origin = local_origin(scene.camera);
    if (origin == glm::vec3(0.0f)) return local;
    move(local.root, -glm::dvec3(origin), tuned);
    for (Light& light : local.lights) light.position -= origin;
    local.camera.position -= origin;
    local.camera.target -= origin;
    return local;
}

}  // namespace farfield
