#include "sdf/placement.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>

namespace farfield {
namespace {

/// Degrees about x, then y, then z, rounded: more digits would be noise.
glm::vec3 angles_of(const glm::dmat3& m) {
    const double cosine = std::hypot(m[0][0], m[0][1]);
    glm::dvec3 angles(std::atan2(m[1][2], m[2][2]), std::atan2(-m[0][2], cosine), std::atan2(m[0][1], m[0][0]));
    if (cosine < 1e-9) angles.x = 0.0, angles.z = std::atan2(-m[1][0], m[1][1]);  // x and z turn about one axis
    constexpr double step = 1e4;
    return glm::vec3(glm::round(glm::degrees(angles) * step) / step) + 0.0f;
}

}  // namespace

// Where nothing is turned, the angles stay as they were typed.
Transform composed(const Transform& outer, const Transform& inner) {
    const glm::dmat3 turn = exact_rotation_matrix(outer);
    const glm::vec3 none(0.0f), translate(turn * glm::dvec3(outer.scale * inner.translate));
    return {outer.translate + translate,
            outer.rotate == none   ? inner.rotate
            : inner.rotate == none ? outer.rotate
                                   : angles_of(turn * exact_rotation_matrix(inner)),
            outer.scale * inner.scale};
}

Transform relative_to(const Transform& outer, const Transform& placed) {
    const glm::dmat3 back = glm::transpose(exact_rotation_matrix(outer));
    const glm::vec3 none(0.0f), translate(back * glm::dvec3(placed.translate - outer.translate));
    return {translate / outer.scale,
            outer.rotate == none            ? placed.rotate
            : outer.rotate == placed.rotate ? none
                                            : angles_of(back * exact_rotation_matrix(placed)),
            placed.scale / outer.scale};
}

Transform frame_of(const Scene& scene, Id node) {
    Transform frame;
    for (const Node* n = find_node(scene, node); n; n = find_parent(scene, n->id))
        frame = composed(n->transform, frame);
    return frame;
}

Transform moved_transform(const Scene& scene, const Transform& transform, Id from, Id to) {
    return relative_to(frame_of(scene, to), composed(frame_of(scene, from), transform));
}

}  // namespace farfield
