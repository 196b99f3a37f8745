#include "app/editor.h"

#include "app/editor_commands.h"
#include "app/camera_control.h"
#include "app/document.h"
#include "app/file_actions.h"
#include "app/layout.h"
#include "app/measuring.h"
#include "app/selection_commands.h"
#include "app/selection_history.h"
#include "app/window.h"
#include "sdf/scene_file.h"
#include "ui/tree_edits.h"

#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <tuple>
#include <utility>

namespace farfield {
namespace {

// The picture gets no better by eye long before this many frames; then the machine may rest.
constexpr int frames_until_rest = 4096;
constexpr double slow_tick = 0.1;          // seconds between looks at the renderer while nothing happens
constexpr double quick_tick = 1.0 / 60.0;  // and while a hand moves something or pictures come fast
constexpr double wheel_rest = 0.4;         // turns of the wheel closer than this are one gesture
constexpr double attention = 1.0;          // after input: tooltips wait for the mouse to rest
constexpr int settling_frames = 3;         // ImGui needs a frame or two to lay out what has just appeared

double seconds() {
    using namespace std::chrono;
    return duration<double>(steady_clock::now().time_since_epoch()).count();
}

Theme theme_for(const Window& window) {
    const Theme theme = make_theme(window.density());
    ImGui::GetIO().FontGlobalScale = 1.0f / window.pixels_per_unit().x;
    return theme;
}

/// Looking around is no work on the scene, though undo covers it.
bool moves_camera(const Edit& edit) {
    const auto* set = std::get_if<SetValue>(&edit);
    return set && set->object.type == ObjectType::camera;
}

class Editor {
public:
    explicit Editor(const EditorOptions& options)
        : window_({state_.size, state_.place, state_.maximised}, "Farfield"),
          render_(window_.make_shared_context()),
          ui_(theme_for(window_), Report(options.report)),
          layout_(state_.panels) {
        ui_.show_statistics = state_.statistics;
        ui_.show_code = state_.code;
        ui_.show_measure = state_.measure;
        if (!options.scene.empty()) files_.open(options.scene, options.trust_code);
        show_new_document();
    }

    void run() {
        int redraws = settling_frames;
        double last_input = seconds();
        while (!files_.quits()) {
            const bool lively = redraws > 0 || interacting_ || picture_.statistics.frames_per_second > 10.0;
            if (window_.wait(lively ? quick_tick : slow_tick)) redraws = settling_frames, last_input = seconds();
            const bool attentive = seconds() - last_input < attention || interacting_ || ImGui::GetIO().WantTextInput;
            const bool first = picture_.texture == 0;
            const bool news = look_for_picture();
            if (first && picture_.texture != 0) redraws = settling_frames;
            const bool measured = measuring_.refresh(document_.scene(), document_.revision());
            const bool of_files = files_.refresh(layout_.code().drafts(document_.scene()), seconds());
            while (const auto written = render_.written()) files_.exported(*written);
            if (news || measured || of_files || ui_.audit.finished() || layout_.news() || redraws > 0 || attentive)
                frame();
            if (redraws > 0) --redraws;
            write_report();
        }
        files_.end();
        remember_state();
    }

private:
    /// True when there is something new to show.
    bool look_for_picture() {
        RenderedPicture picture = render_.acquire();
        const auto seen = [](const RenderedPicture& p) {
            const Statistics& s = p.statistics;
            return std::tuple(p.serial, p.error, s.structural_compiles, s.specialisations, s.frames);
        };
        const bool news = seen(picture) != seen(picture_);
        if (picture.serial != picture_.serial) ++pictures_;
        picture_ = std::move(picture);
        return news;
    }

