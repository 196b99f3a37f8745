#include "ui/ui.h"

#include <imgui_internal.h>

#include <algorithm>
#include <cctype>

namespace farfield {

bool exists(const Scene& scene, ObjectRef object) {
    switch (object.type) {
        case ObjectType::node:
            return find_node(scene, object.id) != nullptr;
        case ObjectType::material:
            return find_material(scene, object.id) != nullptr;
        case ObjectType::light:
            return find_light(scene, object.id) != nullptr;
        case ObjectType::bookmark:
            return find_bookmark(scene, object.id) != nullptr;
        default:
            return true;
    }
}

void forget_text_undo() {
#if IMGUI_VERSION_NUM < 18800
    // Dear ImGui hands a field its old steps when it is entered again, whatever text it has by then, and ends the
    // program when they do not fit.
    ImGuiContext& g = *ImGui::GetCurrentContext();
    if (g.ActiveId == g.InputTextState.ID) return;
    auto& undo = g.InputTextState.Stb.undostate;
    undo.undo_point = 0;
    undo.undo_char_point = 0;
    undo.redo_point = STB_TEXTEDIT_UNDOSTATECOUNT;
    undo.redo_char_point = STB_TEXTEDIT_UNDOCHARCOUNT;
#endif
}

bool is_stopped(const Ui& ui, const Node& node) { return node.code && ui.trust && !ui.trust->knows(*node.code); }

std::string label_of(std::string_view key) {
    std::string label(key);
    std::replace(label.begin(), label.end(), '_', ' ');
    if (label.starts_with("ao ")) label.replace(0, 2, "AO");
    if (!label.empty()) label[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(label[0])));
    return label;
}

void panel_title(const Ui& ui, const char* title) {
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const float height = ImGui::GetFrameHeight() + ui.theme.px(6.0f);
    const ImVec2 high{low.x + ImGui::GetContentRegionAvail().x, low.y + height};
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.AddRectFilled(low, high, ui.theme.header);
    const float y = low.y + (height - ui.theme.bold->FontSize) * 0.5f;
    draw.AddText(ui.theme.bold, ui.theme.bold->FontSize, {low.x + ui.theme.px(10.0f), y}, ui.theme.text, title);
    ImGui::SetCursorScreenPos({low.x, low.y});
    ImGui::Dummy({high.x - low.x, height});
}

void begin_rows() {
    ImGui::BeginChild("rows", {0.0f, 0.0f}, false,
                      ImGuiWindowFlags_AlwaysUseWindowPadding | ImGuiWindowFlags_NoBackground);  // the panel has it
}

void section(const Ui& ui, const char* title) {
    ImGui::Dummy({0.0f, ui.theme.px(3.0f)});
    ImGui::PushFont(ui.theme.small_font);
    ImGui::TextDisabled("%s", title);
    ImGui::PopFont();
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const float y = (low.y + high.y) * 0.5f, x = high.x + ui.theme.px(8.0f);
    const float end = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
    if (end > x) ImGui::GetWindowDrawList()->AddLine({x, y}, {end, y}, ImGui::GetColorU32(ImGuiCol_Separator));
}

bool heading(Ui& ui, const char* title, const char* panel, const char* name, std::string_view tip,
             std::string_view hint) {
    section(ui, title);
    const float side = ui.theme.px(20.0f);
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - side);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0.0f, 0.0f});
    ImGui::PushID(name);
    const bool pressed = ImGui::Button("+", {side, ImGui::GetTextLineHeight()});
    ImGui::PopID();
    ImGui::PopStyleVar();
    ui.report.item(panel, name);
    tooltip(ui, tip, hint);
    return pressed;
}

void tooltip(const Ui& ui, std::string_view text, std::string_view hint) {
    if (!ImGui::IsItemHovered() || ImGui::IsAnyItemActive()) return;
    // Rest: the mouse has been over the same item for a while.
    ImGuiStorage& storage = *ImGui::GetStateStorage();
    const ImGuiID item_key = ImGui::GetID("tooltip item"), since_key = ImGui::GetID("tooltip since");
    const ImVec2 low = ImGui::GetItemRectMin();
    const int place = static_cast<int>(low.x) * 8192 + static_cast<int>(low.y);
    const float now = static_cast<float>(ImGui::GetTime());
    if (storage.GetInt(item_key) != place) {
        storage.SetInt(item_key, place);
        storage.SetFloat(since_key, now);
    }
    if (now - storage.GetFloat(since_key) < 0.45f) return;
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ui.theme.px(9.0f), ui.theme.px(7.0f)});
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(ui.theme.px(320.0f));
    ImGui::TextUnformatted(text.data(), text.data() + text.size());
    if (!hint.empty()) {
        ImGui::PushStyleColor(ImGuiCol_Text, ui.theme.dim);
        ImGui::TextUnformatted(hint.data(), hint.data() + hint.size());
        ImGui::PopStyleColor();
    }
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
    ImGui::PopStyleVar();
}

