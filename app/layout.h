// Where everything is in the window: menu, panels around the picture, message bar, status line.
#pragma once

#include "app/editor_commands.h"
#include "app/document.h"
#include "app/file_actions.h"
#include "app/viewport.h"
#include "ui/code_panel.h"
#include "ui/measure_panel.h"

#include <optional>
#include <string>

namespace farfield {

struct LayoutResult {
    std::vector<Edits> edits;  ///< of each panel; its edits are carried out together or not at all
    ViewportResult viewport;
    std::optional<CommandId> command;
    bool dismissed = false;  ///< the message
    MeasureWish measure = MeasureWish::none;
    std::optional<std::size_t> step;  ///< of the history, to go to
};

class Layout {
public:
    explicit Layout(const PanelSizes& sizes) : sizes_(sizes) {}

    /// Draws the whole window of `size`; `files` draws its part of the menu and tells what went wrong.
    LayoutResult draw(Ui& ui, ImVec2 size, const Document& document, const ViewportInput& input,
                      const RenderedPicture& picture, FileActions& files, const MeasureResults& measured,
                      const std::function<bool(CommandId)>& enabled);

    const CodePanel& code() const { return code_; }
    const PanelSizes& sizes() const { return sizes_; }
    /// Whether there is something new to draw that no input asked for.
    bool news() const { return viewport_.news(); }
    /// Another document is shown: what was typed and not handed in belongs to the old one. `drafts` belong to this one.
    void show_new_document(const CodeDrafts& drafts) { code_.begin(drafts); }

private:
    void draw_panels(Ui& ui, ImVec2 low, ImVec2 size, const Document& document, const ViewportInput& input,
                     const RenderedPicture& picture, const std::string& message, LayoutResult& result);
    /// The picture, and the code where it is shown.
    void draw_middle(Ui& ui, ImVec2 low, ImVec2 size, const Document& document, const ViewportInput& input,
                     const RenderedPicture& picture, const std::string& message, LayoutResult& result);

    CodePanel code_;
    Viewport viewport_;
    PanelSizes sizes_;
};

}  // namespace farfield
