// The editor without its window: what mouse, keys, menus and panels do to the document, and what is to be rendered.
// Dear ImGui brings mouse and text; what else a frame depends on is handed in, and what it asks of the world outside is
// handed out. So it runs without a display too.
#pragma once

#include "app/document.h"
#include "app/editor_commands.h"
#include "app/file_actions.h"
#include "app/layout.h"
#include "app/selection_history.h"

#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace farfield {

struct EditorInput {
    double now = 0.0;                            ///< seconds, from anywhere
    glm::vec2 size{0.0f};                        ///< of the window, in ImGui units
    glm::vec2 pixels_per_unit{1.0f};             ///< of the picture
    std::vector<KeyPress> keys;                  ///< that went down before this frame
    glm::vec3 fly{0.0f};                         ///< as ViewportInput has it
    std::vector<std::filesystem::path> dropped;  ///< files, on the window
    bool close = false;                          ///< the window was asked to close
    double frame_milliseconds = 0.0;             ///< that 95 % of the last frames took at most
};

struct EditorOutput {
    std::string title;
    std::optional<RenderRequest> request;  ///< where it is another one than before
    std::vector<PictureWish> pictures;
    MeasureWish measure = MeasureWish::none;
};

class Editor {
public:
    /// Begins with a new scene. `state` is what was remembered, and lives longer.
    Editor(EditorState& state, const Theme& theme, Report report);

    void open(const std::filesystem::path& file, bool trust_code) { files_.open(file, trust_code); }
    /// The newest picture there is; true when it shows something new.
    bool show(RenderedPicture picture);
    void exported(const WrittenPicture& picture) { files_.exported(picture); }
    /// What happens to files and on threads, to be called often; true when a frame would show something new.
    bool refresh(double now);
    /// Between ImGui's NewFrame and Render.
    EditorOutput frame(const EditorInput& input, const MeasureResults& measured);
    void write_report(double now);
    /// After the last frame: what the panels are like goes into the state, and no unsaved work is left.
    void end();

    const Document& document() const { return document_; }
    /// What is rendered, and in how many pixels.
    std::shared_ptr<const Scene> shown() { return document_.snapshot(); }
    glm::ivec2 picture_size() const { return size_; }
    /// What the bar over the picture says; empty when nothing is wrong.
    const std::string& error() const { return files_.error().empty() ? picture_.error : files_.error(); }
    const RenderedPicture& picture() const { return picture_; }
    const Ui& ui() const { return ui_; }
    bool interacting() const { return interacting_; }  ///< a hand moves something
    bool quits() const { return files_.quits(); }
    /// A field that was given the keyboard has it in the frame after the next: keys have to wait.
    bool keyboard_changes_hands() const;

private:
    void begin_gesture();
    void carry_out(const LayoutResult& result);
    void carry_out(const Edits& edits, unsigned gesture);
    void carry_out_camera(const ViewportResult& viewport);
    void go_to_step(std::size_t step);
    void cancel_gesture();
    void show_new_document();
    std::optional<RenderRequest> request(const EditorInput& input, glm::vec2 picture_size, bool measuring);

    // Commands and keys: editor_actions.cpp.
    void keyboard(const std::vector<KeyPress>& keys);
    bool enabled(CommandId id) const;
    void perform(CommandId id);
    void copy() const;
    void paste();
    Box selection_box() const;
    void frame_box(const Box& box);
    void go_to_bookmark(std::size_t index);

    EditorState& state_;
    CodeTrust trust_{CodeTrust::user_file()};
    Document document_{trust_};
    FileActions files_{document_, state_};
    Ui ui_;
    Layout layout_;
    SelectionHistory selections_;
    RenderedPicture picture_;
    std::uint64_t pictures_ = 0;

    double now_ = 0.0;
    unsigned last_gesture_ = 0, gesture_ = 0, wheel_gesture_ = 0;
    double wheel_until_ = 0.0;
    bool held_ = false;            ///< some control has the mouse or the keyboard
    ImGuiID holder_ = 0;           ///< which
    bool save_ = false;            ///< once the panels have handed in what was being typed
    bool gesture_edited_ = false;  ///< and has changed the document
    bool gesture_moves_ = false;   ///< and more of it than settings
    bool interacting_ = false;
    glm::ivec2 size_{0};
    std::tuple<std::uint64_t, std::size_t, int, int, View, std::optional<Look>, Id, bool, int> requested_{};
    std::uint64_t shown_document_ = 0;  ///< its generation
};

}  // namespace farfield
