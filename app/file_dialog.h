// A small file dialog: folders and scene files of one folder, and a field for the path.
#pragma once

#include "ui/ui.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace farfield {

class FileDialog {
public:
    enum class Mode { open, save };

    /// Shows the dialog from the next frame on. `start`: a file or folder to begin with.
    void show(Mode mode, const std::filesystem::path& start);
    /// Draws the dialog while it is shown. The path, once the user has settled on one.
    std::optional<std::filesystem::path> draw(Ui& ui);
    /// The field for the path is about to get the keyboard.
    bool wants_keyboard() const { return request_ || focus_; }

private:
    struct Entry {
        std::string name;
        bool folder;
    };

    void enter(const std::filesystem::path& folder);
    void draw_path_bar(Ui& ui);
    void draw_entries(Ui& ui);
    std::optional<std::filesystem::path> accept();
    std::filesystem::path typed() const;

    Mode mode_ = Mode::open;
    bool request_ = false, focus_ = false, accepted_ = false, confirm_ = false;
    bool picked_ = false;  ///< the text comes from the list, not from the keyboard
    std::filesystem::path folder_;
    std::string text_;
    std::string problem_;
    std::vector<Entry> entries_;
};

}  // namespace farfield
