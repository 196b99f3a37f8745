// The text of a custom node, to be written: coloured, with line numbers, checked with every key, and handed in as an
// edit by Ctrl+Enter or a button. What was typed and not handed in stays, for each node, until another document is
// shown.
#pragma once

#include "sdf/code_drafts.h"
#include "sdf/custom_code.h"
#include "ui/ui.h"

#include <map>
#include <string>
#include <vector>

namespace farfield {

class CodeEditor {
public:
    /// Fills what is left of the current ImGui window; the current font is the code's. `compile` and `revert`: asked
    /// for by buttons elsewhere.
    Edits draw(Ui& ui, const Node& node, bool compile, bool revert);
    /// Whether something was typed that is not handed in, and whether it could be.
    bool is_changed(const Node& node) const;
    bool has_errors(const Node& node) const;
    /// Of the nodes of `scene`, what was typed and not handed in.
    CodeDrafts drafts(const Scene& scene) const;
    /// Another document is shown, of which there are these.
    void begin(const CodeDrafts& drafts);

private:
    struct Draft {
        std::string text;
        std::string base;     ///< the node's code that it began as
        std::string checked;  ///< the text that the errors are of
        std::vector<CodeError> errors;
    };
    Draft& draft_of(const Node& node);
    void text(Ui& ui, Draft& draft, ImVec2 size);
    void paint(const Ui& ui, const Draft& draft, const char* label, ImVec2 low, float gutter) const;
    void below(Ui& ui, const Node& node, const Draft& draft) const;
    static int callback(ImGuiInputTextCallbackData* data);

    std::map<Id, Draft> drafts_;
    bool tab_ = false, line_ = false, brace_ = false;  ///< was typed, and what follows from it is still to be inserted
};

}  // namespace farfield
