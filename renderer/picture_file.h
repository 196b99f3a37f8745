// What the renderer has accumulated, as an image file: the command line's and the editor's export alike.
#pragma once

#include "renderer/renderer.h"

#include <filesystem>

namespace farfield {

/// EXR: linear, every view a layer and `view` the file's own; otherwise `view` as it is displayed, in 8 bits. Atomic;
/// throws ImageError.
void write_picture(Renderer& renderer, View view, const std::filesystem::path& file);

/// The displayed picture in 8 bits, made smaller until it lies within `room` pixels. Atomic; throws ImageError.
void write_small_picture(Renderer& renderer, glm::ivec2 room, const std::filesystem::path& file);

/// The extension in small letters, with its dot.
std::string extension_of(const std::filesystem::path& file);

}  // namespace farfield
