#include "ui/kind_menu.h"

#include "sdf/kind_words.h"

#include <imgui_stdlib.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <iterator>
#include <sstream>

namespace farfield {
namespace {

/// Groups above one another make a block; blocks stand beside one another.
struct Group {
    const char* title;
    int block;
    std::size_t columns;
};
constexpr Group groups[] = {{"Shapes", 0, 2}, {"Profiles", 0, 2}, {"Combine", 1, 1},
                            {"Space", 2, 1},  {"Repeat", 2, 1},   {"Distance", 2, 1}};

constexpr float column_width = 134.0f, column_gap = 12.0f;

std::string lower_case(std::string_view text) {
    std::string lower(text);
    std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
    return lower;
}

std::vector<std::string> words_of(const std::string& text) {
    std::istringstream in(text);
    return {std::istream_iterator<std::string>(in), {}};
}

/// One line of the menu; true when it was clicked. `note`: dimmed, at the other end.
bool entry(Ui& ui, const char* panel, const KindInfo& kind, float width, bool marked, const char* note = nullptr) {
    ImGui::PushID(kind.key);
    const ImVec2 start = ImGui::GetCursorScreenPos();
    const bool clicked = ImGui::Selectable("##kind", marked, 0, {width, 0.0f});
    ui.report.item(panel, kind.key);
    tooltip(ui, kind.tip, kind.exact ? "Exact distance" : "Lower bound of the distance");
    const float height = ImGui::GetTextLineHeight();
    draw_icon(ui, kind.role, {start.x + ui.theme.px(9.0f), start.y + height * 0.5f});
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.AddText({start.x + ui.theme.px(21.0f), start.y}, ui.theme.text, kind.label);
    if (note) {
        ImFont* font = ui.theme.small_font;
        const float from = start.x + width - font->CalcTextSizeA(font->FontSize, 1e6f, 0.0f, note).x;
        draw.AddText(font, font->FontSize, {from, start.y + 0.5f * (height - font->FontSize)}, ui.theme.dim, note);
    }
    ImGui::PopID();
    return clicked;
}

std::optional<NodeKind> group_entries(Ui& ui, const char* panel, const Group& group,
                                      const std::vector<const KindInfo*>& kinds) {
    std::optional<NodeKind> chosen;
    const float width = ui.theme.px(column_width);
    ImGui::PushFont(ui.theme.small_font);
    ImGui::TextDisabled("%s", group.title);
    ImGui::PopFont();
    const std::size_t rows = (kinds.size() + group.columns - 1) / group.columns;
    for (std::size_t column = 0; column < group.columns; ++column) {
        if (column > 0) ImGui::SameLine(0.0f, ui.theme.px(column_gap));
        ImGui::BeginGroup();
        for (std::size_t i = column * rows; i < std::min((column + 1) * rows, kinds.size()); ++i)
            if (entry(ui, panel, *kinds[i], width, false)) chosen = kinds[i]->kind;
        ImGui::EndGroup();
    }
    return chosen;
}

std::optional<NodeKind> all_entries(Ui& ui, const char* panel, const KindFilter& allowed) {
    std::optional<NodeKind> chosen;
    int block = -1;
    for (const Group& group : groups) {
        std::vector<const KindInfo*> kinds;
        for (const KindInfo& kind : node_kinds())
            if (std::strcmp(kind_group(kind), group.title) == 0 && allowed(kind)) kinds.push_back(&kind);
        if (kinds.empty()) continue;
        if (group.block != block) {
            if (block >= 0) {
                ImGui::EndGroup();
                ImGui::SameLine(0.0f, ui.theme.px(column_gap));
            }
            ImGui::BeginGroup();
            block = group.block;
        } else {
            ImGui::Dummy({0.0f, ui.theme.px(2.0f)});
        }
        if (const auto clicked = group_entries(ui, panel, group, kinds)) chosen = clicked;
    }
    if (block >= 0) ImGui::EndGroup();
    return chosen;
}

}  // namespace

const char* kind_group(const KindInfo& kind) {
    switch (kind.role) {
        case Role::primitive:
            return kind.flat ? "Profiles" : "Shapes";
        case Role::combine:
            return "Combine";
        case Role::domain:  // some leave the point as it is and change the distance by where it is
            return kind.domain ? "Space" : "Distance";
        case Role::repeat:
            return "Repeat";
        case Role::distance:
            return "Distance";
        case Role::instance:
            break;  // they are offered by the definition they show
    }
    return "";
}

std::vector<const KindInfo*> matching_kinds(std::string_view text, const KindFilter& allowed) {
    const std::string wanted = lower_case(text);
    const std::vector<std::string> words = words_of(wanted);
    const auto all_in = [&](const std::string& place) {
        return std::all_of(words.begin(), words.end(),
                           [&](const std::string& word) { return place.find(word) != std::string::npos; });
    };
    std::string joined;
    for (const std::string& word : words) joined += (joined.empty() ? "" : " ") + word;
    constexpr int rank_count = 6;
    std::vector<const KindInfo*> ranks[rank_count];
    for (const KindInfo& kind : node_kinds()) {
        if (kind.role == Role::instance || !allowed(kind)) continue;
        const std::string label = lower_case(kind.label);
        const std::string names = label + " " + kind.key + " " + lower_case(kind_group(kind));
        const bool begins = !words.empty() && label.starts_with(words[0]) && all_in(label);
        const bool word_begins = !words.empty() && label.find(" " + words[0]) != std::string::npos && all_in(label);
        if (label == joined)
            ranks[0].push_back(&kind);
        else if (begins)
            ranks[1].push_back(&kind);
        else if (word_begins)
            ranks[2].push_back(&kind);
        else if (all_in(names))
            ranks[3].push_back(&kind);
        else if (all_in(names + " " + std::string(other_words(kind.kind))))
            ranks[4].push_back(&kind);
        else if (all_in(names + " " + lower_case(kind.tip)))
            ranks[5].push_back(&kind);
    }
    for (int i = 1; i < rank_count; ++i) ranks[0].insert(ranks[0].end(), ranks[i].begin(), ranks[i].end());
    return ranks[0];
}

std::optional<NodeKind> kind_menu(Ui& ui, const char* panel, const KindFilter& allowed) {
    KindSearch& search = ui.kind_search;
    if (ImGui::IsWindowAppearing()) {
        search = {};
        ImGui::SetKeyboardFocusHere();
    }
    const float width = ui.theme.px(2.0f * column_width + column_gap);
    ImGui::SetNextItemWidth(width);
    const bool entered =
        ImGui::InputTextWithHint("##search", "Type to search", &search.text, ImGuiInputTextFlags_EnterReturnsTrue);
    ui.report.item(panel, "search");
    if (ImGui::IsItemEdited()) search.marked = 0;
    const bool has_keyboard = ImGui::IsItemActive();
    ImGui::Dummy({0.0f, ui.theme.px(1.0f)});
    if (words_of(search.text).empty()) return all_entries(ui, panel, allowed);

    const std::vector<const KindInfo*> found = matching_kinds(search.text, allowed);
    if (found.empty()) {
        ImGui::TextDisabled("There is no such kind");
        return std::nullopt;
    }
    const int last = static_cast<int>(found.size()) - 1;
    if (has_keyboard && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_DownArrow))) ++search.marked;
    if (has_keyboard && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_UpArrow))) --search.marked;
    search.marked = std::clamp(search.marked, 0, last);
    if (entered) return found[static_cast<std::size_t>(search.marked)]->kind;
    std::optional<NodeKind> chosen;
    for (int i = 0; i <= last; ++i) {
        const KindInfo& kind = *found[static_cast<std::size_t>(i)];
        if (entry(ui, panel, kind, width, i == search.marked, kind_group(kind))) chosen = kind.kind;
    }
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
