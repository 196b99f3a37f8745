#include "app/editor.h"

#include "app/split_view.h"
#include "app/thumbnails.h"
#include "ui/tree_edits.h"

#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <utility>

namespace farfield {
namespace {

// The picture gets no better by eye long before this many frames; then the machine may rest.
constexpr int frames_until_rest = 4096;
constexpr double wheel_rest = 0.4;  // seconds: turns of the wheel closer than this are one gesture

/// Whether what is to be seen is another scene, so that a hand which goes on wants quick pictures. Settings are no
/// object in the scene that could be followed quicker at a lower resolution, which would discard the samples that most
/// of them keep.
bool changes_picture(const Edit& edit) {
    if (const auto* set = std::get_if<SetValue>(&edit))
        return set->object.type != ObjectType::settings && set->object.type != ObjectType::bookmark;
    return !std::holds_alternative<MoveBookmark>(edit);
}

/// Looking around is no work on the scene, though undo covers it.
bool moves_camera(const Edit& edit) {
    const auto* set = std::get_if<SetValue>(&edit);
    return set && set->object.type == ObjectType::camera;
}

std::string selection_name(const Scene& scene, ObjectRef selection) {
    switch (selection.type) {
        case ObjectType::node:
            if (const Node* node = find_node(scene, selection.id)) return display_name(scene, *node);
            return "";
        case ObjectType::material:
            if (const Material* material = find_material(scene, selection.id)) return material->name;
            return "";
        case ObjectType::light:
            if (const Light* light = find_light(scene, selection.id)) return light->name;
            return "";
        case ObjectType::sky:
            return "Sky";
        case ObjectType::camera:
            return "Camera";
        case ObjectType::bookmark:
            return "";  // is never selected
        case ObjectType::settings:
            return "Settings";
    }
    return "";
}

std::vector<std::string> selected_names(const Scene& scene, const Selection& selection) {
    std::vector<std::string> names;
    for (const Id id : selected_nodes(selection))
        if (const Node* node = find_node(scene, id)) names.push_back(display_name(scene, *node));
    return names;
}

}  // namespace

Editor::Editor(EditorState& state, const Theme& theme, Report report)
    : state_(state), ui_(theme, std::move(report)), layout_(state.panels) {
    ui_.show_statistics = state_.statistics;
    ui_.show_code = state_.code;
    ui_.show_measure = state_.measure;
    ui_.tools.split = state_.split;
    show_new_document();
}

bool Editor::show(RenderedPicture picture) {
    const auto seen = [](const RenderedPicture& p) {
        const Statistics& s = p.statistics;
        return std::tuple(p.serial, p.error, p.compiled, s.structural_compiles, s.specialisations, s.frames);
    };
    const bool news = seen(picture) != seen(picture_);
    if (picture.serial != picture_.serial) ++pictures_;
    picture_ = std::move(picture);
    return news;
}

bool Editor::refresh(double now) {
    const bool of_files = files_.refresh(layout_.code().drafts(document_.scene()), now);
    return of_files || ui_.audit.finished() || layout_.news();
}

EditorOutput Editor::frame(const EditorInput& input, const MeasureResults& measured) {
    now_ = input.now;
    ui_.report.begin_frame();
    begin_gesture();
    if (input.close) files_.quit();
    for (const auto& file : input.dropped) files_.open(file);
    keyboard(input.keys);
    ui_.audit.refresh(document_.snapshot(), document_.revision(), size_.y, now_);

    ui_.frame_milliseconds = input.frame_milliseconds;
    ui_.trust = &trust_;
    ui_.in_code = false;
    const LayoutResult result =
        layout_.draw(ui_, {input.size.x, input.size.y}, document_, {document_.snapshot(), input.fly}, picture_, files_,
                     measured, [&](CommandId id) { return enabled(id); });
    ui_.hand_in = false;
    carry_out(result);
    shortcut_list(ui_);
    files_.draw(ui_);  // the last: to Dear ImGui no window may appear after a question that does
    if (document_.generation() != shown_document_) show_new_document();
    held_ = ImGui::IsAnyItemActive();
    interacting_ = (held_ && gesture_moves_ && ImGui::IsAnyMouseDown()) || now_ < wheel_until_;

    EditorOutput output;
    output.title = fmt::format("{}{} - Farfield", document_.saved() ? "" : "* ", document_.name());
    output.request = request(input, result.viewport.size, measured.running);
    if (const auto file = files_.take_export()) output.pictures.push_back({.file = *file});
    if (const auto file = files_.take_thumbnail(); file && ui_.view == View::result)
        output.pictures.push_back({.file = *file, .room = Thumbnails::largest, .scene = document_.snapshot()});
    output.measure = result.measure;
    return output;
}

void Editor::end() {
    files_.end();
    state_.panels = layout_.sizes();
    state_.statistics = ui_.show_statistics;
    state_.code = ui_.show_code;
    state_.measure = ui_.show_measure;
    state_.split = ui_.tools.split;
}

/// A gesture lasts while one thing is held or typed into; every other frame may begin a new one.
void Editor::begin_gesture() {
    const ImGuiID holder = ImGui::GetActiveID();
    if (held_ && holder == holder_) return;
    holder_ = holder;
    gesture_ = ++last_gesture_;
    gesture_edited_ = gesture_moves_ = false;
}

/// What the window's panels came to, in this order.
void Editor::carry_out(const LayoutResult& result) {
    for (const Edits& edits : result.edits) carry_out(edits, gesture_);
    if (!ui_.problem.empty()) files_.edit_failed(std::exchange(ui_.problem, {}));
    if (result.step) go_to_step(*result.step);
    carry_out_camera(result.viewport);
    if (const auto code = std::exchange(ui_.run, nullptr)) document_.accept(*code);
    if (std::exchange(save_, false)) files_.save();
    if (result.dismissed) files_.dismiss();
    if (result.command) perform(*result.command);
}

void Editor::carry_out(const Edits& edits, unsigned gesture) {
    if (edits.empty()) return;
    try {
        // Values change what is selected no more than what there is.
        const bool values_only = std::all_of(edits.begin(), edits.end(),
                                             [](const Edit& edit) { return std::holds_alternative<SetValue>(edit); });
        const Scene before = values_only ? Scene() : document_.scene();
        const Selection selected = ui_.selected();
        const std::size_t position = document_.history().position();
        const std::vector<Id> results = document_.apply(edits, gesture);
        gesture_edited_ = true;
        if (!std::all_of(edits.begin(), edits.end(), moves_camera)) files_.edit_succeeded();
        for (const Edit& edit : edits) {
            gesture_moves_ |= changes_picture(edit);
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

void Editor::carry_out_camera(const ViewportResult& viewport) {
    if (!viewport.wheel) return carry_out(viewport.edits, gesture_);
    if (now_ > wheel_until_) wheel_gesture_ = ++last_gesture_;
    wheel_until_ = now_ + wheel_rest;
    carry_out(viewport.edits, wheel_gesture_);
}

/// To another step of the history, with what was selected then.
void Editor::go_to_step(std::size_t step) {
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
void Editor::cancel_gesture() {
    if (gesture_edited_) document_.cancel(gesture_);
    gesture_edited_ = gesture_moves_ = false;
    ImGui::ClearActiveID();
    gesture_ = ++last_gesture_;
}

void Editor::show_new_document() {
    layout_.show_new_document(files_.take_drafts());
    shown_document_ = document_.generation();
    ui_.select(select(ObjectRef{ObjectType::node, document_.scene().root.id}));
    ui_.inspected = ui_.selection;
    ui_.tree_search = {};
    selections_.clear();
    ui_.view = View::result;
}

bool Editor::keyboard_changes_hands() const {
    const ImGuiContext& g = *ImGui::GetCurrentContext();
    const bool moving = g.NavMoveSubmitted && (g.NavMoveFlags & ImGuiNavMoveFlags_Tabbing);
    return ui_.focus_name || ui_.open_add || ui_.tree_search.focus || ui_.bookmark_entry.focus ||
           files_.wants_keyboard() || moving;
}

std::optional<RenderRequest> Editor::request(const EditorInput& input, glm::vec2 picture_size, bool measuring) {
    // While a splitter moves, the old picture is stretched.
    const bool splitting = held_ && !gesture_edited_;
    const glm::vec2 pixels = picture_size * input.pixels_per_unit / static_cast<float>(ui_.tools.divisor);
    if (size_.x == 0 || !splitting) size_ = glm::max(glm::ivec2(pixels), 1);
    const Id tuned = ui_.selection.type == ObjectType::node ? ui_.selection.id : 0;
    // What is measured is the processor's time: the picture rests as soon as it shows what there is.
    const int frames = measuring ? 1 : frames_until_rest;
    const SplitView& split = ui_.tools.split;
    const auto other = split.on ? std::optional(split.other(own_look(ui_, document_.scene()))) : std::nullopt;
    const auto wanted = std::tuple(document_.revision(), trust_.revision(), size_.x, size_.y, ui_.view, other, tuned,
                                   interacting_, frames);
    if (wanted == requested_) return std::nullopt;
    requested_ = wanted;
    return RenderRequest{.scene = document_.snapshot(),
                         .size = size_,
                         .view = ui_.view,
                         .other = other,
                         .tuned = tuned,
                         .interacting = interacting_,
                         .max_frames = frames};
}

void Editor::write_report(double now) {
    const Scene& scene = document_.scene();
    CodePanel::Lines lines;
    if (ui_.show_code && ui_.report.on()) lines = layout_.code().lines();
    const auto label = [](View view) { return std::string(views()[static_cast<std::size_t>(view)].label); };
    ui_.report.write({.statistics = picture_.statistics,
                      .revision = document_.revision(),
                      .pictures = pictures_,
                      .view = label(picture_.view),
                      .beside = picture_.beside ? label(picture_.beside->view) : "",
                      .ui_milliseconds = ui_.frame_milliseconds,
                      .saved = document_.saved(),
                      .file = document_.file().string(),
                      .error = error(),
                      .notice = files_.notice(),
                      .selection = selection_name(scene, ui_.selection),
                      .selected = selected_names(scene, ui_.selected()),
                      .step = document_.history().position(),
                      .code = ui_.show_code,
                      .code_lines = lines.count,
                      .selected_lines = lines.selected,
                      .inside_lines = lines.inside},
                     now);
}

}  // namespace farfield
