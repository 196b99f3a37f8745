// Where everything is in the window: menu, panels around the picture, message bar, status line.
#pragma once

#include "app/editor_commands.h"
#include "app/document.h"
#include "app/viewport.h"

#include <optional>
#include <string>

namespace farfield {

struct LayoutResult {
    Edits edits;
    ViewportResult viewport;
    std::optional<CommandId> command;
    bool dismissed = false;  ///< the message
};

class Layout {
public:
    explicit Layout(const Theme& theme);

    /// Draws the whole window of `size`. `message`: something that went wrong, empty for nothing.
    LayoutResult draw(Ui& ui, ImVec2 size, const Document& document, const RenderedPicture& picture,
                      const std::string& message, const std::function<bool(CommandId)>& enabled);

private:
    void draw_panels(Ui& ui, ImVec2 low, ImVec2 size, const Scene& scene, const RenderedPicture& picture,
                     const std::string& message, LayoutResult& result);

    float left_, right_;        ///< widths of the columns
    float objects_, settings_;  ///< heights of their lower panels
};

}  // namespace farfield
