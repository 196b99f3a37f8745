// What the renderer can show: the six pictures of the paper (Gruzdev, Frolov, Ignatenko, figures a-f) and diagnostics.
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace farfield {

enum class View { result, direct, coarse, filtered, direct_filtered, occlusion, normals, depth, steps };

struct ViewInfo {
    View view;
    const char* key;    ///< on the command line and as layer name in EXR files
    const char* label;  ///< in the user interface
    const char* tip;
};

std::span<const ViewInfo> views();
std::optional<View> find_view(std::string_view key);

}  // namespace farfield
