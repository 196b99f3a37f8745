// What commands and keys do in the editor.
#include "app/camera_control.h"
#include "app/editor.h"
#include "app/selection_commands.h"
#include "ui/bookmark_list.h"
#include "ui/tree_edits.h"

#include <imgui_internal.h>

#include <algorithm>

namespace farfield {

void Editor::keyboard(const std::vector<KeyPress>& keys) {
    const bool asked = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
    for (const KeyPress& press : keys) {
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
        else if (const auto bookmark = bookmark_for(press))
            go_to_bookmark(*bookmark);
        else if (command && enabled(*command))
            perform(*command);
    }
}

bool Editor::enabled(CommandId id) const {
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
            return ui_.selection.id != 0 && exists(scene, ui_.selection) && selected_nodes(ui_.selected()).size() < 2;
        case CommandId::copy:
        case CommandId::cut:
            return ui_.selection.type == ObjectType::node && exists(scene, ui_.selection);
        default: {
            const auto edits = edits_for(id, scene, ui_.selected());
            return !edits || !edits->empty();
        }
    }
}

void Editor::perform(CommandId id) {
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
        case CommandId::bookmark:
            carry_out({AddBookmark{{0, "", scene.camera}}}, 0);
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

void Editor::copy() const { ImGui::SetClipboardText(copied_selection(document_.scene(), ui_.selected()).c_str()); }

void Editor::paste() {
    const char* text = ImGui::GetClipboardText();
    try {
        carry_out(paste_at_selection(document_.scene(), ui_.selected(), text ? text : ""), 0);
    } catch (const EditError& error) {
        files_.edit_failed(error.what());
    }
}

/// Around all that is selected; around everything for what has no place.
Box Editor::selection_box() const {
    const Scene& scene = document_.scene();
    Box box = framed_box(scene, ui_.selection);
    for (const Id id : selected_nodes(ui_.selected()))
        if (find_node(scene, id)) box = box.united(framed_box(scene, {ObjectType::node, id}));
    return box;
}

void Editor::go_to_bookmark(std::size_t index) {
    const Scene& scene = document_.scene();
    if (index < scene.bookmarks.size())
        carry_out(farfield::go_to_bookmark(scene, scene.bookmarks[index]), ++last_gesture_);
}

/// Moves the camera to where it sees the whole of it.
void Editor::frame_box(const Box& box) {
    const Camera& camera = document_.scene().camera;
    const glm::vec2 size(size_);
    carry_out(camera_edits(camera, framed(camera, box, size.x / std::max(size.y, 1.0f))), ++last_gesture_);
}

}  // namespace farfield
