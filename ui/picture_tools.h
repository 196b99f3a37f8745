// What the toolbar over the picture chooses; no part of the document.
#pragma once

namespace farfield {

enum class Tool { none, move, rotate, scale };
enum class Axes { local, world };

struct PictureTools {
    Tool tool = Tool::move;
    Axes axes = Axes::world;
    bool lights = true;  ///< signs of the lights
    bool grid = false;   ///< on the ground
    int divisor = 1;     ///< of the picture's width and height
};

}  // namespace farfield
