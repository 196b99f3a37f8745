// What the user made of the splitters; a small window may have no room for it.
#pragma once

namespace farfield {

/// At 96 dpi.
struct PanelSizes {
    float left = 250.0f, right = 336.0f;        ///< widths of the columns
    float objects = 238.0f, settings = 302.0f;  ///< heights of their lower panels
    float code_width = 660.0f, code_height = 330.0f;
};

}  // namespace farfield
