// A small file dialog: recent files, the folders and files of one folder with their pictures, and a field for the path,
// which also searches. Everything can be done by keyboard.
#pragma once

#include "app/editor_state.h"
#include "app/folder_list.h"
#include "app/thumbnails.h"
#include "ui/ui.h"

#include <optional>
#include <string>

namespace farfield {

/// Not while a node is dragged: what Dear ImGui shows beside the mouse then may not appear above a new dialog, which
/// would end the program.
inline bool may_open_dialog() { return !ImGui::GetDragDropPayload(); }

class FileDialog {
public:
    enum class Mode { open, save, picture };

    /// Shows the dialog from the next frame on. `start`: a file or folder to begin with.
    void show(Mode mode, const std::filesystem::path& start);
    /// Draws the dialog while it is shown. The path, once the user has settled on one. `state` has the recent files and
    /// the order of others.
    std::optional<std::filesystem::path> draw(Ui& ui, EditorState& state);
    /// The field for the path is about to get the keyboard.
    bool wants_keyboard() const { return request_ || focus_; }

private:
    void enter(const std::filesystem::path& folder);
    void draw_path_bar(Ui& ui, EditorState& state);
    void draw_recent(Ui& ui, const EditorState& state);
    void draw_entries(Ui& ui);
    void draw_row(const Ui& ui, const FolderEntry& entry, ImVec2 low, float height);
    bool draw_path(Ui& ui);
    void keyboard();
    void mark(std::size_t row);
    std::optional<std::filesystem::path> accept();
    std::filesystem::path typed() const;
    bool searches() const;  ///< the text is no path but a part of a name
    std::span<const char* const> extensions() const;

    Mode mode_ = Mode::open;
    bool request_ = false, focus_ = false, accepted_ = false, confirm_ = false;
    bool picked_ = false;  ///< the text comes from the list, not from the keyboard
    bool reveal_ = false;  ///< the marked row scrolls into sight
    std::filesystem::path folder_, chosen_recent_;
    std::string text_;
    std::string search_;  ///< what was typed of a name: the list has those alone
    std::string problem_;
    FolderList list_;
    std::optional<std::size_t> marked_;  ///< row
    Thumbnails thumbnails_;
};

}  // namespace farfield
