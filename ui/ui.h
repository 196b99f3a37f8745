// What all panels share: looks, the report for tests, and the state of the user interface that is not part of the
// document. A panel takes a const scene and returns edits; someone else carries them out.
#pragma once

#include "renderer/views.h"
#include "sdf/code_trust.h"
#include "sdf/edit.h"
#include "ui/picture_tools.h"
#include "ui/report.h"
#include "ui/scene_audit.h"
#include "ui/selection.h"
#include "ui/theme.h"

#include <string>
#include <utility>
#include <vector>

namespace farfield {

/// What number fields remember between frames, for the one that has the mouse or the keyboard.
struct NumberEntry {
    unsigned typed = 0;      ///< ImGui's id of the field that is typed into
    char text[64] = "";      ///< what is typed so far
    std::string before;      ///< and what it began with
    double exact = 0.0;      ///< the dragged number before it is rounded
    float along = 0.0f;      ///< where the mouse is on a slider, 0 to 1
    unsigned clicked = 0;    ///< the slider that was clicked
    double click_due = 0.0;  ///< and when that counts
};

/// What the menu of kinds searches for while it is open.
struct KindSearch {
    std::string text;
    int marked = 0;  ///< which of those found Enter takes
};

/// What the tree is searched for; without words it shows everything.
struct TreeSearch {
    std::string text;
    bool focus = false;  ///< the tree puts the keyboard into the field, once
};

/// The bookmark whose row takes a new name.
struct BookmarkEntry {
    Id renamed = 0;
    bool focus = false;  ///< the row puts the keyboard into the field, once
    std::string text;
};

struct Ui {
    Ui(const Theme& look, Report to) : theme(look), report(std::move(to)) {}

    Selection selected() const { return {selection, further}; }
    void select(Selection all) {
        selection = all.primary;
        further = std::move(all.further);
    }

    Theme theme;
    Report report;
    ObjectRef selection;   ///< may name an object that is gone
    FurtherNodes further;  ///< selected beside it
    ObjectRef inspected;   ///< what the inspector shows: follows the selection a frame late, so that a field that loses
                           ///< the keyboard to a click elsewhere can still hand in what was typed
    View view = View::result;
    PictureTools tools;
    bool show_statistics = true;
    double frame_milliseconds = 0.0;  ///< that 95 % of the last frames of the user interface took at most
    bool show_shortcuts = false;
    bool show_code = false;
    bool show_measure = false;
    bool show_history = false;
    Id reveal = 0;  ///< node, material or light that its list scrolls to, once
    TreeSearch tree_search;
    BookmarkEntry bookmark_entry;
    bool open_add = false;    ///< the tree opens its list of kinds to add, once
    bool focus_name = false;  ///< the inspector puts the keyboard into the name field, once
    std::string name_text;    ///< what the name field holds while someone types
    NumberEntry number;
    const CodeTrust* trust = nullptr;       ///< which code may run; null: all
    std::shared_ptr<const CustomCode> run;  ///< code that the user accepts, for whoever draws the panels
    bool hand_in = false;                   ///< for a frame: what is being typed is about to be saved
    std::string problem;                    ///< what a panel could not do, likewise
    bool in_code = false;                   ///< the code has the keyboard: keys that select and cut text are for it
    bool edit_code = false;  ///< the code panel shows the custom code of the selected node, when there is
    KindSearch kind_search;
    SceneAudit audit;
};

/// Whether there is nothing to be seen of the node because its code comes from elsewhere.
bool is_stopped(const Ui& ui, const Node& node);

/// To be called at the start of each frame: a text field that is left forgets what Ctrl+Z would bring back there.
void forget_text_undo();

/// True while the selection names something that exists in the scene.
bool exists(const Scene& scene, ObjectRef object);

/// "Half size" for "half_size".
std::string label_of(std::string_view key);

/// The title strip of a panel, as wide as that.
void panel_title(const Ui& ui, const char* title);
/// The part of a panel that scrolls, down to its end; ImGui::EndChild() ends it.
void begin_rows();

/// Small heading between groups of rows.
void section(const Ui& ui, const char* title);

/// The same with a "+" at its right end, known to the report as `name` of `panel`; true when that was pressed.
bool heading(Ui& ui, const char* title, const char* panel, const char* name, std::string_view tip,
             std::string_view hint = {});

/// Tooltip of the last item after a short rest of the mouse; the second text is dimmed.
void tooltip(const Ui& ui, std::string_view text, std::string_view hint = {});

/// A menu that ImGui::OpenPopup has opened, with the spacing of menus whatever the rows around it have. Draws its
/// entries and is left at the end of its life.
class PopupMenu {
public:
    PopupMenu(const Ui& ui, const char* id);
    ~PopupMenu();
    PopupMenu(const PopupMenu&) = delete;
    PopupMenu& operator=(const PopupMenu&) = delete;
    bool is_open() const { return open_; }

private:
    bool open_;
};

/// The sign of a node's role: disc, two discs, four dots or a ring.
void draw_icon(const Ui& ui, Role role, ImVec2 centre);

/// An open eye, or a crossed one; an open or closed padlock.
void draw_eye(const Ui& ui, bool open, ImVec2 centre, ImU32 color);
void draw_lock(const Ui& ui, bool closed, ImVec2 centre, ImU32 color);

/// The sign that something is likely to be wrong.
void draw_warning(const Ui& ui, ImVec2 centre);

/// A bar to drag between panels, at `low` and of `extent`; upright when taller than wide. Returns how far it was moved.
float splitter(Ui& ui, const char* id, ImVec2 low, ImVec2 extent);

}  // namespace farfield
