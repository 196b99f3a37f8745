// GLSL as text on the screen, in the colours that all panels share. The font is the current one, of cells of one width.
#pragma once

#include "ui/ui.h"

#include <cstddef>
#include <string_view>

namespace farfield {

/// Cells that UTF-8 text takes; a tab takes four, as ImGui draws it.
std::size_t cells_of(std::string_view text);

/// Draws a line; `cell` is the width of a character.
void draw_glsl(const Ui& ui, ImDrawList& draw, std::string_view line, ImVec2 at, float cell);

}  // namespace farfield
