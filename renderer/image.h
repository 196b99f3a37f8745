// Images on the CPU, and files through OpenImageIO.
#pragma once

#include <glm/vec2.hpp>

#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
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

using Attributes = std::map<std::string, std::string>;  ///< what a file's header says beside the usual

/// Float EXR with a group of channels NAME.R, NAME.G, NAME.B for each layer, all of one size. Written beside the target
/// and renamed, so that an interrupted write leaves no broken file. Throws ImageError.
void write_exr(const std::filesystem::path& file, const std::vector<Layer>& layers, const Attributes& attributes = {});

/// Eight bits for each of three channels, display-ready, row 0 at the top. PNG, or whatever the extension says that
/// OpenImageIO writes with eight bits. Atomic like write_exr; throws ImageError.
void write_display(const std::filesystem::path& file, glm::ivec2 size, const std::vector<unsigned char>& rgb);

/// Reads the first three channels as floats. Throws ImageError.
Image read_image(const std::filesystem::path& file);

/// Reads channels R, G, B of a layer, of the file itself where that is empty, as linear values: what is stored as whole
/// numbers (PNG, JPEG) is taken for sRGB (IEC 61966-2-1). Throws ImageError, which tells the layers there are.
Image read_linear(const std::filesystem::path& file, std::string_view layer = {});

/// The header's attribute, empty where there is none. Throws ImageError when the file cannot be opened.
std::string read_attribute(const std::filesystem::path& file, const std::string& name);

/// What a screen shows of a linear image before its transfer function: times 2^exposure (stops), clamped to 0..1.
Image exposed(Image image, float exposure);

/// a - b, of the same size.
Image difference(const Image& a, const Image& b);

/// Resampled bilinearly; the same image for the same size.
Image resized(const Image& image, glm::ivec2 size);

struct Difference {
    double rmse = 0.0;
    double largest = 0.0;
};
/// Throws ImageError when the sizes differ.
Difference compare(const Image& a, const Image& b);

/// Number of values that are NaN or infinite.
std::size_t count_invalid(const Image& image);

}  // namespace farfield
