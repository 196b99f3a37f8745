#include "ui/code_panel.h"

#include "ui/glsl_text.h"

#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <unordered_set>

namespace farfield {
namespace {

constexpr double most_of_the_time = 0.1;  // at most this part of it goes into writing code while a hand moves something
constexpr double shown_as_copied = 1.2;   // seconds

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; }

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

void gather(const Node& node, std::unordered_set<Id>& ids) {
    ids.insert(node.id);
    for (const Node& child : node.children) gather(child, ids);
}

/// A button in a title strip that ends at `right`; moves `right` to its left end. None where there is no room.
bool strip_button(Ui& ui, const char* label, const char* name, float width, bool on, float y, float& right,
                  const char* tip, const char* hint) {
    if (right - width < ImGui::GetWindowPos().x + ui.theme.px(60.0f)) return false;
    right -= width;
    ImGui::SetCursorScreenPos({right, y});
    right -= ui.theme.px(4.0f);
    if (on) ImGui::PushStyleColor(ImGuiCol_Text, ui.theme.accent);
    const bool pressed = ImGui::Button(label, {width, 0.0f});
    if (on) ImGui::PopStyleColor();
    ui.report.item("code", name);
    tooltip(ui, tip, hint);
    return pressed;
}

}  // namespace

Edits CodePanel::draw(Ui& ui, const Scene& scene, std::uint64_t revision) {
    const Node* selected = ui.selection.type == ObjectType::node ? find_node(scene, ui.selection.id) : nullptr;
    const Node* custom = selected && selected->code ? selected : nullptr;
    const bool editing = custom && ui.edit_code;
    bool compile = false, revert = false;
    title(ui, custom, editing, compile, revert);
    if (editing) {
        ImGui::PushFont(ui.theme.mono);
        const Edits edits = editor_.draw(ui, *custom, compile, revert);
        ImGui::PopFont();
        return edits;
    }
    refresh(scene, revision);
    mark(ui, scene);
    ImGui::PushFont(ui.theme.mono);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0f, 0.0f});
    ImGui::BeginChild("text", {0.0f, 0.0f}, false,
                      ImGuiWindowFlags_HorizontalScrollbar | ImGuiWindowFlags_NoBackground);
    ImGui::PopStyleVar();
    text(ui, scene);
    ImGui::EndChild();
    ImGui::PopFont();
    return {};
}

CodePanel::Lines CodePanel::lines() const {
    Lines lines{marks_.size(), {}, {}};
    for (std::size_t i = 0; i < marks_.size(); ++i)
        if (marks_[i] != Mark::none) (marks_[i] == Mark::selected ? lines.selected : lines.inside).push_back(i + 1);
    return lines;
}

void CodePanel::title(Ui& ui, const Node* custom, bool editing, bool& compile, bool& revert) {
    panel_title(ui, "Code");
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const ImVec2 below = ImGui::GetCursorScreenPos();
    const float y = low.y + ui.theme.px(3.0f);
    float right = high.x - ui.theme.px(6.0f);
    if (custom) {
        // Which of the two codes: tabs beside the title.
        float end = low.x + ui.theme.px(60.0f) + ui.theme.px(66.0f + 4.0f + 66.0f);
        if (strip_button(ui, "Node", "node", ui.theme.px(66.0f), editing, y, end,
                         "The code of the selected node, to be written", ""))
            ui.edit_code = true;
        if (strip_button(ui, "Scene", "scene", ui.theme.px(66.0f), !editing, y, end,
                         "The code that the whole scene comes to", ""))
            ui.edit_code = false;
    }
    if (editing) {
        const bool changed = editor_.is_changed(*custom), stopped = is_stopped(ui, *custom);
        ImGui::BeginDisabled((!changed && !stopped) || editor_.has_errors(*custom));
        compile = strip_button(ui, stopped && !changed ? "Run" : "Compile", "compile", ui.theme.px(74.0f), changed, y,
                               right, "Shows the shape that the code describes", "Ctrl+Enter");
        ImGui::EndDisabled();
        ImGui::BeginDisabled(!changed);
        revert = strip_button(ui, "Revert", "revert", ui.theme.px(62.0f), false, y, right,
                              "Back to the code that is shown", "");
        ImGui::EndDisabled();
        ImGui::SetCursorScreenPos(below);
        return;
    }
    const char* copy_label = ImGui::GetTime() - copied_ < shown_as_copied ? "Copied" : "Copy";
    if (strip_button(ui, copy_label, "copy", ui.theme.px(62.0f), false, y, right,
                     "Copies the selected text, or all of it",
                     "Drag over the code to select text. Ctrl+C copies too")) {
        const std::string chosen = chosen_text();
        copy(chosen.empty() ? code_.text : chosen);
    }
    right -= ui.theme.px(6.0f);
    if (strip_button(ui, "Live", "live", ui.theme.px(48.0f), tier_ == Tier::live, y, right,
                     "The program whose numbers come from a parameter block",
                     "No edit of a number needs a new program"))
        tier_ = Tier::live;
    if (strip_button(ui, "Literals", "literals", ui.theme.px(70.0f), tier_ == Tier::specialised, y, right,
                     "The program with every number as a literal", "It runs fastest"))
        tier_ = Tier::specialised;
    ImGui::SetCursorScreenPos(below);
}

