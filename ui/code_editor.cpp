#include "ui/code_editor.h"

#include "ui/glsl_text.h"

#include <fmt/format.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>

namespace farfield {
namespace {

constexpr int indent = 4;
constexpr std::size_t most_messages = 5;  // shown at once, the others scroll

bool key_pressed(ImGuiKey key) { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key)); }

/// What ImGui draws a text field of several lines in.
ImGuiWindow* window_of(ImGuiID field) {
    for (ImGuiWindow* window : ImGui::GetCurrentContext()->Windows)
        if (window->ChildId == field) return window;
    return nullptr;
}

}  // namespace

CodeEditor::Draft& CodeEditor::draft_of(const Node& node) {
    const std::string& now = node.code->text();
    const auto [place, fresh] = drafts_.try_emplace(node.id);
    Draft& draft = place->second;
    // Undo and others change the code too: what was not typed into follows.
    if (fresh || (draft.base != now && draft.text == draft.base)) draft.text = now;
    draft.base = now;
    if (draft.checked != draft.text || fresh) {
        draft.errors = CustomCode::parse(draft.text).errors;
        draft.checked = draft.text;
    }
    return draft;
}

CodeDrafts CodeEditor::drafts(const Scene& scene) const {
    CodeDrafts changed;
    for (const auto& [id, draft] : drafts_) {
        const Node* node = find_node(scene, id);
        if (node && node->code && node->code->text() != draft.text) changed[id] = draft.text;
    }
    return changed;
}

void CodeEditor::begin(const CodeDrafts& drafts) {
    drafts_.clear();
    for (const auto& [id, text] : drafts) drafts_[id].text = text;
}

bool CodeEditor::is_changed(const Node& node) const {
    const auto found = drafts_.find(node.id);
    return found != drafts_.end() && found->second.text != node.code->text();
}

bool CodeEditor::has_errors(const Node& node) const {
    const auto found = drafts_.find(node.id);
    return found != drafts_.end() && !found->second.errors.empty();
}

/// Tab inserts spaces, a new line begins below the one before, a closing brace moves out; Ctrl+Enter is no new line.
int CodeEditor::callback(ImGuiInputTextCallbackData* data) {
    auto& self = *static_cast<CodeEditor*>(data->UserData);
    if (data->EventFlag == ImGuiInputTextFlags_CallbackCharFilter) {
        if (data->EventChar == '\t') return self.tab_ = true, 1;
        if (data->EventChar == '\n' && ImGui::GetIO().KeyCtrl) return 1;
        // Pasted text passes here too, character by character.
        self.line_ = data->EventChar == '\n' && (key_pressed(ImGuiKey_Enter) || key_pressed(ImGuiKey_KeyPadEnter));
        self.brace_ = data->EventChar == '}' && !ImGui::GetIO().KeyCtrl;
        return 0;
    }
    const std::string_view before(data->Buf, static_cast<std::size_t>(data->CursorPos));
    if (std::exchange(self.tab_, false)) {
        const std::size_t column = cells_of(before.substr(before.rfind('\n') + 1));
        data->InsertChars(data->CursorPos, std::string(indent - column % indent, ' ').c_str());
    } else if (std::exchange(self.line_, false) && before.ends_with('\n')) {
        const std::string_view lines = before.substr(0, before.size() - 1);
        const std::string_view last = lines.substr(lines.rfind('\n') + 1);
        std::string space(last.substr(0, std::min(last.find_first_not_of(" \t"), last.size())));
        if (last.ends_with('{')) space.append(indent, ' ');
        data->InsertChars(data->CursorPos, space.c_str());
    } else if (std::exchange(self.brace_, false) && before.ends_with(std::string(indent, ' ') + "}")) {
        const std::string_view line = before.substr(before.rfind('\n') + 1);
        if (line.find_first_not_of(' ') == line.size() - 1) data->DeleteChars(data->CursorPos - 1 - indent, indent);
    }
    return 0;
}