PopupMenu::PopupMenu(const Ui& ui, const char* id) {
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ui.theme.px(10.0f), ui.theme.px(8.0f)});
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ui.theme.px(7.0f), ui.theme.px(6.0f)});
    open_ = ImGui::BeginPopup(id);
}

PopupMenu::~PopupMenu() {
    if (open_) ImGui::EndPopup();
    ImGui::PopStyleVar(2);
}

void draw_icon(const Ui& ui, Role role, ImVec2 centre) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImU32 color = ui.theme.role(role);
    const float r = ui.theme.px(5.0f);
    switch (role) {
        case Role::primitive:
            draw.AddCircleFilled(centre, r * 0.9f, color);
            break;
        case Role::combine:
            draw.AddCircle({centre.x - r * 0.45f, centre.y}, r * 0.8f, color, 0, ui.theme.px(1.4f));
            draw.AddCircle({centre.x + r * 0.45f, centre.y}, r * 0.8f, color, 0, ui.theme.px(1.4f));
            break;
        case Role::domain:
        case Role::repeat:
            for (const float x : {-0.6f, 0.6f})
                for (const float y : {-0.6f, 0.6f})
                    draw.AddCircleFilled({centre.x + x * r, centre.y + y * r}, r * 0.38f, color);
            break;
        case Role::distance:
            draw.AddCircle(centre, r * 0.8f, color, 0, ui.theme.px(2.0f));
            break;
        case Role::instance:
            draw.AddCircle({centre.x - r * 0.3f, centre.y - r * 0.3f}, r * 0.7f, color, 0, ui.theme.px(1.4f));
            draw.AddCircleFilled({centre.x + r * 0.3f, centre.y + r * 0.3f}, r * 0.7f, color);
            break;
    }
}

void draw_eye(const Ui& ui, bool open, ImVec2 centre, ImU32 color) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float w = ui.theme.px(6.0f), h = ui.theme.px(4.5f), line = ui.theme.px(1.3f);
    // Two arcs from corner to corner.
    for (const float side : {-1.0f, 1.0f})
        draw.AddBezierQuadratic({centre.x - w, centre.y}, {centre.x, centre.y + 2.0f * side * h},
                                {centre.x + w, centre.y}, color, line);
    draw.AddCircleFilled(centre, ui.theme.px(2.0f), color);
    if (!open) draw.AddLine({centre.x - w, centre.y + h}, {centre.x + w, centre.y - h}, color, line);
}

void draw_lock(const Ui& ui, bool closed, ImVec2 centre, ImU32 color) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float w = ui.theme.px(4.0f), bow = ui.theme.px(2.6f), line = ui.theme.px(1.3f);
    draw.AddRectFilled({centre.x - w, centre.y - ui.theme.px(0.5f)}, {centre.x + w, centre.y + ui.theme.px(5.0f)},
                       color, ui.theme.px(1.0f));
    const float x = centre.x + (closed ? 0.0f : bow * 1.2f), y = centre.y - ui.theme.px(2.0f);
    draw.PathLineTo({x - bow, centre.y});
    draw.PathArcTo({x, y}, bow, 3.14159f, 6.28318f);
    if (closed) draw.PathLineTo({x + bow, centre.y});
    draw.PathStroke(color, 0, line);
}

void draw_warning(const Ui& ui, ImVec2 centre) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float r = ui.theme.px(6.0f), y = centre.y + ui.theme.px(0.5f);
    draw.AddTriangleFilled({centre.x, y - r}, {centre.x + r, y + r * 0.8f}, {centre.x - r, y + r * 0.8f},
                           ui.theme.warning);
    const float bar = ui.theme.px(0.8f);
    draw.AddRectFilled({centre.x - bar, y - r * 0.4f}, {centre.x + bar, y + r * 0.2f}, ui.theme.header);
    draw.AddRectFilled({centre.x - bar, y + r * 0.4f}, {centre.x + bar, y + r * 0.65f}, ui.theme.header);
}

float splitter(Ui& ui, const char* id, ImVec2 low, ImVec2 extent) {
    const bool upright = extent.y > extent.x;
    ImGui::SetCursorScreenPos(low);
    ImGui::InvisibleButton(id, extent);
    ui.report.item("splitter", id);
    const bool active = ImGui::IsItemActive();
    if (!active && !ImGui::IsItemHovered()) return 0.0f;
    ImGui::SetMouseCursor(upright ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
    const ImVec2 inset = upright ? ImVec2(ui.theme.px(1.5f), 0.0f) : ImVec2(0.0f, ui.theme.px(1.5f));
    ImGui::GetWindowDrawList()->AddRectFilled(
        {low.x + inset.x, low.y + inset.y}, {low.x + extent.x - inset.x, low.y + extent.y - inset.y},
        ImGui::GetColorU32(active ? ImGuiCol_SeparatorActive : ImGuiCol_SeparatorHovered));
    if (!active) return 0.0f;
    return upright ? ImGui::GetIO().MouseDelta.x : ImGui::GetIO().MouseDelta.y;
}

}  // namespace farfield