void CodePanel::refresh(const Scene& scene, std::uint64_t revision) {
    if (tier_ == generated_tier_) {
        if (!starts_.empty() && revision == revision_) return;
        // Writing the code of a large scene takes a while; then it lags behind the hand, not the hand behind it.
        if (!starts_.empty() && ImGui::GetTime() < next_refresh_) return;
    }
    const auto start = std::chrono::steady_clock::now();
    GeneratedScene code = generate(scene, tier_);
    revision_ = revision;
    generated_tier_ = tier_;
    if (code.text != code_.text || starts_.empty()) {
        code_ = std::move(code);
        anchor_ = head_ = {};
        marks_are_old_ = true;
        starts_ = {0};
        longest_ = 0;
        for (std::size_t at; (at = code_.text.find('\n', starts_.back())) != std::string::npos;) {
            longest_ =
                std::max(longest_, cells_of(std::string_view(code_.text).substr(starts_.back(), at - starts_.back())));
            starts_.push_back(at + 1);
        }
    }
    const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    next_refresh_ = ImGui::GetTime() + took / most_of_the_time;
}

void CodePanel::mark(const Ui& ui, const Scene& scene) {
    if (marked_ != ui.selection) scroll_to_ = true;
    if (marked_ == ui.selection && !marks_are_old_) return;
    marked_ = ui.selection;
    marks_are_old_ = false;
    marks_.assign(starts_.size() - 1, Mark::none);
    const Node* node = marked_.type == ObjectType::node ? find_node(scene, marked_.id) : nullptr;
    if (!node) return;
    std::unordered_set<Id> inside;
    gather(*node, inside);
    for (std::size_t i = 0; i < marks_.size() && i < code_.line_nodes.size(); ++i) {
        const Id id = code_.line_nodes[i];
        marks_[i] = id == node->id ? Mark::selected : inside.contains(id) ? Mark::inside : Mark::none;
    }
}

std::string_view CodePanel::line_text(std::size_t line) const {
    return std::string_view(code_.text).substr(starts_[line], starts_[line + 1] - starts_[line] - 1);
}

CodePanel::Place CodePanel::place_at(ImVec2 offset, float cell, float height) const {
    if (marks_.empty() || offset.y < 0.0f) return {};
    const auto line = static_cast<std::size_t>(offset.y / height);
    if (line >= marks_.size()) return {marks_.size() - 1, line_text(marks_.size() - 1).size()};
    const std::string_view text = line_text(line);
    const int column = std::max(0, static_cast<int>(std::floor(offset.x / cell + 0.5f)));
    std::size_t byte = 0;
    for (int i = 0; i < column && byte < text.size(); ++i) do
            ++byte;
        while (byte < text.size() && continues(text[byte]));
    return {line, byte};
}

std::string CodePanel::chosen_text() const {
    const auto [from, to] = std::minmax(anchor_, head_);
    if (from == to || to.line + 1 >= starts_.size()) return {};
    const std::size_t start = starts_[from.line] + from.byte;
    return code_.text.substr(start, starts_[to.line] + to.byte - start);
}

std::string CodePanel::node_text(Id node) const {
    std::string text;
    for (std::size_t i = 0; i < marks_.size(); ++i)
        if (code_.line_nodes[i] == node) text.append(line_text(i)).append("\n");
    return text;
}