Edits CodeEditor::draw(Ui& ui, const Node& node, bool compile, bool revert) {
    Draft& draft = draft_of(node);
    if (revert) {
        ImGui::ClearActiveID();  // the field would keep what it holds
        draft.text = draft.base;
    }
    const float line = ImGui::GetTextLineHeightWithSpacing();
    const std::size_t messages = std::clamp<std::size_t>(draft.errors.size(), 1, most_messages);
    const float footer = std::floor(line * static_cast<float>(messages) + ui.theme.px(12.0f));
    ImGui::PushID(static_cast<int>(node.id));
    const ImVec2 room = ImGui::GetContentRegionAvail();
    text(ui, draft, {room.x, std::max(room.y - footer, 3.0f * line)});
    if (ImGui::IsItemActive() && ImGui::GetIO().KeyCtrl &&
        (key_pressed(ImGuiKey_Enter) || key_pressed(ImGuiKey_KeyPadEnter)))
        compile = true;
    below(ui, node, draft);
    ImGui::PopID();
    // Saving hands in what was typed; it is no consent to run what comes from elsewhere.
    if (!compile && (!ui.hand_in || is_stopped(ui, node))) return {};
    draft_of(node);  // checks what was just typed
    if (!draft.errors.empty()) return {};
    if (draft.text == draft.base) {
        if (is_stopped(ui, node)) ui.run = node.code;
        return {};
    }
    return {SetCode{node.id, draft.text}};
}

void CodeEditor::text(Ui& ui, Draft& draft, ImVec2 size) {
    const char* const label = "##code";
    const float cell = ImGui::CalcTextSize("0").x;
    const auto lines = 1 + std::count(draft.text.begin(), draft.text.end(), '\n');
    const float gutter = std::floor(cell * (static_cast<float>(std::to_string(lines).size()) + 2.5f));
    const ImVec2 low = ImGui::GetCursorScreenPos();
    ImGui::SetCursorScreenPos({low.x + gutter, low.y});
    // The text is painted over what ImGui writes, which has one colour.
    ImGui::PushStyleColor(ImGuiCol_Text, 0);
    ImGui::PushStyleColor(ImGuiCol_FrameBg, 0);
    ImGui::PushStyleVar(ImGuiStyleVar_FrameBorderSize, 0.0f);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {ui.theme.px(8.0f), ui.theme.px(4.0f)});
    const std::string before = draft.text;
    const ImGuiInputTextFlags enter = ImGui::GetIO().KeyCtrl ? ImGuiInputTextFlags_CtrlEnterForNewLine : 0;
    ImGui::InputTextMultiline(label, &draft.text, {size.x - gutter, size.y},
                              ImGuiInputTextFlags_AllowTabInput | ImGuiInputTextFlags_CallbackAlways |
                                  ImGuiInputTextFlags_CallbackCharFilter | enter,
                              callback, this);
    // ImGui takes everything back that was typed since the field got the keyboard; here Escape only leaves it.
    if (ImGui::IsItemDeactivated() && key_pressed(ImGuiKey_Escape)) draft.text = before;
    ui.report.item("code_editor", "text");
    paint(ui, draft, label, low, gutter);
    ImGui::PopStyleVar(2);
    ImGui::PopStyleColor(2);
}