    void frame() {
        window_.begin_frame(keyboard_changes_hands());
        ui_.report.begin_frame();
        // A gesture lasts while one thing is held or typed into; every other frame may begin a new one.
        if (const ImGuiID holder = ImGui::GetActiveID(); !held_ || holder != holder_) {
            holder_ = holder;
            gesture_ = ++last_gesture_;
            gesture_edited_ = gesture_moves_ = false;
        }
        if (window_.should_close()) {
            window_.keep_open();
            files_.quit();
        }
        for (const auto& file : window_.take_dropped_files()) files_.open(file);
        keyboard();
        ui_.audit.refresh(document_.snapshot(), document_.revision(), seconds());

        const glm::vec2 size(window_.size());
        ui_.trust = &trust_;
        ui_.in_code = false;
        const ViewportInput input{document_.snapshot(), flight()};
        const LayoutResult result = layout_.draw(ui_, {size.x, size.y}, document_, input, picture_, files_,
                                                 measuring_.results(), [&](CommandId id) { return enabled(id); });
        ui_.hand_in = false;
        for (const Edits& edits : result.edits) carry_out(edits, gesture_);
        if (!ui_.problem.empty()) files_.edit_failed(std::exchange(ui_.problem, {}));
        if (result.step) go_to_step(*result.step);
        carry_out_camera(result.viewport);
        if (const auto code = std::exchange(ui_.run, nullptr)) document_.accept(*code);
        if (std::exchange(save_, false)) files_.save();
        if (result.dismissed) files_.dismiss();
        if (result.command) perform(*result.command);
        if (result.measure == MeasureWish::start)
            measuring_.start(window_.make_shared_context(), document_.snapshot(), size_);
        if (result.measure == MeasureWish::stop) measuring_.stop();
        files_.draw(ui_);
        if (document_.generation() != shown_document_) show_new_document();
        shortcut_list(ui_);
        held_ = ImGui::IsAnyItemActive();
        interacting_ = (held_ && gesture_moves_ && ImGui::IsAnyMouseDown()) || seconds() < wheel_until_;
        window_.set_title(fmt::format("{}{} - Farfield", document_.saved() ? "" : "* ", document_.name()));
        window_.end_frame();
        submit(result.viewport.size);
        if (const auto file = files_.take_export()) render_.write({.file = *file});
        if (const auto file = files_.take_thumbnail(); file && ui_.view == View::result)
            render_.write({.file = *file, .room = Thumbnails::largest, .scene = document_.snapshot()});
    }

    void remember_state() {
        const Window::Frame frame = window_.frame();
        state_.size = frame.size;
        state_.place = frame.place;
        state_.maximised = frame.maximised;
        state_.panels = layout_.sizes();
        state_.statistics = ui_.show_statistics;
        state_.code = ui_.show_code;
        state_.measure = ui_.show_measure;
        state_.recent = load_editor_state(editor_state_file()).recent;  // others may have opened more
        save_editor_state(state_, editor_state_file());
    }

    /// Keys that fly while the mouse holds the picture.
    glm::vec3 flight() const {
        const auto axis = [&](int forth, int back) {
            return (window_.is_down(forth) ? 1.0f : 0.0f) - (window_.is_down(back) ? 1.0f : 0.0f);
        };
        return {axis('D', 'A'), axis('E', 'Q'), axis('W', 'S')};
    }

    /// A field that was given the keyboard has it in the frame after the next.
    bool keyboard_changes_hands() const {
        const ImGuiContext& g = *ImGui::GetCurrentContext();
        const bool moving = g.NavMoveSubmitted && (g.NavMoveFlags & ImGuiNavMoveFlags_Tabbing);
        return ui_.focus_name || ui_.open_add || ui_.tree_search.focus || files_.wants_keyboard() || moving;
    }

    void show_new_document() {
        layout_.show_new_document(files_.take_drafts());
        shown_document_ = document_.generation();
        ui_.select(select(ObjectRef{ObjectType::node, document_.scene().root.id}));
        ui_.inspected = ui_.selection;
        ui_.tree_search = {};
        selections_.clear();
        ui_.view = View::result;
    }

