#include "app/layout.h"

#include "ui/bookmark_list.h"
#include "ui/history_panel.h"
#include "ui/inspector_panel.h"
#include "ui/objects_panel.h"
#include "ui/settings_panel.h"
#include "ui/tree_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace farfield {
namespace {

/// A child window without padding at a fixed place; `draw` fills it.
template <class Draw>
void panel(const char* name, ImVec2 low, ImVec2 size, Draw draw, ImGuiWindowFlags flags = 0) {
    ImGui::SetCursorScreenPos(low);
    size = {std::max(size.x, 1.0f), std::max(size.y, 1.0f)};  // to ImGui, nothing means all that is left
    ImGui::BeginChild(name, size, false, flags | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
    draw();
    ImGui::EndChild();
}

/// What is wrong, at the upper end of the picture and over it: a picture of another size would have to begin anew.
/// Returns its height; sets `dismissed` when the user has read it.
float message_bar(Ui& ui, ImVec2 low, float width, const std::string& message, bool can_dismiss, bool& dismissed) {
    if (message.empty()) return 0.0f;
    const float pad = ui.theme.px(10.0f), button = can_dismiss ? ui.theme.px(76.0f) + pad : 0.0f;
    const float room = std::max(width - 2.0f * pad - button, 1.0f);
    const ImVec2 text = ImGui::CalcTextSize(message.c_str(), nullptr, false, room);
    // A compiler's message can be long: some lines of it are shown, the rest scrolls.
    const float lines = std::min(text.y, 8.0f * ImGui::GetTextLineHeight()) + 1.0f;
    const float height = std::max(lines, ImGui::GetFrameHeight()) + 1.2f * pad;
    ImGui::SetNextWindowPos(low);
    ImGui::SetNextWindowSize({width, height});
    ImGui::PushStyleColor(ImGuiCol_WindowBg, ui.theme.error_background);
    ImGui::PushStyleColor(ImGuiCol_ChildBg, 0);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0f, 0.0f});
    ImGui::Begin("##message", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav);
    ui.report.rectangle("message", "", low, {low.x + width, low.y + height});
    ImGui::GetWindowDrawList()->AddRectFilled(low, {low.x + ui.theme.px(3.0f), low.y + height}, ui.theme.error);
    ImGui::SetCursorPos({pad, std::floor((height - lines) * 0.5f)});
    ImGui::BeginChild("text", {room, lines});
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextUnformatted(message.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndChild();
    if (can_dismiss) {
        ImGui::SetCursorPos({width - button, std::floor((height - ImGui::GetFrameHeight()) * 0.5f)});
        dismissed = ImGui::Button("Dismiss", {button - pad, 0.0f});
        ui.report.item("message", "dismiss");
    }
    ImGui::End();
    ImGui::PopStyleVar(3);
    ImGui::PopStyleColor(2);
    return height;
}

void status_line(const Ui& ui, ImVec2 low, ImVec2 size, const Document& document, const RenderedPicture& picture,
                 const std::string& notice) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    ImFont* font = ui.theme.small_font;
    draw.AddRectFilled(low, {low.x + size.x, low.y + size.y}, ImGui::GetColorU32(ImGuiCol_MenuBarBg));
    const float y = low.y + (size.y - font->FontSize) * 0.5f, pad = ui.theme.px(10.0f);
    const Scene& scene = document.scene();
    const int nodes = count_nodes(scene) - 1;
    const Statistics& s = picture.statistics;
    std::string right = fmt::format("{} {}   {} {}", nodes, nodes == 1 ? "node" : "nodes", s.samples,
                                    s.samples == 1 ? "sample" : "samples");
    if (s.noise) right += fmt::format(", noise {}", percent_text(*s.noise));
    const float width = font->CalcTextSizeA(font->FontSize, 1e6f, 0.0f, right.c_str()).x;
    const std::size_t step = document.history().position();
    const std::string left = !notice.empty() ? notice
                             : step == 0
                                 ? "Click: select    Drag: orbit    Shift + drag: pan    Wheel: zoom    F1: all keys"
                                 : "Last step: " + document.history().description(step);
    draw.PushClipRect(low, {low.x + size.x - width - 2.0f * pad, low.y + size.y}, true);
    draw.AddText(font, font->FontSize, {low.x + pad, y}, notice.empty() ? ui.theme.dim : ui.theme.text, left.c_str());
    draw.PopClipRect();
    draw.AddText(font, font->FontSize, {low.x + size.x - width - pad, y}, ui.theme.dim, right.c_str());
}

