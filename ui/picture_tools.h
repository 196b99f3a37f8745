// What the toolbar over the picture chooses; no part of the document.
#pragma once

#include "renderer/views.h"

namespace farfield {

enum class Tool { none, move, rotate, scale };
enum class Axes { local, world };

/// A divider in the picture: left of it (A) is what view and settings say, right of it (B) another look at the same
/// samples. What B does not choose is as A has it.
struct SplitView {
    static constexpr float least_part = 0.04f;  ///< of the picture's width on either side
    bool on = false;
    float divider = 0.5f;  ///< of the picture's width
    std::optional<Method> method = Method::reference;
    std::optional<View> view;
    std::optional<int> blur_levels;

    friend bool operator==(const SplitView&, const SplitView&) = default;

    Look other(const Look& own) const {
        return {view.value_or(own.view), method.value_or(own.method), blur_levels.value_or(own.blur_levels)};
    }
};

struct PictureTools {
    Tool tool = Tool::move;
    Axes axes = Axes::world;
    bool lights = true;  ///< signs of the lights
    bool grid = false;   ///< on the ground
    int divisor = 1;     ///< of the picture's width and height
    SplitView split;
};

}  // namespace farfield
