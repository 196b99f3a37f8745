// Scene files: JSON, versioned, defaults omitted, in a stable order with one value to a line, so that an edit of one
// number is a difference of one line. The format is documented in scenes/README.md.
#pragma once

#include "sdf/scene.h"

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace farfield {

/// A file that could not be read or does not describe a scene. what() is one line:
/// "FILE:LINE: PATH: what was wrong, expected ..." where PATH is like root/children[2] "ring"/radius.
struct SceneFileError : std::runtime_error {
    SceneFileError(std::string in_file, int at_line, std::string at_path, std::string what_is_wrong);
    std::string file;
    int line;  ///< from 1; 0 when the file as a whole is meant
    std::string path;
    std::string problem;
};

/// Reads a scene from text; `file` is used in messages only. Nothing is half loaded: a scene or an error.
Scene parse_scene(std::string_view text, const std::string& file);
Scene load_scene(const std::filesystem::path& file);
/// The file as it is; refuses what is too large for a scene, unread.
std::string read_scene_text(const std::filesystem::path& file);

/// The text of a scene file. parse_scene(to_text(s)) describes s, and writing that again gives the same bytes.
std::string to_text(const Scene& scene);
/// Atomic: writes a new file beside it, syncs, renames. Throws SceneFileError; the old file survives any failure.
void save_scene(const Scene& scene, const std::filesystem::path& file);

}  // namespace farfield