/// Whole pixels, at least `least` and, before that, at most `most`: in a window that is too small for what the user
/// chose, panels get smaller and never lie on each other.
float within(float wanted, float least, float most) {
    return std::floor(std::max(1.0f, std::min(std::max(wanted, least), most)));
}

/// A splitter of a panel that is `now` wide or high; what the user makes of it is kept in `chosen`, at 96 dpi.
void split(Ui& ui, const char* id, ImVec2 low, ImVec2 extent, float now, float sign, float& chosen) {
    if (const float moved = splitter(ui, id, low, extent); moved != 0.0f)
        chosen = (now + sign * moved) / ui.theme.scale;
}

/// Below the entry that adds one.
Edits bookmark_menu(Ui& ui, const Scene& scene) {
    Edits edits;
    const bool open = ImGui::BeginMenu("Go to bookmark", !scene.bookmarks.empty());
    ui.report.item("menu/View", "go_to_bookmark");
    if (!open) return edits;
    for (std::size_t i = 0; i < scene.bookmarks.size(); ++i) {
        const Bookmark& bookmark = scene.bookmarks[i];
        ImGui::PushID(static_cast<int>(bookmark.id));
        if (ImGui::MenuItem(bookmark.name.c_str(), bookmark_key(i).c_str(), bookmark.camera == scene.camera))
            edits = go_to_bookmark(scene, bookmark);
        ui.report.item("menu/bookmark", bookmark.name);
        ImGui::PopID();
    }
    ImGui::EndMenu();
    return edits;
}

void append(std::vector<Edits>& to, Edits from) {
    if (!from.empty()) to.push_back(std::move(from));
}

}  // namespace

void Layout::draw_panels(Ui& ui, ImVec2 low, ImVec2 size, const Document& document, const ViewportInput& input,
                         const RenderedPicture& picture, const std::string& message, LayoutResult& result) {
    const Scene& scene = document.scene();
    const float bar = ui.theme.px(5.0f), least = ui.theme.px(110.0f);
    const float columns = size.x - 2.0f * bar, rows = size.y - bar;
    const float left = within(ui.theme.px(sizes_.left), ui.theme.px(190.0f), columns * 0.36f);
    const float right = within(ui.theme.px(sizes_.right), ui.theme.px(290.0f), columns * 0.42f);
    const float objects = within(ui.theme.px(sizes_.objects), least, std::max(rows - least, rows * 0.5f));
    const float settings = within(ui.theme.px(sizes_.settings), least, std::max(rows - least, rows * 0.5f));
    const float right_x = low.x + size.x - right;
    const float tree_height = rows - objects, inspector_height = rows - settings;

    panel("tree", low, {left, tree_height}, [&] { append(result.edits, tree_panel(ui, scene)); });
    panel("objects", {low.x, low.y + tree_height + bar}, {left, objects},
          [&] { append(result.edits, objects_panel(ui, scene)); });
    draw_middle(ui, {low.x + left + bar, low.y}, {columns - left - right, size.y}, document, input, picture, message,
                result);
    panel("inspector", {right_x, low.y}, {right, inspector_height},
          [&] { append(result.edits, inspector_panel(ui, scene)); });
    panel("settings", {right_x, low.y + inspector_height + bar}, {right, settings},
          [&] { append(result.edits, settings_panel(ui, scene, picture.statistics)); });

    split(ui, "left", {low.x + left, low.y}, {bar, size.y}, left, 1.0f, sizes_.left);
    split(ui, "right", {right_x - bar, low.y}, {bar, size.y}, right, -1.0f, sizes_.right);
    split(ui, "objects", {low.x, low.y + tree_height}, {left, bar}, objects, -1.0f, sizes_.objects);
    split(ui, "settings", {right_x, low.y + inspector_height}, {right, bar}, settings, -1.0f, sizes_.settings);
}

