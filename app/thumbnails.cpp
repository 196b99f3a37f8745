#include "app/thumbnails.h"

#include "renderer/image.h"
#include "sdf/user_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace farfield {
namespace {

namespace fs = std::filesystem;

/// FNV-1a (Fowler, Noll, Vo): names of files need no more.
std::uint64_t hash(const std::string& text) {
    std::uint64_t value = 0xcbf29ce484222325u;
    for (const char c : text) value = (value ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    return value;
}

gl::Texture load(const fs::path& file) {
    const Image image = read_image(file);
    if (image.size.x > Thumbnails::largest.x || image.size.y > Thumbnails::largest.y) throw ImageError("no thumbnail");
    std::vector<unsigned char> pixels;
    pixels.reserve(image.pixels.size() / 3 * 4);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        pixels.push_back(static_cast<unsigned char>(std::clamp(image.pixels[i], 0.0f, 1.0f) * 255.0f + 0.5f));
        if (i % 3 == 2) pixels.push_back(255);
    }
    gl::Texture texture("thumbnail", GL_RGBA8, image.size);
    glBindTexture(GL_TEXTURE_2D, texture.name());
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, image.size.x, image.size.y, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    return texture;
}

}  // namespace

fs::path Thumbnails::file_of(const fs::path& scene) {
    static const fs::path cache = user_folder("XDG_CACHE_HOME", ".cache");
    if (cache.empty()) return {};
    std::error_code failed;
    const fs::path folder = cache / "thumbnails";
    fs::create_directories(folder, failed);
    fs::path whole = fs::weakly_canonical(scene, failed);
    if (failed) whole = scene;
    return folder / fmt::format("{:016x}.png", hash(whole.string()));
}

const gl::Texture* Thumbnails::find(const fs::path& scene) {
    auto found = textures_.find(scene);
    if (found == textures_.end()) {
        if (reads_left_ <= 0) return nullptr;
        --reads_left_;
        gl::Texture texture;
        std::error_code failed;
        if (const fs::path file = file_of(scene); fs::is_regular_file(file, failed)) {
            try {
                texture = load(file);
            } catch (const std::exception&) {  // none, then
            }
        }
        found = textures_.emplace(scene, std::move(texture)).first;
    }
    return found->second ? &found->second : nullptr;
}

}  // namespace farfield
