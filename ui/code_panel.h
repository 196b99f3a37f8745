// The GLSL that the scene comes to, with the lines of the selected node marked: what is selected in the tree is shown
// here, and a click on a line selects the node that it belongs to.
#pragma once

#include "sdf/codegen.h"
#include "ui/code_editor.h"
#include "ui/ui.h"

#include <cstdint>

namespace farfield {

class CodePanel {
public:
    /// Fills the current ImGui window. The code is written anew only for another `revision` of the scene. Of a custom
    /// node its own code can be shown instead, to be written.
    Edits draw(Ui& ui, const Scene& scene, std::uint64_t revision);

    /// Lines, from 1: all of them, those of the selected node, and those of what is in it.
    struct Lines {
        std::size_t count = 0;
        std::vector<std::size_t> selected, inside;
    };
    Lines lines() const;
    Tier tier() const { return tier_; }
    /// Another document: what was typed for the old one is gone, but of this one there are `drafts`.
    void begin(const CodeDrafts& drafts) { editor_.begin(drafts); }
    /// What was typed and not handed in.
    CodeDrafts drafts(const Scene& scene) const { return editor_.drafts(scene); }

private:
    enum class Mark : unsigned char { none, inside, selected };
    struct Place {
        std::size_t line = 0, byte = 0;
        auto operator<=>(const Place&) const = default;
    };

    /// `custom`: the selected node where it has code; `editing`: whether that is shown.
    void title(Ui& ui, const Node* custom, bool editing, bool& compile, bool& revert);
    void refresh(const Scene& scene, std::uint64_t revision);
    void mark(const Ui& ui, const Scene& scene);
    void text(Ui& ui, const Scene& scene);
    void draw_line(const Ui& ui, std::size_t line, ImVec2 at, float cell) const;
    void select_text(Ui& ui, Place at);
    void context_menu(const Ui& ui, const Scene& scene);
    void copy(std::string text);

    std::string_view line_text(std::size_t line) const;
    Place place_at(ImVec2 offset, float cell, float height) const;
    std::string chosen_text() const;  ///< what is selected as text
    std::string node_text(Id node) const;

    CodeEditor editor_;
    Tier tier_ = Tier::specialised, generated_tier_ = Tier::specialised;
    GeneratedScene code_;
    std::uint64_t revision_ = 0;  ///< of the scene that code_ is of
    double next_refresh_ = 0.0;
    std::vector<std::size_t> starts_;  ///< of the lines in the text, and its end
    std::size_t longest_ = 0;          ///< characters of the longest line

    std::vector<Mark> marks_;  ///< one for each line
    bool marks_are_old_ = true;
    ObjectRef marked_;        ///< whose lines are marked
    bool scroll_to_ = false;  ///< the marked lines
    Id pointed_ = 0;          ///< node of the line under the mouse
    Place anchor_, head_;     ///< text selection, from where the mouse went down
    double copied_ = -1e9;    ///< when something was copied
};

}  // namespace farfield
