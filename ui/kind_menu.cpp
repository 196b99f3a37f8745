#include "ui/kind_menu.h"

#include <algorithm>

namespace farfield {
namespace {

struct Group {
    const char* title;
    int column;
    bool (*holds)(Role);
};

constexpr Group groups[] = {
    {"Shapes", 0, [](Role role) { return role == Role::primitive; }},
    {"Combine", 1, [](Role role) { return role == Role::combine; }},
    {"Modify", 1, [](Role role) { return role != Role::primitive && role != Role::combine && role != Role::instance; }},
};

}  // namespace

std::optional<NodeKind> kind_menu(Ui& ui, const char* panel, const std::function<bool(const KindInfo&)>& allowed) {
    std::optional<NodeKind> chosen;
    const float width = ui.theme.px(150.0f);
    int column = -1;
    for (const Group& group : groups) {
        const auto kinds = node_kinds();
        if (std::none_of(kinds.begin(), kinds.end(),
                         [&](const KindInfo& k) { return group.holds(k.role) && allowed(k); }))
            continue;
        if (group.column != column) {
            if (column >= 0) {
                ImGui::EndGroup();
                ImGui::SameLine(0.0f, ui.theme.px(14.0f));
            }
            ImGui::BeginGroup();
            column = group.column;
        }
        ImGui::PushFont(ui.theme.small_font);
        ImGui::TextDisabled("%s", group.title);
        ImGui::PopFont();
        for (const KindInfo& kind : kinds) {
            if (!group.holds(kind.role) || !allowed(kind)) continue;
            ImGui::PushID(kind.key);
            const ImVec2 start = ImGui::GetCursorScreenPos();
            if (ImGui::Selectable("##kind", false, 0, {width, 0.0f})) chosen = kind.kind;
            ui.report.item(panel, kind.key);
            tooltip(ui, kind.tip, kind.exact ? "Exact distance" : "Lower bound of the distance");
            const float height = ImGui::GetTextLineHeight();
            draw_icon(ui, kind.role, {start.x + ui.theme.px(9.0f), start.y + height * 0.5f});
            ImGui::GetWindowDrawList()->AddText({start.x + ui.theme.px(24.0f), start.y}, ui.theme.text, kind.label);
            ImGui::PopID();
        }
        ImGui::Dummy({0.0f, ui.theme.px(2.0f)});
    }
    if (column >= 0) ImGui::EndGroup();
    return chosen;
}

std::optional<Node> node_menu(Ui& ui, const char* panel, const Scene& scene) {
    std::optional<Node> chosen;
    if (const auto kind = kind_menu(ui, panel, [](const KindInfo&) { return true; })) chosen = make_node(*kind);
    if (scene.definitions.empty()) return chosen;
    ImGui::SameLine(0.0f, ui.theme.px(14.0f));
    ImGui::BeginGroup();
    ImGui::PushFont(ui.theme.small_font);
    ImGui::TextDisabled("Instances");
    ImGui::PopFont();
    for (const Node& definition : scene.definitions) {
        ImGui::PushID(static_cast<int>(definition.id));
        const ImVec2 start = ImGui::GetCursorScreenPos();
        const std::string label = "Instance of " + definition.name;
        const bool clicked = ImGui::Selectable("##definition", false, 0, {ui.theme.px(150.0f), 0.0f});
        ui.report.item(panel, label);
        draw_icon(ui, Role::instance, {start.x + ui.theme.px(9.0f), start.y + ImGui::GetTextLineHeight() * 0.5f});
        ImGui::GetWindowDrawList()->AddText({start.x + ui.theme.px(24.0f), start.y}, ui.theme.text, label.c_str());
        if (clicked) chosen = make_instance(definition);
        ImGui::PopID();
    }
    ImGui::EndGroup();
    return chosen;
}

}  // namespace farfield
