// What the renderer can show: the six pictures of the paper (Gruzdev, Frolov, Ignatenko, figures a-f) and diagnostics.
#pragma once

#include "sdf/scene.h"

#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string_view>

namespace farfield {

/// The values are shared with shaders/synthesis.glsl.
enum class View { result, direct, coarse, filtered, direct_filtered, occlusion, normals, depth, steps };

struct ViewInfo {
    View view;
    const char* key;    ///< on the command line and as layer name in EXR files
    const char* label;  ///< in the user interface
    const char* tip;
};

inline constexpr ViewInfo view_table[] = {
    {View::result, "result", "Result", "Direct light plus indirect light as the method makes it"},
    {View::direct, "direct", "Direct light", "Emission, Lambert and Phong reflection of the lights, with hard shadows"},
    {View::coarse, "coarse", "Coarse far light", "Monte-Carlo far light as accumulated, on a white surface"},
    {View::filtered, "filtered", "Filtered far light",
     "Far light as the method averages it, on a white surface that nothing near occludes"},
    {View::direct_filtered, "direct+filtered", "Direct + filtered",
     "Direct light plus albedo x filtered far light, without ambient occlusion"},
    {View::occlusion, "occlusion", "Ambient occlusion",
     "The fraction of hemisphere rays that leave the AO radius; in farfield what is met counts less the farther it is"},
    {View::normals, "normals", "Normals", "World-space normals, each component from -1..1 to 0..1"},
    {View::depth, "depth", "Depth", "Distance from the camera in metres; the display maps it to near white, far black"},
    {View::steps, "steps", "Step count",
     "Distance evaluations of the camera ray; the display maps 0 to black and 128 to white"},
};

/// What is made of the accumulated samples: every look is made of the same ones.
struct Look {
    View view = View::result;
    Method method = Method::farfield;
    int blur_levels = 3;
    friend bool operator==(const Look&, const Look&) = default;
};

/// As set, or for -1 such that 2^levels pixels are about 1/32 of the picture's shorter side; see METHOD.md.
inline int blur_levels(int set, glm::ivec2 size) {
    const int side = std::min(size.x, size.y);
    return set >= 0 ? set : std::max(static_cast<int>(std::lround(std::log2(std::max(side, 1) / 32.0))), 1);
}

inline std::span<const ViewInfo> views() { return view_table; }

inline std::optional<View> find_view(std::string_view key) {
    for (const ViewInfo& v : view_table)
        if (key == v.key) return v.view;
    return std::nullopt;
}

}  // namespace farfield
