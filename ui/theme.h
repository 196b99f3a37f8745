// Colours, metrics and fonts: one dark, low-contrast surface so that the picture is the brightest thing on screen, and
// one warm accent for what is selected or changed.
#pragma once

#include "sdf/node_kinds.h"

#include <imgui.h>

namespace farfield {

struct Theme {
    float scale = 1.0f;  ///< of every size, for displays of high density
    ImFont* regular = nullptr;
    ImFont* bold = nullptr;
    ImFont* small_font = nullptr;
    ImFont* mono = nullptr;  ///< for code

    ImU32 accent = IM_COL32(240, 165, 80, 255);
    ImU32 text = IM_COL32(222, 226, 232, 255);
    ImU32 dim = IM_COL32(140, 148, 160, 255);
    ImU32 warning = IM_COL32(232, 196, 92, 255);
    ImU32 error = IM_COL32(235, 105, 95, 255);
    ImU32 error_background = IM_COL32(74, 32, 32, 255);
    ImU32 header = IM_COL32(37, 41, 48, 255);
    ImU32 overlay = IM_COL32(18, 20, 24, 205);
    ImU32 axis[3] = {IM_COL32(217, 96, 90, 255), IM_COL32(120, 178, 90, 255), IM_COL32(90, 143, 217, 255)};

    float px(float size) const { return size * scale; }
    ImU32 role(Role role) const;
};

/// Sets the current ImGui context's style and fonts. `pixel_scale`: density of the display, 1 at 96 dpi. Fonts: Inter
/// and JetBrains Mono through FreeType, else DejaVu, else the one that ImGui brings.
Theme make_theme(float pixel_scale);

}  // namespace farfield