    void submit(glm::vec2 picture_size) {
        // While a splitter moves, the old picture is stretched.
        const bool splitting = held_ && !gesture_edited_;
        const glm::vec2 pixels = picture_size * window_.pixels_per_unit() / static_cast<float>(ui_.tools.divisor);
        if (size_.x == 0 || !splitting) size_ = glm::max(glm::ivec2(pixels), 1);
        const Id tuned = ui_.selection.type == ObjectType::node ? ui_.selection.id : 0;
        // What is measured is the processor's time: the picture rests as soon as it shows what there is.
        const int frames = measuring_.results().running ? 1 : frames_until_rest;
        const auto wanted = std::tuple(document_.revision(), trust_.revision(), size_.x, size_.y, ui_.view, tuned,
                                       interacting_, frames);
        if (wanted == submitted_) return;
        submitted_ = wanted;
        render_.submit({.scene = document_.snapshot(),
                        .size = size_,
                        .view = ui_.view,
                        .tuned = tuned,
                        .interacting = interacting_,
                        .max_frames = frames});
    }

    void carry_out(const Edits& edits, unsigned gesture) {
        if (edits.empty()) return;
        try {
            // Values change what is selected no more than what there is.
            const bool values_only = std::all_of(
                edits.begin(), edits.end(), [](const Edit& edit) { return std::holds_alternative<SetValue>(edit); });
            const Scene before = values_only ? Scene() : document_.scene();
            const Selection selected = ui_.selected();
            const std::size_t position = document_.history().position();
            const std::vector<Id> results = document_.apply(edits, gesture);
            gesture_edited_ = true;
            if (!std::all_of(edits.begin(), edits.end(), moves_camera)) files_.edit_succeeded();
            // Settings are no object in the scene that could be followed quicker at a lower resolution, which would
            // discard the samples that most of them keep.
            for (const Edit& edit : edits) {
                const auto* set = std::get_if<SetValue>(&edit);
                gesture_moves_ |= !set || set->object.type != ObjectType::settings;
                if (const auto* moved = std::get_if<MoveNode>(&edit)) ui_.reveal = moved->node;
            }
            if (!values_only) ui_.select(selection_after(before, document_.scene(), edits, results, selected));
            if (ui_.selected() != selected) ui_.reveal = ui_.selection.id;
            selections_.done(document_.history().position(), document_.history().position() == position, selected,
                             ui_.selected());
        } catch (const EditError& error) {
            files_.edit_failed(error.what());
        }
    }

    /// To another step of the history, with what was selected then.
    void go_to_step(std::size_t step) {
        const std::size_t from = document_.history().position();
        document_.go_to(step);
        files_.edit_succeeded();
        const std::size_t position = document_.history().position();
        if (position == from) return;
        const Selection selection = selections_.at(from, position);
        if (!exists(document_.scene(), selection.primary) || selection == ui_.selected()) return;
        ui_.select(selection);
        ui_.reveal = selection.primary.id;
    }

    /// What a hand is changing is as it was before; the mouse lets go of it.
    void cancel_gesture() {
        if (gesture_edited_) document_.cancel(gesture_);
        gesture_edited_ = gesture_moves_ = false;
        ImGui::ClearActiveID();
        gesture_ = ++last_gesture_;
    }

    void copy() const { ImGui::SetClipboardText(copied_selection(document_.scene(), ui_.selected()).c_str()); }

    void paste() {
        const char* text = ImGui::GetClipboardText();
        try {
            carry_out(paste_at_selection(document_.scene(), ui_.selected(), text ? text : ""), 0);
        } catch (const EditError& error) {
            files_.edit_failed(error.what());
        }
    }

    void carry_out_camera(const ViewportResult& viewport) {
        if (!viewport.wheel) return carry_out(viewport.edits, gesture_);
        if (seconds() > wheel_until_) wheel_gesture_ = ++last_gesture_;
        wheel_until_ = seconds() + wheel_rest;
        carry_out(viewport.edits, wheel_gesture_);
    }

