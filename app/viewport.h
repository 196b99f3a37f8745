// The picture in the middle: shows what the renderer made, moves the camera by mouse and selects what is clicked.
#pragma once

#include "renderer/render_thread.h"
#include "ui/ui.h"

#include <glm/vec2.hpp>

namespace farfield {

struct ViewportResult {
    Edits edits;
    bool wheel = false;    ///< the edits come from the wheel, which has no press and release
    glm::vec2 size{0.0f};  ///< of the picture, in ImGui units
};

/// Fills the current ImGui window. `covered`: height at the upper end that something else covers.
ViewportResult viewport(Ui& ui, const Scene& scene, const RenderedPicture& picture, float covered);

}  // namespace farfield
