#include "app/gizmo_math.h"

#include "sdf/fields.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>

namespace farfield {
namespace {

using glm::vec2;
using glm::vec3;

constexpr float reach = 9.0f;       // pixels from a line within which it is taken
constexpr float middle = 0.11f;     // radius of the disc in the middle, of an axis's length
constexpr float axis_from = 0.18f;  // where the line of an axis begins
constexpr float plane_low = 0.30f, plane_high = 0.52f;
constexpr float ring_radius = 0.92f, view_ring_radius = 1.12f;
constexpr int ring_points = 64;
constexpr float farthest = 30.0f;  // that a hand moves something, of its distance from the eye

bool is_finite(vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

float smooth(float low, float high, float v) {
    const float t = std::clamp((v - low) / (high - low), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

float distance_to_segment(vec2 p, vec2 a, vec2 b) {
    const vec2 ab = b - a;
    const float t = glm::dot(ab, ab) > 0.0f ? std::clamp(glm::dot(p - a, ab) / glm::dot(ab, ab), 0.0f, 1.0f) : 0.0f;
    return glm::distance(p, a + t * ab);
}

bool is_inside(const std::vector<vec2>& polygon, vec2 p) {
    bool inside = false;
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
        const vec2 a = polygon[i], b = polygon[j];
        if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)) inside = !inside;
    }
    return inside;
}

/// In double precision, so that quarter turns come out as such.
double rounded_to(double value, double step) { return std::round(value / step) * step; }

float with_decimals(double value, double step) {
    // A product with a power of ten below one is no clean decimal, a quotient by one above is.
    return static_cast<float>(step < 1.0 ? std::round(value * std::round(1.0 / step)) / std::round(1.0 / step)
                                         : rounded_to(value, step));
}

double decimal_below(double v) { return std::pow(10.0, std::floor(std::log10(v))); }

float wrapped(float degrees) { return degrees - 360.0f * std::round(degrees / 360.0f); }

}  // namespace

std::vector<Handle> handles(Tool tool) {
    using enum Handle::Part;
    switch (tool) {
        case Tool::none:
            return {};
        case Tool::move:
            return {{plane, 0}, {plane, 1}, {plane, 2}, {axis, 0}, {axis, 1}, {axis, 2}, {view, 0}};
        case Tool::rotate:
            return {{view, 0}, {axis, 0}, {axis, 1}, {axis, 2}};
        case Tool::scale:
            return {{view, 0}};
    }
    return {};
}

GizmoShape::GizmoShape(const PictureView& view, Tool tool, const Pose& pose, float length)
    : view_(view), tool_(tool), pose_(pose), length_(length) {
    const auto at = is_finite(pose.origin) ? view.project(pose.origin) : std::nullopt;
    if (!at) return;
    centre_ = *at;
    metres_ = length * view.metres_per_pixel(pose.origin);
    // A camera inside the gizmo, as with a very wide view, would see it from within.
    if (!std::isfinite(metres_) || !(metres_ > 0.0f)) metres_ = 0.0f;
}

float GizmoShape::strength(Handle handle) const {
    if (!visible()) return 0.0f;
    if (handle.part == Handle::Part::view || tool_ == Tool::rotate) return 1.0f;
    const float facing = std::abs(glm::dot(pose_.axes[handle.axis], glm::normalize(view_.eye - pose_.origin)));
    return handle.part == Handle::Part::axis ? 1.0f - smooth(0.95f, 0.99f, facing) : smooth(0.08f, 0.22f, facing);
}

std::vector<GizmoShape::Point> GizmoShape::ring(int axis) const {
    const vec3 u = pose_.axes[(axis + 1) % 3], v = pose_.axes[(axis + 2) % 3], to_eye = view_.eye - pose_.origin;
    std::vector<Point> points;
    for (int i = 0; i <= ring_points; ++i) {
        const float a = glm::radians(360.0f) * static_cast<float>(i % ring_points) / ring_points;
        const vec3 out = std::cos(a) * u + std::sin(a) * v;
        const bool far = glm::dot(out, glm::normalize(to_eye)) < -0.02f;
        points.push_back({pose_.origin + ring_radius * metres_ * out, far});
    }
    return points;
}

std::vector<vec2> GizmoShape::outline(Handle handle) const {
    std::vector<vec2> pixels;
    if (!visible()) return pixels;
    const auto add = [&](vec3 p) {
        if (const auto at = view_.project(p)) pixels.push_back(*at);
    };
    const auto circle = [&](float radius) {
        for (int i = 0; i <= ring_points; ++i) {
            const float a = glm::radians(360.0f) * static_cast<float>(i) / ring_points;
            pixels.push_back(centre_ + radius * length_ * vec2(std::cos(a), std::sin(a)));
        }
    };
    std::size_t wanted = 2;
    if (handle.part == Handle::Part::view) {
        circle(tool_ == Tool::move ? middle : view_ring_radius);
        return pixels;
    }
    if (tool_ == Tool::rotate) {
        for (const Point& point : ring(handle.axis)) add(point.place);
        wanted = ring_points + 1;
    } else if (handle.part == Handle::Part::axis) {
        const vec3 axis = metres_ * pose_.axes[handle.axis];
        add(pose_.origin + axis_from * axis);
        add(pose_.origin + axis);
    } else {
        const vec3 u = metres_ * pose_.axes[(handle.axis + 1) % 3], v = metres_ * pose_.axes[(handle.axis + 2) % 3];
        for (const vec2 at : {vec2(plane_low, plane_low), vec2(plane_high, plane_low), vec2(plane_high, plane_high),
                              vec2(plane_low, plane_high)})
            add(pose_.origin + at.x * u + at.y * v);
        wanted = 4;
    }
    // Partly behind the camera: what is left of it would be another shape.
    if (pixels.size() != wanted) pixels.clear();
    return pixels;
}

std::vector<bool> GizmoShape::hidden(Handle handle) const {
    std::vector<bool> far;
    if (tool_ == Tool::rotate && handle.part == Handle::Part::axis)
        for (const Point& point : ring(handle.axis)) far.push_back(point.far);
    return far;
}

std::optional<vec2> GizmoShape::grip(Handle handle) const {
    const std::vector<vec2> line = outline(handle);
    if (line.empty()) return std::nullopt;
    if (handle.part == Handle::Part::plane) return 0.25f * (line[0] + line[1] + line[2] + line[3]);
    if (tool_ == Tool::move) return handle.part == Handle::Part::view ? centre_ : glm::mix(line[0], line[1], 0.8f);
    if (handle.part == Handle::Part::view)
        return centre_ + view_ring_radius * length_ * vec2(0.70710678f, -0.70710678f);
    // Of a ring, the near point that is farthest from all others' lines.
    const std::vector<bool> far = hidden(handle);
    std::optional<vec2> best;
    float most = -1.0f;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        if (far[i]) continue;
        float room = glm::distance(line[i], centre_);
        for (int other = 0; other < 3; ++other) {
            if (other == handle.axis) continue;
            const std::vector<vec2> rival = outline({Handle::Part::axis, other});
            for (std::size_t k = 0; k + 1 < rival.size(); ++k)
                room = std::min(room, distance_to_segment(line[i], rival[k], rival[k + 1]));
        }
        if (room > most) most = room, best = line[i];
    }
    return best;
}

