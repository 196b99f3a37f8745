#include "ui/bookmark_list.h"

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace farfield {
namespace {

/// What gives the camera of `object` the values of `to`, to the last bit.
Edits camera_edits(const Scene& scene, ObjectRef object, const Camera& to) {
    Edits edits;
    for (const Field<Camera>& field : fields<Camera>())
        if (const glm::vec3 wanted = field.get(to); value(scene, object, field.parameter.key) != wanted)
            edits.push_back(SetValue{object, field.parameter.key, wanted});
    return edits;
}

class BookmarkList {
public:
    BookmarkList(Ui& ui, const Scene& scene, Edits& edits)
        : ui_(ui), scene_(scene), edits_(edits), top_(ImGui::GetCursorScreenPos().y) {}

    void draw() {
        ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ImGui::GetStyle().ItemSpacing.x, 0.0f});
        for (std::size_t i = 0; i < scene_.bookmarks.size(); ++i) {
            const Bookmark& bookmark = scene_.bookmarks[i];
            ImGui::PushID(static_cast<int>(bookmark.id));
            if (ui_.bookmark_entry.renamed == bookmark.id)
                name_field(bookmark);
            else
                row(bookmark, i);
            ImGui::PopID();
        }
        ImGui::PopStyleVar();
    }

private:
    void row(const Bookmark& bookmark, std::size_t index) {
        const ImVec2 low = ImGui::GetCursorScreenPos();
        const float height = ImGui::GetFrameHeight(), width = ImGui::GetContentRegionAvail().x;
        const bool here = bookmark.camera == scene_.camera;
        const bool pressed = ImGui::InvisibleButton("##row", {std::max(width, 1.0f), height});
        ui_.report.item("bookmarks", bookmark.name);
        const bool hovered = ImGui::IsItemHovered(), active = ImGui::IsItemActive();
        const float more = low.x + width - height;  // where the sign of the menu begins
        const bool on_more = hovered && ImGui::GetIO().MousePos.x >= more;
        const bool dragged = ImGui::GetIO().MouseDragMaxDistanceSqr[ImGuiMouseButton_Left] >= 16.0f;
        if (active && dragged) drag(bookmark, index, height);
        if (hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left) && !on_more)
            rename(bookmark);
        else if (pressed && !dragged && on_more)
            ImGui::OpenPopup("menu");
        else if (pressed && !dragged)
            append(go_to_bookmark(scene_, bookmark));
        const std::string key = bookmark_key(index);
        tooltip(ui_, "Click goes to this view; drag it to another place, double-click to rename",
                key.empty() ? "Right-click for more" : key + "; right-click for more");
        if (ImGui::IsItemClicked(ImGuiMouseButton_Right)) ImGui::OpenPopup("menu");
        draw_row(bookmark, index, low, {low.x + width, low.y + height}, here, hovered || active);
        if (hovered) {
            ImDrawList& draw = *ImGui::GetWindowDrawList();
            for (const float dot : {-1.0f, 0.0f, 1.0f})
                draw.AddCircleFilled({more + height * 0.5f + dot * ui_.theme.px(4.5f), low.y + height * 0.5f},
                                     ui_.theme.px(1.4f), on_more ? ui_.theme.text : ui_.theme.dim);
        }
        menu(bookmark, index);
    }

    void draw_row(const Bookmark& bookmark, std::size_t index, ImVec2 low, ImVec2 high, bool here, bool lit) const {
        ImDrawList& draw = *ImGui::GetWindowDrawList();
        if (lit) draw.AddRectFilled(low, high, ImGui::GetColorU32(ImGuiCol_HeaderHovered), ui_.theme.px(4.0f));
        const float text = std::floor(0.5f * (low.y + high.y - ImGui::GetTextLineHeight()));
        draw.PushClipRect(low, {high.x - (lit ? high.y - low.y : 0.0f), high.y}, true);
        draw.AddText({low.x + ui_.theme.px(6.0f), text}, ui_.theme.dim, fmt::format("{}", index + 1).c_str());
        draw.AddText({low.x + ui_.theme.px(28.0f), text}, here ? ui_.theme.accent : ui_.theme.text,
                     bookmark.name.c_str());
        draw.PopClipRect();
    }

    /// It takes the place of the row that the mouse has come to.
    void drag(const Bookmark& bookmark, std::size_t index, float height) {
        const float last = static_cast<float>(scene_.bookmarks.size() - 1);
        const float to = std::clamp(std::floor((ImGui::GetIO().MousePos.y - top_) / height), 0.0f, last);
        if (static_cast<std::size_t>(to) != index) edits_.push_back(MoveBookmark{bookmark.id, static_cast<int>(to)});
    }

    void menu(const Bookmark& bookmark, std::size_t index) {
        const PopupMenu popup(ui_, "menu");
        if (!popup.is_open()) return;
        entry("Go there", bookmark_key(index), go_to_bookmark(scene_, bookmark));
        entry("Set to the present view", "", update_bookmark(scene_, bookmark));
        if (ImGui::MenuItem("Rename")) rename(bookmark);
        ui_.report.item("bookmark", "Rename");
        ImGui::Separator();
        const int at = static_cast<int>(index);
        entry("Move up", "", at > 0 ? Edits{MoveBookmark{bookmark.id, at - 1}} : Edits{});
        entry("Move down", "",
              index + 1 < scene_.bookmarks.size() ? Edits{MoveBookmark{bookmark.id, at + 1}} : Edits{});
        ImGui::Separator();
        entry("Delete", "", {RemoveBookmark{bookmark.id}});
    }

    /// Greyed where there is nothing to do.
    void entry(const char* label, const std::string& key, Edits edits) {
        if (ImGui::MenuItem(label, key.c_str(), false, !edits.empty())) append(std::move(edits));
        ui_.report.item("bookmark", label);
    }

    void rename(const Bookmark& bookmark) {
        ui_.bookmark_entry = {.renamed = bookmark.id, .focus = true, .text = bookmark.name};
    }

    void name_field(const Bookmark& bookmark) {
        BookmarkEntry& entry = ui_.bookmark_entry;
        const bool begins = std::exchange(entry.focus, false);
        if (begins) ImGui::SetKeyboardFocusHere();
        ImGui::SetNextItemWidth(-FLT_MIN);
        ImGui::InputText("##name", &entry.text, ImGuiInputTextFlags_AutoSelectAll);
        ui_.report.item("bookmarks", "name");
        if (ImGui::IsItemDeactivatedAfterEdit() && entry.text != bookmark.name)
            edits_.push_back(SetName{{ObjectType::bookmark, bookmark.id}, entry.text});
        if (ImGui::IsItemDeactivated()) entry = {};
    }

    void append(Edits edits) { std::move(edits.begin(), edits.end(), std::back_inserter(edits_)); }

    Ui& ui_;
    const Scene& scene_;
    Edits& edits_;
    const float top_;
};

}  // namespace

Edits go_to_bookmark(const Scene& scene, const Bookmark& bookmark) {
    return camera_edits(scene, {ObjectType::camera, 0}, bookmark.camera);
}

Edits update_bookmark(const Scene& scene, const Bookmark& bookmark) {
    return camera_edits(scene, {ObjectType::bookmark, bookmark.id}, scene.camera);
}

std::string bookmark_key(std::size_t index) { return index < 9 ? fmt::format("Ctrl+{}", index + 1) : ""; }

void bookmark_list(Ui& ui, const Scene& scene, Edits& edits) {
    if (heading(ui, "Bookmarks", "inspector", "add_bookmark", "Keeps the present view to come back to", "Ctrl+B"))
        edits.push_back(AddBookmark{{0, "", scene.camera}});
    if (!scene.bookmarks.empty()) return BookmarkList(ui, scene, edits).draw();
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextDisabled("None yet. + or Ctrl+B keeps the present view; Ctrl+1 to Ctrl+9 come back.");
    ImGui::PopTextWrapPos();
}

}  // namespace farfield
