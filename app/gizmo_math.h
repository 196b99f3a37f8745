// Handles that move, turn and scale what is selected: where they are on screen, which one is under the mouse, and what
// dragging one comes to. No window, no ImGui.
//
// A handle has the same size on screen wherever the object is. Axes that point at the eye and planes seen on edge fade
// out and cannot be taken: a pixel along them would be metres. A ring seen on edge is dragged along its line instead.
#pragma once

#include "app/picture_view.h"
#include "app/world_frame.h"
#include "ui/picture_tools.h"

#include <glm/mat3x3.hpp>

#include <optional>
#include <vector>

namespace farfield {

/// A part of the gizmo. Move: along axis 0 to 2, in the plane across axis 0 to 2, or in the picture's plane. Rotate:
/// about axis 0 to 2, or about the line of sight. Scale: the one there is.
struct Handle {
    enum class Part { axis, plane, view } part = Part::view;
    int axis = 0;
    friend bool operator==(const Handle&, const Handle&) = default;
};

/// Where the gizmo stands and which way its axes point; orthonormal.
struct Pose {
    glm::vec3 origin{0.0f};
    glm::mat3 axes{1.0f};
};

/// All parts of a tool, those in front last.
std::vector<Handle> handles(Tool tool);

/// Shapes of the handles; lengths in pixels are of a gizmo whose axes are `length` long.
class GizmoShape {
public:
    GizmoShape(const PictureView& view, Tool tool, const Pose& pose, float length);

    /// False where the gizmo would be behind the camera or around it, or nowhere.
    bool visible() const { return metres_ > 0.0f; }
    glm::vec2 centre() const { return centre_; }
    float length() const { return length_; }
    /// 1 for what can be taken well, 0 for what cannot be taken at all.
    float strength(Handle handle) const;
    /// The line of an axis, a ring or the outline of a plane or of the middle, as pixels; empty where it is not to be
    /// seen.
    std::vector<glm::vec2> outline(Handle handle) const;
    /// Of a ring's points in outline's order: whether it lies on the far side.
    std::vector<bool> hidden(Handle handle) const;
    /// Where a hand would take it.
    std::optional<glm::vec2> grip(Handle handle) const;
    /// The handle within reach of the mouse.
    std::optional<Handle> at(glm::vec2 mouse) const;

private:
    struct Point {
        glm::vec3 place;
        bool far;
    };
    std::vector<Point> ring(int axis) const;

    PictureView view_;
    Tool tool_;
    Pose pose_;
    float length_, metres_ = 0.0f;  ///< of an axis, on screen and in the world
    glm::vec2 centre_{0.0f};
};

/// What a drag has come to so far, in the world.
struct Motion {
    glm::vec3 shift{0.0f};
    glm::vec3 axis{0.0f, 1.0f, 0.0f};  ///< of the turn
    float angle = 0.0f;                ///< degrees
    float factor = 1.0f;
};

/// Steps that a drag keeps to; 0: none.
struct Snap {
    float metres = 0.0f, degrees = 0.0f, factor = 0.0f;
};

/// A handle that is held, from press to release; the camera stands still meanwhile.
class GizmoDrag {
public:
    GizmoDrag(const PictureView& view, Tool tool, Handle handle, const Pose& pose, glm::vec2 mouse, float length);
    /// Keeps what it had where the mouse is over nothing that has an answer, as beyond a plane's horizon.
    Motion to(glm::vec2 mouse, Snap snap);

    Tool tool() const { return tool_; }
    Handle handle() const { return handle_; }
    const Pose& pose() const { return pose_; }

private:
    std::optional<glm::vec3> point(glm::vec2 mouse) const;
    float direction(glm::vec2 mouse) const;  ///< degrees, of a ring's point

    PictureView view_;
    Tool tool_;
    Handle handle_;
    Pose pose_;
    glm::vec2 start_, centre_{0.0f}, along_{0.0f};  ///< along_: a ring seen on edge, degrees for each pixel
    glm::vec3 normal_{0.0f};                        ///< of the plane that the mouse moves in
    std::optional<glm::vec3> first_;
    glm::vec3 shift_{0.0f};
    float last_direction_ = 0.0f, turned_ = 0.0f, factor_ = 1.0f;
};

/// The parameter of the point of the line that is nearest to the ray; none where they are parallel or it would be
/// behind the eye.
std::optional<float> along_axis(const Ray& ray, glm::vec3 origin, glm::vec3 axis);
/// Where the ray meets the plane; none where it is parallel or the plane is behind the eye.
std::optional<glm::vec3> on_plane(const Ray& ray, glm::vec3 origin, glm::vec3 normal);

/// The nearest multiple of `step`; the value itself where the step is not above 0.
float snapped(float value, float step);

/// The angles (degrees about x, then y, then z) of a rotation that are nearest to `near`: turns go on beyond 180
/// degrees and past the pole without a jump.
glm::vec3 euler_angles(const glm::mat3& rotation, glm::vec3 near);

/// What a motion makes of a transform below `parent`, in decimals that are no finer than a hand: `metres_per_pixel` at
/// the gizmo. Never a value that a transform does not take. `near`: angles that the result continues.
Transform moved(const Transform& start, const Frame& parent, const Motion& motion, float metres_per_pixel,
                glm::vec3 near);

/// The same of a point and of a direction, which keeps its length.
glm::vec3 moved_point(glm::vec3 start, const Motion& motion, float metres_per_pixel);
glm::vec3 turned_direction(glm::vec3 start, const Motion& motion);

}  // namespace farfield
