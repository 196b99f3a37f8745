// The divider in the picture, and what is said and chosen at either side of it.
#pragma once

#include "renderer/render_thread.h"
#include "ui/ui.h"

namespace farfield {

/// What view and settings make of the samples: side A.
Look own_look(const Ui& ui, const Scene& scene);

/// Handle of the divider and labels of both sides, over the picture; the label of B opens a menu of what it shows.
void split_controls(Ui& ui, const Scene& scene, ImVec2 low, ImVec2 size);

/// The picture that was rendered, split where the divider is.
void split_picture(const Ui& ui, const RenderedPicture& picture, ImVec2 low, ImVec2 size);

}  // namespace farfield