void CodePanel::copy(std::string text) {
    ImGui::SetClipboardText(text.c_str());
    copied_ = ImGui::GetTime();
}

void CodePanel::draw_line(const Ui& ui, std::size_t line, ImVec2 at, float cell) const {
    draw_glsl(ui, *ImGui::GetWindowDrawList(), line_text(line), at, cell);
}

void CodePanel::select_text(Ui& ui, Place at) {
    const ImGuiIO& io = ImGui::GetIO();
    if (ImGui::IsItemActivated()) {
        if (!io.KeyShift) anchor_ = at;
        head_ = at;
    }
    if (ImGui::IsItemActive() && ImGui::IsMouseDragPastThreshold(ImGuiMouseButton_Left)) {
        head_ = at;
        // Beyond the edge the text moves along.
        const ImVec2 low = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
        const auto beyond = [](float v, float from, float to) { return v < from ? v - from : v > to ? v - to : 0.0f; };
        ImGui::SetScrollY(ImGui::GetScrollY() + 0.3f * beyond(io.MousePos.y, low.y, low.y + size.y));
        ImGui::SetScrollX(ImGui::GetScrollX() + 0.3f * beyond(io.MousePos.x, low.x, low.x + size.x));
    }
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left) && !marks_.empty()) {
        const std::string_view line = line_text(at.line);
        std::size_t from = at.byte, to = at.byte;
        while (from > 0 && is_word(line[from - 1])) --from;
        while (to < line.size() && is_word(line[to])) ++to;
        anchor_ = {at.line, from};
        head_ = {at.line, to};
    } else if (ImGui::IsItemDeactivated() && anchor_ == head_ && at.line < marks_.size()) {
        // A click, not a drag.
        if (const Id node = code_.line_nodes[at.line]; node != 0) {
            ui.selection = {ObjectType::node, node};
            ui.reveal = node;
        }
    }
    ui.in_code = ImGui::IsWindowFocused();
    if (!ui.in_code || !io.KeyCtrl || io.WantTextInput) return;
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_A), false) && !marks_.empty()) {
        anchor_ = {};
        head_ = {marks_.size() - 1, line_text(marks_.size() - 1).size()};
    }
    const std::string chosen = chosen_text();
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_C), false) && !chosen.empty()) copy(chosen);
}

void CodePanel::context_menu(const Ui& ui, const Scene& scene) {
    ImGui::PushFont(ui.theme.regular);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ui.theme.px(10.0f), ui.theme.px(8.0f)});
    if (ImGui::BeginPopupContextItem("copy")) {
        const std::string chosen = chosen_text();
        if (ImGui::MenuItem("Copy", "Ctrl+C", false, !chosen.empty())) copy(chosen);
        const Node* node = marked_.type == ObjectType::node ? find_node(scene, marked_.id) : nullptr;
        if (node && ImGui::MenuItem(fmt::format("Copy lines of {}", display_name(*node)).c_str()))
            copy(node_text(node->id));
        if (ImGui::MenuItem("Copy all")) copy(code_.text);
        ImGui::EndPopup();
    }
    ImGui::PopStyleVar();
    ImGui::PopFont();
}