std::optional<Handle> GizmoShape::at(vec2 mouse) const {
    if (!visible()) return std::nullopt;
    std::optional<Handle> best;
    float nearest = reach;
    for (const Handle handle : handles(tool_)) {
        if (strength(handle) < 0.3f) continue;
        const std::vector<vec2> line = outline(handle);
        if (line.empty()) continue;
        const std::vector<bool> far = hidden(handle);
        float distance = 1e9f;
        const bool filled = tool_ == Tool::move && handle.part != Handle::Part::axis;
        if (filled && is_inside(line, mouse))
            distance = handle.part == Handle::Part::view ? 0.0f : 3.0f;  // a line over a plane goes first
        else
            for (std::size_t i = 0; i + 1 < line.size(); ++i)
                if (far.empty() || !(far[i] && far[i + 1]))
                    distance = std::min(distance, distance_to_segment(mouse, line[i], line[i + 1]));
        if (distance < nearest) nearest = distance, best = handle;
    }
    return best;
}

std::optional<float> along_axis(const Ray& ray, vec3 origin, vec3 axis) {
    const vec3 to = origin - ray.origin;
    const float cosine = glm::dot(axis, ray.direction), across = 1.0f - cosine * cosine;
    if (!(across > 1e-5f)) return std::nullopt;
    const float along_ray = (glm::dot(to, ray.direction) - cosine * glm::dot(to, axis)) / across;
    const float along = cosine * along_ray - glm::dot(to, axis);
    if (!(along_ray > 0.0f) || !std::isfinite(along)) return std::nullopt;
    return along;
}

