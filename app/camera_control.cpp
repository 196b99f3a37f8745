#include "app/camera_control.h"

#include "sdf/field_tree.h"
#include "sdf/pick.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace farfield {
namespace {

using glm::vec3;

constexpr float nearest_distance = 1e-3f, farthest_distance = 1e5f;
constexpr float steepest = 89.5f;  // degrees above or below the horizon: straight up has no sideways

vec3 rounded(vec3 v) {
    // A tenth of a millimetre is finer than a hand, and keeps files readable.
    return {std::round(v.x * 1e4f) / 1e4f, std::round(v.y * 1e4f) / 1e4f, std::round(v.z * 1e4f) / 1e4f};
}

/// A turn about the vertical by angle.x and then about the camera's horizontal by angle.y, radians, so far that it
/// never looks straight up or down.
glm::mat3 turned(const Camera& camera, glm::vec2 angle) {
    const CameraBasis basis(camera);
    const float limit = glm::radians(steepest), now = std::asin(std::clamp(basis.forward.y, -1.0f, 1.0f));
    const float pitch = std::clamp(now + angle.y, -limit, limit) - now;
    const glm::mat4 whole = glm::rotate(glm::mat4(1.0f), angle.x, vec3(0.0f, 1.0f, 0.0f)) *
                            glm::rotate(glm::mat4(1.0f), pitch, basis.right);
    return glm::mat3(whole);
}

}  // namespace

Camera orbited(const Camera& camera, vec3 pivot, glm::vec2 drag, float height) {
    const glm::mat3 turn = turned(camera, -drag * (glm::pi<float>() / std::max(height, 1.0f)));
    Camera moved = camera;
    moved.position = pivot + turn * (camera.position - pivot);
    moved.target = pivot + turn * (camera.target - pivot);
    return moved;
}

Camera panned(const Camera& camera, vec3 held, glm::vec2 drag, float height) {
    const CameraBasis basis(camera);
    const float distance = std::max(glm::dot(held - camera.position, basis.forward), nearest_distance);
    const float scale = 2.0f * distance * basis.half_height / std::max(height, 1.0f);
    const vec3 shift = (-drag.x * basis.right + drag.y * basis.up) * scale;
    Camera moved = camera;
    moved.position += shift;
    moved.target += shift;
    return moved;
}

Camera zoomed(const Camera& camera, vec3 about, float steps) {
    const float distance = glm::length(camera.position - camera.target);
    if (distance <= 0.0f) return camera;
    const float to = std::clamp(distance * std::pow(0.88f, steps), 10.0f * nearest_distance, farthest_distance);
    Camera moved = camera;
    moved.position = about + (camera.position - about) * (to / distance);
    moved.target = about + (camera.target - about) * (to / distance);
    return moved;
}

Camera flown(const Camera& camera, vec3 move, glm::vec2 drag, float height) {
    const CameraBasis basis(camera);
    const glm::mat3 turn = turned(camera, -drag * (glm::half_pi<float>() / std::max(height, 1.0f)));
    Camera moved = camera;
    moved.position += turn * (move.x * basis.right + move.z * basis.forward) + vec3(0.0f, move.y, 0.0f);
    moved.target = moved.position + turn * (camera.target - camera.position);
    return moved;
}

Camera looking(const Camera& camera, vec3 direction) {
    const float distance = std::max(glm::length(camera.target - camera.position), 10.0f * nearest_distance);
    Camera moved = camera;
    moved.position = camera.target - distance * direction;
    return moved;
}

// At distance D from its middle the corner o of the box is seen at |o . up| / ((D + o . forward) tan(fov / 2)) of half
// the picture's height above or below the middle; D is the largest at which some corner is just at the fraction wanted.
Camera framed(const Camera& camera, const Box& box, float aspect) {
    constexpr float filled = 0.7f, smallest = 0.02f;  // of the picture; metres, to be seen from a sensible distance
    const CameraBasis axes(camera);
    const vec3 half = glm::max(0.5f * box.size(), vec3(smallest));
    const float high = filled * axes.half_height, wide = high * aspect;
    float distance = 0.0f;
    for (int corner = 0; corner < 8; ++corner) {
        const vec3 o = half * vec3(corner & 1 ? 1.0f : -1.0f, corner & 2 ? 1.0f : -1.0f, corner & 4 ? 1.0f : -1.0f);
        const float across = std::max(std::abs(glm::dot(o, axes.up)) / high, std::abs(glm::dot(o, axes.right)) / wide);
        distance = std::max(distance, across - glm::dot(o, axes.forward));
    }
    Camera moved = camera;
    moved.target = box.centre();
    moved.position = moved.target - distance * axes.forward;
    return moved;
}

Box framed_box(const Scene& scene, ObjectRef object) {
    const vec3 about(0.5f);
    if (object.type == ObjectType::light)
        if (const Light* light = find_light(scene, object.id); light && light->kind == LightKind::point)
            return {light->position - about, light->position + about};
    const FieldTree tree(scene);
    std::optional<Box> whole;
    for (const Id id : {object.type == ObjectType::node ? object.id : scene.root.id, scene.root.id}) {
        if (const auto box = finite_bounds(tree, id)) return *box;
        if (!whole) whole = world_bounds(tree, id);
    }
    // Without end: where it has one, and as far about the camera's target along the other axes.
    Box box = whole.value_or(Box{-about, about});
    float half = 0.0f;
    for (int axis = 0; axis < 3; ++axis)
        if (box.is_bounded(axis)) half = std::max(half, 0.5f * box.size()[axis]);
    if (half == 0.0f) half = 1.0f;
    for (int axis = 0; axis < 3; ++axis) {
        if (box.is_bounded(axis)) continue;
        const float middle = std::clamp(scene.camera.target[axis], box.low[axis], box.high[axis]);
        box.low[axis] = middle - half, box.high[axis] = middle + half;
    }
    return box;
}

std::vector<Edit> camera_edits(const Camera& from, const Camera& to) {
    std::vector<Edit> edits;
    const ObjectRef camera{ObjectType::camera, 0};
    for (const Field<Camera>& field : fields<Camera>()) {
        const bool place = field.parameter.unit == Unit::metres;
        const vec3 value = clamped(field.parameter, place ? rounded(field.get(to)) : field.get(to));
        if (field.get(from) != value && field.get(from) != field.get(to))
            edits.push_back(SetValue{camera, field.parameter.key, value});
    }
    return edits;
}

}  // namespace farfield
