// Images on the CPU, and files through OpenImageIO.
#pragma once

#include <glm/vec2.hpp>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace farfield {

struct ImageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Three floats per pixel, linear Rec. 709, row 0 at the top.
struct Image {
    glm::ivec2 size{0};
    std::vector<float> pixels;
};

struct Layer {
    std::string name;  ///< empty: the file's own R, G, B
    Image image;
};

/// Float EXR with a group of channels NAME.R, NAME.G, NAME.B for each layer. Written beside the target and renamed, so
/// that an interrupted write leaves no broken file. Throws ImageError.
void write_exr(const std::filesystem::path& file, const std::vector<Layer>& layers);

/// Eight bits for each of three channels, display-ready, row 0 at the top. PNG, or whatever the extension says that
/// OpenImageIO writes with eight bits. Atomic like write_exr; throws ImageError.
void write_display(const std::filesystem::path& file, glm::ivec2 size, const std::vector<unsigned char>& rgb);

/// Reads the first three channels as floats. Throws ImageError.
Image read_image(const std::filesystem::path& file);

struct Difference {
    double rmse = 0.0;
    double largest = 0.0;
};
/// Throws ImageError when the sizes differ.
Difference compare(const Image& a, const Image& b);

/// Number of values that are NaN or infinite.
std::size_t count_invalid(const Image& image);

}  // namespace farfield
