#include "renderer/picture_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace farfield {

std::string extension_of(const std::filesystem::path& file) {
    std::string text = file.extension().string();
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

bool is_linear(const std::filesystem::path& file) { return extension_of(file) == ".exr"; }

Picture read_picture(Renderer& renderer, View view, bool linear) {
    if (!linear) return {renderer.size(), renderer.display_pixels(), {}};
    Picture picture{renderer.size(), {}, {{"", renderer.read(view)}}};
    for (const ViewInfo& info : views()) picture.layers.push_back({info.key, renderer.read(info.view)});
    return picture;
}

void write_picture(const Picture& picture, const std::filesystem::path& file) {
    if (picture.layers.empty())
        write_display(file, picture.size, picture.pixels);
    else
        write_exr(file, picture.layers);
}

Picture read_small_picture(Renderer& renderer, glm::ivec2 room) {
    const glm::ivec2 size = renderer.size();
    const std::vector<unsigned char> pixels = renderer.display_pixels();
    const glm::vec2 fit = glm::vec2(room) / glm::vec2(size);
    const glm::ivec2 small =
        glm::clamp(glm::ivec2(glm::round(glm::vec2(size) * std::min(fit.x, fit.y))), glm::ivec2(1), size);
    // The mean of the pixels that fall into each: interpolation alone would leave out most of them.
    std::vector<unsigned char> shrunk;
    shrunk.reserve(static_cast<std::size_t>(small.x) * small.y * 3);
    for (int y = 0; y < small.y; ++y)
        for (int x = 0; x < small.x; ++x) {
            const glm::ivec2 low = glm::ivec2(x, y) * size / small, high = (glm::ivec2(x, y) + 1) * size / small;
            for (int channel = 0; channel < 3; ++channel) {
                int sum = 0;
                for (int v = low.y; v < high.y; ++v)
                    for (int u = low.x; u < high.x; ++u)
                        sum += pixels[(static_cast<std::size_t>(v) * size.x + u) * 3 + channel];
                const glm::ivec2 extent = high - low;
                shrunk.push_back(static_cast<unsigned char>(sum / (extent.x * extent.y)));
            }
        }
    return {small, std::move(shrunk), {}};
}

}  // namespace farfield
