// What the editor remembers from one run to the next, in one small file in the user's folder of state: the window, the
// panels and the files that were open. What is not in the file, or makes no sense, is as at the first run.
#pragma once

#include "app/panel_sizes.h"
#include "ui/picture_tools.h"

#include <glm/vec2.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace farfield {

struct EditorState {
    std::optional<glm::ivec2> size;   ///< of the window when it is not maximised, screen coordinates
    std::optional<glm::ivec2> place;  ///< of its upper left corner
    bool maximised = false;
    PanelSizes panels;
    bool statistics = true, code = false, measure = false;  ///< are shown
    SplitView split;
    bool newest_first = false;                  ///< the order of files in the dialog
    std::vector<std::filesystem::path> recent;  ///< files, the last one first
};

/// Where it is remembered; empty where there is no such folder.
std::filesystem::path editor_state_file();

EditorState parse_editor_state(std::string_view text);
std::string to_text(const EditorState& state);

/// Files that are gone are left out.
EditorState load_editor_state(const std::filesystem::path& file);
/// A state that cannot be written is no reason to stop anybody.
void save_editor_state(const EditorState& state, const std::filesystem::path& file);

/// Puts a file first, in `state` and, with those that other editors have opened meanwhile, on disk.
void remember_file(EditorState& state, const std::filesystem::path& opened, const std::filesystem::path& file);

}  // namespace farfield
