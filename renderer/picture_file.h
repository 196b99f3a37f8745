// What the renderer has accumulated, as an image file: the command line's and the editor's export alike. Reading needs
// the context; writing, which takes longer, needs nothing and may be done on another thread.
#pragma once

#include "renderer/renderer.h"

#include <filesystem>

namespace farfield {

struct Picture {
    glm::ivec2 size{0};
    std::vector<unsigned char> pixels;  ///< as displayed, RGB, row 0 at the top; or
    std::vector<Layer> layers;          ///< linear: the view, and then every view by its key
};

/// The view as it is displayed, or linear with all the others.
Picture read_picture(Renderer& renderer, View view, bool linear);

/// What is displayed, made smaller until it lies within `room` pixels.
Picture read_small_picture(Renderer& renderer, glm::ivec2 room);

/// Layers as EXR, pixels as PNG or what else the extension says. Atomic; throws ImageError.
void write_picture(const Picture& picture, const std::filesystem::path& file);

/// Whether the file's extension asks for linear values.
bool is_linear(const std::filesystem::path& file);

/// The extension in small letters, with its dot.
std::string extension_of(const std::filesystem::path& file);

}  // namespace farfield
