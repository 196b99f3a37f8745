#include "sdf/placement.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>

namespace farfield {
namespace {

/// Degrees about x, then y, then z. Rotations are known to single precision, so that more digits would be noise.
glm::vec3 angles_of(const glm::dmat3& m) {
    const double sine = glm::clamp(-m[0][2], -1.0, 1.0);
    glm::dvec3 angles(std::atan2(m[1][2], m[2][2]), std::asin(sine), std::atan2(m[0][1], m[0][0]));
    if (std::abs(sine) > 1.0 - 1e-12) angles.x = 0.0, angles.z = std::atan2(-m[1][0], m[1][1]);  // x and z are one axis
    constexpr double step = 1e4;
    return glm::vec3(glm::round(glm::degrees(angles) * step) / step) + 0.0f;
}

glm::vec3 composed_angles(const Transform& a, const Transform& b) {
    if (a.rotate == glm::vec3(0.0f)) return b.rotate;
    if (b.rotate == glm::vec3(0.0f)) return a.rotate;
    return angles_of(glm::dmat3(rotation_matrix(a)) * glm::dmat3(rotation_matrix(b)));
}

}  // namespace

Transform composed(const Transform& outer, const Transform& inner) {
    const glm::vec3 moved = rotation_matrix(outer) * (outer.scale * inner.translate);
    return {outer.translate + moved, composed_angles(outer, inner), outer.scale * inner.scale};
}

Transform relative_to(const Transform& outer, const Transform& placed) {
    const glm::mat3 back = glm::transpose(rotation_matrix(outer));
    const Transform turned_back{glm::vec3(0.0f), angles_of(glm::dmat3(back)), 1.0f};
    const glm::vec3 angles = outer.rotate == placed.rotate ? glm::vec3(0.0f) : composed_angles(turned_back, placed);
    return {back * (placed.translate - outer.translate) / outer.scale,
            outer.rotate == glm::vec3(0.0f) ? placed.rotate : angles, placed.scale / outer.scale};
}

Transform frame_of(const Scene& scene, Id node) {
    Transform frame;
    for (const Node* n = find_node(scene, node); n; n = find_parent(scene, n->id))
        frame = composed(n->transform, frame);
    return frame;
}

}  // namespace farfield