void Layout::draw_middle(Ui& ui, ImVec2 low, ImVec2 size, const Document& document, const ViewportInput& input,
                         const RenderedPicture& picture, const std::string& message, LayoutResult& result) {
    ImVec2 room = size;
    if (ui.show_code) {
        // Beside the picture where both can be wide, otherwise below it: a line of code has some ninety characters.
        const float bar = ui.theme.px(5.0f), least = ui.theme.px(120.0f);
        const auto draw = [&] { append(result.edits, code_.draw(ui, document.scene(), document.revision())); };
        if (size.x >= ui.theme.px(1100.0f)) {
            const float width = within(ui.theme.px(sizes_.code_width), least, size.x - bar - least);
            room.x = size.x - width - bar;
            panel("code", {low.x + room.x + bar, low.y}, {width, size.y}, draw);
            split(ui, "code", {low.x + room.x, low.y}, {bar, size.y}, width, -1.0f, sizes_.code_width);
        } else {
            const float height =
                within(ui.theme.px(sizes_.code_height), least, std::max(size.y - bar - least, size.y * 0.5f));
            room.y = size.y - height - bar;
            panel("code", {low.x, low.y + room.y + bar}, {size.x, height}, draw);
            split(ui, "code", {low.x, low.y + room.y}, {size.x, bar}, height, -1.0f, sizes_.code_height);
        }
    }
    // A message about the document can be put away; one about the picture stays as long as it is true.
    const float covered = message.empty() ? message_bar(ui, low, room.x, picture.error, false, result.dismissed)
                                          : message_bar(ui, low, room.x, message, true, result.dismissed);
    // On llvmpipe each layer that is filled costs as much as everything else in the frame.
    panel(
        "viewport", low, room, [&] { result.viewport = viewport_.draw(ui, document.scene(), input, picture, covered); },
        ImGuiWindowFlags_NoBackground);
}

LayoutResult Layout::draw(Ui& ui, ImVec2 size, const Document& document, const ViewportInput& input,
                          const RenderedPicture& picture, FileActions& files, const MeasureResults& measured,
                          const std::function<bool(CommandId)>& enabled) {
    LayoutResult result;
    ImGui::SetNextWindowPos({0.0f, 0.0f});
    ImGui::SetNextWindowSize(size);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0f, 0.0f});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
    ImGui::Begin("main", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoBringToFrontOnFocus |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_MenuBar | ImGuiWindowFlags_NoScrollWithMouse |
                     ImGuiWindowFlags_NoBackground);  // the cleared window has it
    ImGui::PopStyleVar(3);
    if (ImGui::BeginMenuBar()) {
        result.command = command_menus(ui, enabled, [&](CommandId id) {
            files.menu(ui, id);
            if (id == CommandId::bookmark) append(result.edits, bookmark_menu(ui, document.scene()));
        });
        ImGui::EndMenuBar();
    }
    const ImVec2 low{0.0f, ImGui::GetFrameHeight()};
    const float status = ui.theme.px(22.0f);
    draw_panels(ui, low, {size.x, std::max(size.y - low.y - status, 1.0f)}, document, input, picture, files.error(),
                result);
    status_line(ui, {0.0f, size.y - status}, {size.x, status}, document, picture, files.notice());
    ImGui::End();
    append(result.edits, measure_panel(ui, document.scene(), measured, result.measure));
    result.step = history_panel(ui, document.history());
    return result;
}

}  // namespace farfield