std::optional<vec3> on_plane(const Ray& ray, vec3 origin, vec3 normal) {
    const float towards = glm::dot(ray.direction, normal);
    if (!(std::abs(towards) > 1e-4f)) return std::nullopt;
    const float distance = glm::dot(origin - ray.origin, normal) / towards;
    const vec3 point = ray.origin + distance * ray.direction;
    if (!(distance > 0.0f) || !is_finite(point)) return std::nullopt;
    return point;
}

float snapped(float value, float step) { return step > 0.0f ? std::round(value / step) * step : value; }

GizmoDrag::GizmoDrag(const PictureView& view, Tool tool, Handle handle, const Pose& pose, vec2 mouse, float length)
    : view_(view), tool_(tool), handle_(handle), pose_(pose), start_(mouse) {
    centre_ = view.project(pose.origin).value_or(mouse);
    normal_ = handle.part == Handle::Part::view ? -view.basis.forward : pose.axes[handle.axis];
    if (tool == Tool::rotate && handle.part == Handle::Part::axis) {
        const vec3 to_eye = glm::normalize(view.eye - pose.origin);
        if (std::abs(glm::dot(normal_, to_eye)) < 0.2f) {
            // On edge: the near side of the ring moves along its line, a radius of pixels for a radian.
            const vec3 direction = glm::cross(normal_, to_eye);
            const vec2 on_screen{glm::dot(direction, view.basis.right), -glm::dot(direction, view.basis.up)};
            if (glm::length(on_screen) > 0.0f)
                along_ = glm::normalize(on_screen) * glm::degrees(1.0f / std::max(ring_radius * length, 1.0f));
        }
    }
    first_ = point(mouse);
    last_direction_ = direction(mouse);
}

std::optional<vec3> GizmoDrag::point(vec2 mouse) const {
    const Ray ray = view_.ray(mouse);
    std::optional<vec3> at;
    if (tool_ == Tool::move && handle_.part == Handle::Part::axis) {
        if (const auto along = along_axis(ray, pose_.origin, pose_.axes[handle_.axis]))
            at = pose_.origin + *along * pose_.axes[handle_.axis];
    } else {
        at = on_plane(ray, pose_.origin, normal_);
    }
    // Towards the horizon a pixel is kilometres.
    const bool near = at && glm::distance(*at, view_.eye) < farthest * glm::distance(pose_.origin, view_.eye);
    return near ? at : std::nullopt;
}

float GizmoDrag::direction(vec2 mouse) const {
    if (handle_.part == Handle::Part::view) {
        const vec2 out = mouse - centre_;
        return out == vec2(0.0f) ? last_direction_ : glm::degrees(std::atan2(-out.y, out.x));
    }
    const auto at = point(mouse);
    if (!at) return last_direction_;
    const vec3 out = *at - pose_.origin;
    return glm::degrees(std::atan2(glm::dot(out, pose_.axes[(handle_.axis + 2) % 3]),
                                   glm::dot(out, pose_.axes[(handle_.axis + 1) % 3])));
}

Motion GizmoDrag::to(vec2 mouse, Snap snap) {
    Motion motion;
    motion.axis = normal_;
    if (tool_ == Tool::move) {
        if (!first_) first_ = point(mouse);
        if (const auto now = point(mouse)) shift_ = *now - *first_;
        motion.shift = shift_;
        if (snap.metres > 0.0f) {
            // Along the handle's own directions.
            glm::mat3 axes = pose_.axes;
            if (handle_.part == Handle::Part::view) axes = {view_.basis.right, view_.basis.up, view_.basis.forward};
            motion.shift = vec3(0.0f);
            for (int i = 0; i < 3; ++i) motion.shift += snapped(glm::dot(shift_, axes[i]), snap.metres) * axes[i];
        }
    } else if (tool_ == Tool::rotate) {
        if (along_ != vec2(0.0f)) {
            turned_ = glm::dot(mouse - start_, along_);
        } else {
            const float now = direction(mouse);
            turned_ += wrapped(now - last_direction_);
            last_direction_ = now;
        }
        motion.angle = snapped(turned_, snap.degrees);
    } else if (tool_ == Tool::scale) {
        const float from = glm::distance(start_, centre_), now = glm::distance(mouse, centre_);
        if (from > 0.0f) factor_ = std::clamp(now / from, 1e-2f, 1e2f);
        motion.factor = snap.factor > 0.0f ? std::max(snapped(factor_, snap.factor), snap.factor) : factor_;
    }
    return motion;
}