void CodeEditor::paint(const Ui& ui, const Draft& draft, const char* label, ImVec2 low, float gutter) const {
    const ImGuiID id = ImGui::GetID(label);
    const ImGuiWindow* field = window_of(id);
    if (!field) return;
    const ImGuiInputTextState* state = ImGui::GetInputTextState(id);
    const bool active = state && ImGui::GetActiveID() == id;
    const ImVec2 pad = ImGui::GetStyle().FramePadding;
    const float cell = ImGui::CalcTextSize("0").x, height = ImGui::GetFontSize();
    const float bottom = field->Pos.y + field->Size.y, right = field->Pos.x + field->Size.x;
    const ImVec2 origin{field->Pos.x + pad.x - (active ? state->ScrollX : 0.0f),
                        field->Pos.y + pad.y - field->Scroll.y};
    ImDrawList& draw = *field->DrawList;
    std::string_view rest = draft.text;
    for (int number = 1;; ++number) {
        const std::string_view line = rest.substr(0, rest.find('\n'));
        const float y = origin.y + height * static_cast<float>(number - 1);
        if (y > bottom) break;
        if (y + height > field->Pos.y) {
            const bool wrong = std::any_of(draft.errors.begin(), draft.errors.end(),
                                           [&](const CodeError& error) { return error.line == number; });
            draw.PushClipRect({low.x, field->Pos.y}, {right, bottom}, false);
            if (wrong) {
                draw.AddRectFilled({low.x, y}, {right, y + height}, IM_COL32(235, 105, 95, 40));
                draw.AddRectFilled({low.x, y}, {low.x + ui.theme.px(3.0f), y + height}, ui.theme.error);
            }
            const std::string text = std::to_string(number);
            const float x = low.x + gutter - cell * (static_cast<float>(text.size()) + 1.0f);
            draw.AddText({x, y}, wrong ? ui.theme.error : IM_COL32(92, 99, 110, 255), text.c_str());
            draw.PopClipRect();
            draw.PushClipRect({field->Pos.x, field->Pos.y}, {right, bottom}, false);
            draw_glsl(ui, draw, line, {origin.x, y}, cell);
            draw.PopClipRect();
        }
        if (line.size() == rest.size()) break;
        rest.remove_prefix(line.size() + 1);
    }
    if (!active || std::fmod(state->CursorAnim, 1.2f) > 0.8f) return;
    const ImWchar* const text = state->TextW.Data;
    int line = 0, column = 0;
    for (int i = 0; i < state->Stb.cursor && i < state->CurLenW; ++i) {
        column += text[i] == '\t' ? 4 : 1;
        if (text[i] == '\n') ++line, column = 0;
    }
    const float x = std::floor(origin.x + cell * static_cast<float>(column));
    const float y = origin.y + height * static_cast<float>(line);
    draw.PushClipRect({field->Pos.x, field->Pos.y}, {right, bottom}, false);
    draw.AddRectFilled({x, y}, {x + std::max(1.0f, ui.theme.px(1.2f)), y + height}, ui.theme.text);
    draw.PopClipRect();
}

void CodeEditor::below(Ui& ui, const Node& node, const Draft& draft) const {
    const ImVec2 low = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
    const bool wrong = !draft.errors.empty();
    ImGui::GetWindowDrawList()->AddRectFilled(low, {low.x + room.x, low.y + room.y},
                                              wrong ? ui.theme.error_background : ui.theme.header);
    ImGui::PushFont(ui.theme.regular);
    ImGui::SetCursorScreenPos({low.x + ui.theme.px(10.0f), low.y + ui.theme.px(4.0f)});
    ImGui::PushStyleColor(ImGuiCol_ChildBg, 0);
    ImGui::BeginChild("messages", {room.x - ui.theme.px(14.0f), std::max(room.y - ui.theme.px(6.0f), 1.0f)});
    for (std::size_t i = 0; i < draft.errors.size(); ++i) {
        const CodeError& error = draft.errors[i];
        ImGui::TextUnformatted(fmt::format("Line {}: {}", error.line, error.message).c_str());
        ui.report.item("code_editor/error", fmt::format("{}", error.line));
        tooltip(ui, error.message);
    }
    if (!wrong && draft.text != draft.base)
        ImGui::TextUnformatted("No errors. Ctrl+Enter compiles it.");
    else if (!wrong && is_stopped(ui, node))
        ImGui::TextUnformatted("Comes from elsewhere and was not run. Ctrl+Enter runs it.");
    else if (!wrong)
        ImGui::TextDisabled("As it is shown. Each uniform is a value in the inspector.");
    ImGui::EndChild();
    ImGui::PopStyleColor();
    ImGui::PopFont();
}

}  // namespace farfield