void CodePanel::text(Ui& ui, const Scene& scene) {
    const float cell = ImGui::CalcTextSize("0").x, height = std::floor(ImGui::GetTextLineHeight() * 1.12f);
    const ImVec2 low = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    const std::size_t count = marks_.size();
    const float gutter = std::floor(cell * (static_cast<float>(std::to_string(count).size()) + 2.5f));
    const float pad = ui.theme.px(8.0f), whole = height * static_cast<float>(count);

    const ImVec2 canvas_low = ImGui::GetCursorScreenPos();
    const ImVec2 origin{canvas_low.x + gutter + pad, canvas_low.y + std::floor(pad * 0.5f)};
    const ImVec2 room = ImGui::GetContentRegionAvail();
    ImGui::InvisibleButton("canvas", {std::max(room.x, gutter + 2.0f * pad + cell * static_cast<float>(longest_)),
                                      std::max(room.y, whole + pad)});
    const bool hovered = ImGui::IsItemHovered();
    const ImVec2 mouse = ImGui::GetMousePos();
    const Place at = place_at({mouse.x - origin.x, mouse.y - origin.y}, cell, height);
    select_text(ui, at);
    const bool on_line = hovered && mouse.y >= origin.y && mouse.y < origin.y + whole;
    pointed_ = on_line && !ImGui::IsAnyMouseDown() ? code_.line_nodes[at.line] : 0;
    if (hovered && mouse.x > low.x + gutter) ImGui::SetMouseCursor(ImGuiMouseCursor_TextInput);
    context_menu(ui, scene);
    if (const Node* node = pointed_ != 0 ? find_node(scene, pointed_) : nullptr) {
        ImGui::PushFont(ui.theme.regular);
        tooltip(ui, display_name(*node), node->name.empty() ? "" : info(node->kind).label);
        ImGui::PopFont();
    }

    // Only what is in sight is drawn: a click on a line costs the same in a scene of ten thousand.
    const auto line_at = [&](float y) {
        return std::min(count, static_cast<std::size_t>(std::max(0.0f, (y - origin.y) / height)));
    };
    const std::size_t first = line_at(low.y), last = std::min(count, line_at(low.y + size.y) + 1);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImU32 accent = ui.theme.accent & ~IM_COL32_A_MASK;
    const bool everything = marked_ == ObjectRef{ObjectType::node, scene.root.id};
    const auto [from, to] = std::minmax(anchor_, head_);
    const auto row = [&](std::size_t line) { return origin.y + height * static_cast<float>(line); };
    for (std::size_t i = first; i < last; ++i) {
        const float y = row(i);
        if (marks_[i] == Mark::selected || (marks_[i] == Mark::inside && !everything))
            draw.AddRectFilled({low.x, y}, {low.x + size.x, y + height},
                               accent | IM_COL32(0, 0, 0, marks_[i] == Mark::selected ? 46 : 16));
        if (pointed_ != 0 && code_.line_nodes[i] == pointed_)
            draw.AddRectFilled({low.x, y}, {low.x + size.x, y + height}, IM_COL32(255, 255, 255, 12));
        ui.report.rectangle("code/line", fmt::format("{}", i + 1), {low.x, y}, {low.x + size.x, y + height});
    }
    draw.PushClipRect({low.x + gutter, low.y}, {low.x + size.x, low.y + size.y}, true);
    for (std::size_t i = first; i < last; ++i) {
        if (from != to && i >= from.line && i <= to.line) {
            const std::string_view text = line_text(i);
            const auto x = [&](std::size_t byte) {
                return origin.x + cell * static_cast<float>(cells_of(text.substr(0, byte)));
            };
            draw.AddRectFilled({i == from.line ? x(from.byte) : origin.x, row(i)},
                               {i == to.line ? x(to.byte) : x(text.size()) + cell, row(i) + height},
                               IM_COL32(90, 130, 190, 110));
        }
        draw_line(ui, i, {origin.x, row(i) + std::floor((height - ImGui::GetFontSize()) * 0.5f)}, cell);
    }
    draw.PopClipRect();
    for (std::size_t i = first; i < last; ++i) {
        const std::string number = std::to_string(i + 1);
        const float x = low.x + gutter - cell * (static_cast<float>(number.size()) + 1.0f);
        const bool selected = marks_[i] == Mark::selected;
        draw.AddText({x, row(i) + std::floor((height - ImGui::GetFontSize()) * 0.5f)},
                     selected ? ui.theme.accent : IM_COL32(92, 99, 110, 255), number.c_str());
        if (marks_[i] != Mark::none)
            draw.AddRectFilled({low.x, row(i)}, {low.x + ui.theme.px(selected ? 3.0f : 2.0f), row(i) + height},
                               selected ? ui.theme.accent : accent | IM_COL32(0, 0, 0, 110));
    }

    if (!scroll_to_) return;
    scroll_to_ = false;
    // Each run of marked lines is a part of the node; one that begins in sight is enough.
    const auto begins = [&](std::size_t line) {
        return marks_[line] != Mark::none && (line == 0 || marks_[line - 1] == Mark::none);
    };
    for (std::size_t i = first; i < last; ++i)
        if (begins(i) && row(i) >= low.y && row(i) + height <= low.y + size.y) return;
    const auto wanted = std::find_if(marks_.begin(), marks_.end(), [](Mark m) { return m != Mark::none; });
    if (wanted == marks_.end()) return;
    ImGui::SetScrollY(height * static_cast<float>(wanted - marks_.begin()) - 0.25f * size.y);
}

}  // namespace farfield
