// Small pictures of scene files, as the editor has shown them last, in the user's cache.
#pragma once

#include "renderer/gl.h"

#include <glm/vec2.hpp>

#include <filesystem>
#include <map>

namespace farfield {

class Thumbnails {
public:
    static constexpr glm::ivec2 largest{192, 128};

    /// Where the picture of a scene file is; empty where there is no cache. Makes its folder.
    static std::filesystem::path file_of(const std::filesystem::path& scene);

    /// A few pictures are read in each frame, so that a folder of thousands scrolls like others.
    void begin_frame() { reads_left_ = 4; }
    /// Null where there is none, or none yet.
    const gl::Texture* find(const std::filesystem::path& scene);
    /// They are read again when they are asked for.
    void forget() { textures_.clear(); }

private:
    std::map<std::filesystem::path, gl::Texture> textures_;
    int reads_left_ = 0;
};

}  // namespace farfield
