// References on disk, one EXR file for each, found by what they depend on. A cache: it may be deleted at any time.
#pragma once

#include "renderer/reference.h"

#include <filesystem>
#include <string>

namespace farfield {

class ReferenceStore {
public:
    explicit ReferenceStore(std::filesystem::path folder) : folder_(std::move(folder)) {}
    /// farfield/references in the user's folder of caches ($XDG_CACHE_HOME or ~/.cache); empty where there is none.
    static std::filesystem::path user_folder();

    std::filesystem::path file(const std::string& key) const { return folder_ / (key + ".exr"); }

    /// An empty reference where there is none or the file is of no use; `problem` says so then, in one line.
    Reference load(const std::string& key, glm::ivec2 size, std::string& problem) const;
    /// Atomic; makes the folder. Nothing is saved before both halves have samples. Throws ImageError.
    void save(const std::string& key, const Reference& reference) const;

private:
    std::filesystem::path folder_;
};

}  // namespace farfield