    bool enabled(CommandId id) const {
        const Scene& scene = document_.scene();
        switch (id) {
            case CommandId::undo:
                return document_.history().can_undo();
            case CommandId::redo:
                return document_.history().can_redo();
            case CommandId::export_picture:
                return picture_.texture != 0;
            case CommandId::recover:
                return files_.can_recover();
            case CommandId::rename:
                return ui_.selection.id != 0 && exists(scene, ui_.selection) &&
                       selected_nodes(ui_.selected()).size() < 2;
            case CommandId::copy:
            case CommandId::cut:
                return ui_.selection.type == ObjectType::node && exists(scene, ui_.selection);
            default: {
                const auto edits = edits_for(id, scene, ui_.selected());
                return !edits || !edits->empty();
            }
        }
    }

    void perform(CommandId id) {
        const Scene& scene = document_.scene();
        if (choose_tool(ui_.tools, id)) return;
        if (const glm::vec3 direction = view_direction(id); direction != glm::vec3(0.0f))
            return carry_out(camera_edits(scene.camera, looking(scene.camera, direction)), ++last_gesture_);
        if (const auto edits = edits_for(id, scene, ui_.selected())) return carry_out(*edits, 0);
        switch (id) {
            case CommandId::create:
                files_.create();
                break;
            case CommandId::open:
                files_.open();
                break;
            case CommandId::save:
                files_.save();
                break;
            case CommandId::save_as:
                files_.save_as();
                break;
            case CommandId::export_picture:
                files_.export_picture();
                break;
            case CommandId::recover:
                files_.ask_to_recover();
                break;
            case CommandId::quit:
                files_.quit();
                break;
            case CommandId::undo:
                go_to_step(document_.history().position() - 1);
                break;
            case CommandId::redo:
                go_to_step(document_.history().position() + 1);
                break;
            case CommandId::add:
                ui_.open_add = true;
                break;
            case CommandId::rename:
                ui_.focus_name = true;
                break;
            case CommandId::cut:
                copy();
                carry_out(delete_selection(scene, ui_.selected()), 0);
                break;
            case CommandId::copy:
                copy();
                break;
            case CommandId::paste:
                paste();
                break;
            case CommandId::select_all:
                ui_.select(everything(scene, ui_.selected()));
                break;
            case CommandId::search:
                ui_.tree_search.focus = true;
                break;
            case CommandId::frame_selection:
                frame_box(selection_box());
                break;
            case CommandId::frame_all:
                frame_box(framed_box(scene, {ObjectType::node, scene.root.id}));
                break;
            case CommandId::reset_camera:
                carry_out(camera_edits(scene.camera, document_.first_camera()), ++last_gesture_);
                break;
            case CommandId::history:
                ui_.show_history = !ui_.show_history;
                break;
            case CommandId::statistics:
                ui_.show_statistics = !ui_.show_statistics;
                break;
            case CommandId::code:
                ui_.show_code = !ui_.show_code;
                break;
            case CommandId::measure:
                ui_.show_measure = !ui_.show_measure;
                break;
            case CommandId::shortcuts:
                ui_.show_shortcuts = !ui_.show_shortcuts;
                break;
            default:
                break;
        }
    }

    /// Around all that is selected; around everything for what has no place.
    Box selection_box() const {
        const Scene& scene = document_.scene();
        Box box = framed_box(scene, ui_.selection);
        for (const Id id : selected_nodes(ui_.selected()))
            if (find_node(scene, id)) box = box.united(framed_box(scene, {ObjectType::node, id}));
        return box;
    }

    /// Moves the camera to where it sees the whole of it.
    void frame_box(const Box& box) {
        const Camera& camera = document_.scene().camera;
        const glm::vec2 size(size_);
        carry_out(camera_edits(camera, framed(camera, box, size.x / std::max(size.y, 1.0f))), ++last_gesture_);
    }

