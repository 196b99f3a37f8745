// The picture in the middle: shows what the renderer made, moves the camera by mouse, selects what is clicked, and
// bears the handles, signs and lines that are drawn over it.
#pragma once

#include "app/gizmo.h"
#include "app/picture_overlay.h"
#include "renderer/render_thread.h"
#include "ui/ui.h"

#include <glm/vec2.hpp>

#include <memory>

namespace farfield {

struct ViewportInput {
    std::shared_ptr<const Scene> shown;  ///< the scene as it is rendered: without code that may not run
    glm::vec3 fly{0.0f};                 ///< keys that are down: right, up and forward
};

struct ViewportResult {
    Edits edits;
    bool wheel = false;    ///< the edits come from the wheel, which has no press and release
    glm::vec2 size{0.0f};  ///< of the picture, in ImGui units
};

class Viewport {
public:
    /// Fills the current ImGui window. `covered`: height at the upper end that something else covers.
    ViewportResult draw(Ui& ui, const Scene& scene, const ViewportInput& input, const RenderedPicture& picture,
                        float covered);

    /// Whether there is something new to draw over the picture.
    bool news() const { return overlay_.news() || overlay_.waits(); }

private:
    enum class Hold { nothing, orbit, pan, fly, gizmo };

    void press(const Ui& ui, const Scene& scene, const ViewportInput& input, const PictureView& view);
    void follow(const Scene& scene, const ViewportInput& input, const PictureView& view, ViewportResult& result);
    void click(Ui& ui, const ViewportInput& input, const PictureView& view) const;

    PictureOverlay overlay_;
    Gizmo gizmo_;
    Hold hold_ = Hold::nothing;
    bool dragged_ = false;       ///< farther than a click
    Camera camera_;              ///< while it is moved, before it is rounded
    glm::vec3 pivot_{0.0f};      ///< what keeps its place in the picture
    float flight_scale_ = 1.0f;  ///< metres from eye to target when the flight began
    float flight_speed_ = 0.6f;  ///< of these, for each second
    Id hovered_light_ = 0;
};

}  // namespace farfield
