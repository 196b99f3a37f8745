#include "app/editor.h"

#include "app/editor_commands.h"
#include "app/camera_control.h"
#include "app/document.h"
#include "app/file_actions.h"
#include "app/layout.h"
#include "app/measuring.h"
#include "app/window.h"
#include "sdf/scene_file.h"
#include "ui/tree_panel.h"

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
            if (news || measured || of_files || ui_.audit.finished() || redraws > 0 || attentive) frame();
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
        const LayoutResult result = layout_.draw(ui_, {size.x, size.y}, document_, picture_, files_,
                                                 measuring_.results(), [&](CommandId id) { return enabled(id); });
        ui_.hand_in = false;
        carry_out(result.edits, gesture_);
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

    /// A field that was given the keyboard has it in the frame after the next.
    bool keyboard_changes_hands() const {
        const ImGuiContext& g = *ImGui::GetCurrentContext();
        const bool moving = g.NavMoveSubmitted && (g.NavMoveFlags & ImGuiNavMoveFlags_Tabbing);
        return ui_.focus_name || ui_.open_add || files_.wants_keyboard() || moving;
    }

    void show_new_document() {
        layout_.show_new_document(files_.take_drafts());
        shown_document_ = document_.generation();
        ui_.selection = ui_.inspected = {ObjectType::node, document_.scene().root.id};
        ui_.view = View::result;
    }

    void submit(glm::vec2 picture_size) {
        // While a splitter moves, the old picture is stretched.
        const bool splitting = held_ && !gesture_edited_;
        if (size_.x == 0 || !splitting) size_ = glm::max(glm::ivec2(picture_size * window_.pixels_per_unit()), 1);
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
        for (const Edit& edit : edits) {
            try {
                const ObjectRef next = selection_after(edit);
                const Id id = document_.apply(edit, gesture);
                gesture_edited_ = true;
                if (!moves_camera(edit)) files_.edit_succeeded();
                // Settings are no object in the scene that could be followed quicker at a lower resolution, which would
                // discard the samples that most of them keep.
                const auto* set = std::get_if<SetValue>(&edit);
                gesture_moves_ |= !set || set->object.type != ObjectType::settings;
                ui_.selection = next;
                if (std::holds_alternative<InsertNode>(edit) || std::holds_alternative<MakeDefinition>(edit) ||
                    std::holds_alternative<MakeIndependent>(edit))
                    ui_.selection = {ObjectType::node, ui_.reveal = id};
                if (std::holds_alternative<AddMaterial>(edit)) ui_.selection = {ObjectType::material, ui_.reveal = id};
                if (std::holds_alternative<AddLight>(edit)) ui_.selection = {ObjectType::light, ui_.reveal = id};
                if (const auto* moved = std::get_if<MoveNode>(&edit)) ui_.reveal = moved->node;
            } catch (const EditError& error) {
                files_.edit_failed(error.what());
            }
        }
    }

    void carry_out_camera(const ViewportResult& viewport) {
        if (!viewport.wheel) return carry_out(viewport.edits, gesture_);
        if (seconds() > wheel_until_) wheel_gesture_ = ++last_gesture_;
        wheel_until_ = seconds() + wheel_rest;
        carry_out(viewport.edits, wheel_gesture_);
    }

    /// What is selected once `edit` is done: a neighbour of a removed node, otherwise the same as before.
    ObjectRef selection_after(const Edit& edit) const {
        const auto* removed = std::get_if<RemoveNode>(&edit);
        const Node* parent = removed ? find_parent(document_.scene(), removed->node) : nullptr;
        if (!parent) return ui_.selection;
        const auto& siblings = parent->children;
        const auto it =
            std::find_if(siblings.begin(), siblings.end(), [&](const Node& n) { return n.id == removed->node; });
        if (it + 1 != siblings.end()) return {ObjectType::node, (it + 1)->id};
        if (it != siblings.begin()) return {ObjectType::node, (it - 1)->id};
        return {ObjectType::node, parent->id};
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
            case CommandId::duplicate:
                return !duplicate_selection(ui_, scene).empty();
            case CommandId::remove:
                return !delete_selection(ui_, scene).empty();
            case CommandId::make_definition:
                return !define_selection(ui_, scene).empty();
            case CommandId::make_independent:
                return !free_selection(ui_, scene).empty();
            case CommandId::move_up:
                return !shift_selection(ui_, scene, -1).empty();
            case CommandId::move_down:
                return !shift_selection(ui_, scene, 1).empty();
            case CommandId::rename:
                return ui_.selection.id != 0 && exists(scene, ui_.selection);
            default:
                return true;
        }
    }

    void perform(CommandId id) {
        const Scene& scene = document_.scene();
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
                document_.undo();
                files_.edit_succeeded();
                break;
            case CommandId::redo:
                document_.redo();
                files_.edit_succeeded();
                break;
            case CommandId::add:
                ui_.open_add = true;
                break;
            case CommandId::duplicate:
                carry_out(duplicate_selection(ui_, scene), 0);
                break;
            case CommandId::rename:
                ui_.focus_name = true;
                break;
            case CommandId::remove:
                carry_out(delete_selection(ui_, scene), 0);
                break;
            case CommandId::make_definition:
                carry_out(define_selection(ui_, scene), 0);
                break;
            case CommandId::make_independent:
                carry_out(free_selection(ui_, scene), 0);
                break;
            case CommandId::move_up:
                carry_out(shift_selection(ui_, scene, -1), 0);
                break;
            case CommandId::move_down:
                carry_out(shift_selection(ui_, scene, 1), 0);
                break;
            case CommandId::frame_selection:
                frame_object(ui_.selection);
                break;
            case CommandId::frame_all:
                frame_object({ObjectType::node, scene.root.id});
                break;
            case CommandId::reset_camera:
                carry_out(camera_edits(scene.camera, document_.first_camera()), ++last_gesture_);
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
        }
    }

    /// Moves the camera to where it sees the whole of a node or light; everything instead of what has no place.
    void frame_object(ObjectRef object) {
        const Scene& scene = document_.scene();
        const glm::vec2 size(size_);
        const Box box = framed_box(scene, object);
        carry_out(camera_edits(scene.camera, framed(scene.camera, box, size.x / std::max(size.y, 1.0f))),
                  ++last_gesture_);
    }

    void keyboard() {
        const bool asked = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
        for (const KeyPress& press : window_.keys()) {
            if (asked && press.key == escape_key && !ImGui::GetTopMostPopupModal()) ImGui::ClosePopupToLevel(0, true);
            // While something is typed or held, or a popup is open, keys belong to that; but saving never has to wait.
            const auto command = command_for(press);
            const bool busy = ImGui::GetIO().WantTextInput || (held_ && ImGui::IsAnyMouseDown());
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