    void keyboard() {
        const bool asked = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
        for (const KeyPress& press : window_.keys()) {
            if (asked && press.key == escape_key && !ImGui::GetTopMostPopupModal()) ImGui::ClosePopupToLevel(0, true);
            // While something is typed or held, or a popup is open, keys belong to that; but saving never has to wait.
            const auto command = command_for(press);
            if (press.key == escape_key && held_ && ImGui::IsAnyMouseDown() && !ImGui::GetIO().WantTextInput)
                cancel_gesture();
            const bool busy = ImGui::GetIO().WantTextInput || (held_ && ImGui::IsAnyMouseDown());
            if (ui_.in_code && (command == CommandId::select_all || command == CommandId::cut)) continue;
            if (asked || (busy && command != CommandId::save)) continue;
            if (command == CommandId::save && ImGui::GetIO().WantTextInput) {
                ImGui::ClearActiveID();  // what is being typed belongs to what is saved
                save_ = ui_.hand_in = true;
            } else if (const auto view = view_for(press))
                ui_.view = *view;
            else if (command && enabled(*command))
                perform(*command);
        }
    }

    std::string selection_name() const {
        const Scene& scene = document_.scene();
        switch (ui_.selection.type) {
            case ObjectType::node:
                if (const Node* node = find_node(scene, ui_.selection.id)) return display_name(scene, *node);
                return "";
            case ObjectType::material:
                if (const Material* material = find_material(scene, ui_.selection.id)) return material->name;
                return "";
            case ObjectType::light:
                if (const Light* light = find_light(scene, ui_.selection.id)) return light->name;
                return "";
            case ObjectType::sky:
                return "Sky";
            case ObjectType::camera:
                return "Camera";
            case ObjectType::settings:
                return "Settings";
        }
        return "";
    }

    std::vector<std::string> selected_names() const {
        std::vector<std::string> names;
        for (const Id id : selected_nodes(ui_.selected()))
            if (const Node* node = find_node(document_.scene(), id))
                names.push_back(display_name(document_.scene(), *node));
        return names;
    }

    void write_report() {
        CodePanel::Lines lines;
        if (ui_.show_code && ui_.report.on()) lines = layout_.code().lines();
        ui_.report.write({.statistics = picture_.statistics,
                          .revision = document_.revision(),
                          .pictures = pictures_,
                          .saved = document_.saved(),
                          .file = document_.file().string(),
                          .error = files_.error().empty() ? picture_.error : files_.error(),
                          .notice = files_.notice(),
                          .selection = selection_name(),
                          .selected = selected_names(),
                          .step = document_.history().position(),
                          .code = ui_.show_code,
                          .code_lines = lines.count,
                          .selected_lines = lines.selected,
                          .inside_lines = lines.inside},
                         seconds());
    }

    EditorState state_ = load_editor_state(editor_state_file());
    // In order of life: the renderer's context goes before the window it shares with.
    Window window_;
    RenderThread render_;
    CodeTrust trust_{CodeTrust::user_file()};
    Document document_{trust_};
    FileActions files_{document_, state_};
    Ui ui_;
    Layout layout_;
    Measuring measuring_;
    SelectionHistory selections_;
    RenderedPicture picture_;
    std::uint64_t pictures_ = 0;

    unsigned last_gesture_ = 0, gesture_ = 0, wheel_gesture_ = 0;
    double wheel_until_ = 0.0;
    bool held_ = false;            ///< some control has the mouse or the keyboard
    ImGuiID holder_ = 0;           ///< which
    bool save_ = false;            ///< once the panels have handed in what was being typed
    bool gesture_edited_ = false;  ///< and has changed the document
    bool gesture_moves_ = false;   ///< and more of it than settings
    bool interacting_ = false;
    glm::ivec2 size_{0};
    std::tuple<std::uint64_t, std::size_t, int, int, View, Id, bool, int> submitted_{};
    std::uint64_t shown_document_ = 0;  ///< its generation
};

}  // namespace

int run_editor(const EditorOptions& options) {
    std::optional<Editor> editor;
    try {
        editor.emplace(options);
    } catch (const ContextError&) {
        // Without a window nobody sees what is wrong with the scene, and that is the easier thing to mend.
        if (!options.scene.empty()) load_scene(options.scene);
        throw;
    }
    editor->run();
    return 0;
}

}  // namespace farfield