vec3 euler_angles(const glm::mat3& rotation, vec3 near) {
    const auto angle = [](float sine, float cosine) { return glm::degrees(std::atan2(sine, cosine)); };
    const float sine = std::clamp(-rotation[0][2], -1.0f, 1.0f);
    vec3 a, b;
    if (std::abs(sine) > 0.999999f) {
        // At the pole x and z turn about the same axis: x stays.
        const float side = sine > 0.0f ? 1.0f : -1.0f;
        const float sum = angle(-rotation[1][0], rotation[1][1]);
        a = b = {near.x, side * 90.0f, sum + side * near.x};
    } else {
        a = {angle(rotation[1][2], rotation[2][2]), glm::degrees(std::asin(sine)),
             angle(rotation[0][1], rotation[0][0])};
        b = {a.x + 180.0f, 180.0f - a.y, a.z + 180.0f};
    }
    const auto continued = [&](vec3 v) {
        for (int i = 0; i < 3; ++i) v[i] = near[i] + wrapped(v[i] - near[i]);
        return v;
    };
    a = continued(a), b = continued(b);
    const auto far = [&](vec3 v) {
        const vec3 d = glm::abs(v - near);
        return d.x + d.y + d.z;
    };
    return far(b) < far(a) ? b : a;
}

namespace {

/// Numbers that a motion does not change stay as they are; the others get clean decimals.
vec3 clean(vec3 start, vec3 end, double step) {
    vec3 result = start;
    if (!is_finite(end)) return start;
    for (int i = 0; i < 3; ++i)
        if (std::abs(static_cast<double>(end[i]) - start[i]) > 0.01 * step) result[i] = with_decimals(end[i], step);
    return result;
}

/// The power of ten that is no larger than a pixel.
double decimals_for(float metres_per_pixel) {
    if (!std::isfinite(metres_per_pixel) || !(metres_per_pixel > 0.0f)) return 1e-4;
    return std::clamp(decimal_below(metres_per_pixel), 1e-6, 1e3);
}

glm::dmat3 rotation_about(vec3 axis, float degrees) {
    return glm::dmat3(glm::rotate(glm::dmat4(1.0), glm::radians(static_cast<double>(degrees)), glm::dvec3(axis)));
}

}  // namespace

Transform moved(const Transform& start, const Frame& parent, const Motion& motion, float metres_per_pixel, vec3 near) {
    Transform result = start;
    const auto inside = [](std::string_view key, vec3 value, vec3 otherwise) {
        if (!is_finite(value)) return otherwise;
        for (const Field<Transform>& field : fields<Transform>())
            if (field.parameter.key == key) return clamped(field.parameter, value);
        return otherwise;
    };
    if (motion.shift != vec3(0.0f)) {
        const vec3 shift = glm::transpose(parent.rotation) * motion.shift / parent.scale;
        result.translate = inside(
            "translate", clean(start.translate, start.translate + shift, decimals_for(metres_per_pixel / parent.scale)),
            start.translate);
    }
    if (motion.angle != 0.0f) {
        const glm::dmat3 to_world(parent.rotation);
        const glm::mat3 turned(glm::transpose(to_world) * rotation_about(motion.axis, motion.angle) * to_world *
                               glm::dmat3(rotation_matrix(start)));
        result.rotate = inside("rotate", clean(start.rotate, euler_angles(turned, near), 0.01), start.rotate);
    }
    if (motion.factor != 1.0f) {
        const double scale = static_cast<double>(start.scale) * motion.factor;
        if (std::isfinite(scale) && scale > 0.0)
            result.scale =
                inside("scale", vec3(with_decimals(scale, 1e-2 * decimal_below(scale))), vec3(start.scale)).x;
    }
    return result;
}

vec3 moved_point(vec3 start, const Motion& motion, float metres_per_pixel) {
    return glm::clamp(clean(start, start + motion.shift, decimals_for(metres_per_pixel)), -largest_value,
                      largest_value);
}

vec3 turned_direction(vec3 start, const Motion& motion) {
    const vec3 turned(rotation_about(motion.axis, motion.angle) * glm::dvec3(start));
    if (!is_finite(turned) || glm::length(turned) == 0.0f) return start;
    const vec3 result = clean(start, turned, 1e-2 * decimal_below(glm::length(turned)));
    return glm::length(result) > 0.0f ? result : start;
}

}  // namespace farfield
