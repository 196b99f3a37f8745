#include "app/editor_commands.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace farfield {
namespace {

enum Modifier { plain = 0, ctrl = 1, shift = 2, alt = 4 };

struct Command {
    CommandId id;
    const char* menu;
    const char* name;  ///< in the report
    const char* label;
    int key;
    int modifiers;
    const char* key_text;
    bool separated = false;  ///< from the entry above
};

constexpr Command commands[] = {
    {CommandId::create, "File", "new", "New", 'N', ctrl, "Ctrl+N"},
    {CommandId::open, "File", "open", "Open...", 'O', ctrl, "Ctrl+O"},
    {CommandId::save, "File", "save", "Save", 'S', ctrl, "Ctrl+S", true},
    {CommandId::save_as, "File", "save_as", "Save as...", 'S', ctrl | shift, "Ctrl+Shift+S"},
    {CommandId::export_picture, "File", "export_picture", "Export picture...", 'E', ctrl, "Ctrl+E", true},
    {CommandId::recover, "File", "recover", "Recover unsaved work...", 0, plain, ""},
    {CommandId::quit, "File", "quit", "Quit", 'Q', ctrl, "Ctrl+Q", true},
    {CommandId::undo, "Edit", "undo", "Undo", 'Z', ctrl, "Ctrl+Z"},
    {CommandId::redo, "Edit", "redo", "Redo", 'Y', ctrl, "Ctrl+Y, Ctrl+Shift+Z"},
    {CommandId::add, "Edit", "add", "Add...", 'A', plain, "A, Shift+A", true},
    {CommandId::duplicate, "Edit", "duplicate", "Duplicate", 'D', ctrl, "Ctrl+D"},
    {CommandId::rename, "Edit", "rename", "Rename", GLFW_KEY_F2, plain, "F2"},
    {CommandId::remove, "Edit", "delete", "Delete", GLFW_KEY_DELETE, plain, "Del"},
    {CommandId::move_up, "Edit", "move_up", "Move up", GLFW_KEY_UP, alt, "Alt+Up", true},
    {CommandId::move_down, "Edit", "move_down", "Move down", GLFW_KEY_DOWN, alt, "Alt+Down"},
    {CommandId::make_definition, "Edit", "make_definition", "Make definition", 'I', ctrl, "Ctrl+I", true},
    {CommandId::make_independent, "Edit", "make_independent", "Make independent", 'I', ctrl | shift, "Ctrl+Shift+I"},
    {CommandId::frame_selection, "View", "frame_selection", "Frame selection", 'F', plain, "F", true},
    {CommandId::frame_all, "View", "frame_all", "Frame all", GLFW_KEY_HOME, plain, "Home, Shift+F"},
    {CommandId::reset_camera, "View", "reset_camera", "Reset camera", GLFW_KEY_HOME, shift, "Shift+Home"},
    {CommandId::statistics, "View", "statistics", "Statistics", GLFW_KEY_F3, plain, "F3", true},
    {CommandId::code, "View", "code", "Code", GLFW_KEY_F4, plain, "F4"},
    {CommandId::measure, "View", "measure", "Speed and accuracy", GLFW_KEY_F6, plain, "F6"},
    {CommandId::shortcuts, "Help", "shortcuts", "Keys and mouse", GLFW_KEY_F1, plain, "F1"},
};

constexpr const char* menus[] = {"File", "Edit", "View", "Help"};

constexpr std::pair<const char*, const char*> mouse[] = {
    {"Click in the picture", "Select the shape, then the groups around it"},
    {"Left drag on the picture", "Orbit"},
    {"Middle drag, Shift + left drag", "Pan"},
    {"Wheel", "Zoom"},
    {"Drag a number", "Change it; Shift finer, Ctrl coarser"},
    {"Double-click or Ctrl-click a number", "Type it"},
    {"Right-click a value", "Back to its default"},
    {"Drag a node in the tree", "Re-order, or move into another"},
    {"Right-click a node", "What can be done with it"},
    {"Click a line of code", "Select its node; drag to select text"},
    {"Ctrl+Enter in custom code", "Compile it"},
};

bool is_on(const Ui& ui, CommandId id) {
    return (id == CommandId::statistics && ui.show_statistics) || (id == CommandId::code && ui.show_code) ||
           (id == CommandId::measure && ui.show_measure) || (id == CommandId::shortcuts && ui.show_shortcuts);
}

void view_entries(Ui& ui) {
    for (const ViewInfo& view : views()) {
        const std::string key = fmt::format("{}", static_cast<int>(view.view) + 1);
        if (ImGui::MenuItem(view.label, key.c_str(), ui.view == view.view)) ui.view = view.view;
        ui.report.item("menu/view", view.key);
        tooltip(ui, view.tip);
    }
}

/// What the menu's other end has: the one panel that is not always there.
bool code_switch(Ui& ui) {
    const float width = ImGui::CalcTextSize("Code").x + 2.0f * ImGui::GetStyle().ItemSpacing.x;
    const float left = ImGui::GetWindowWidth() - width;
    if (left < ImGui::GetCursorPosX()) return false;
    ImGui::SetCursorPosX(left);
    ImGui::PushStyleColor(ImGuiCol_Text, ui.show_code ? ui.theme.accent : ui.theme.text);
    const bool pressed = ImGui::MenuItem("Code");
    ImGui::PopStyleColor();
    ui.report.item("menu", "code");
    tooltip(ui, "The GLSL that the scene comes to, with the lines of what is selected", "F4");
    return pressed;
}

void table_line(const Ui& ui, const char* left, const char* right) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::PushStyleColor(ImGuiCol_Text, ui.theme.accent);
    ImGui::TextUnformatted(left);
    ImGui::PopStyleColor();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(right);
}

}  // namespace

std::optional<CommandId> command_for(const KeyPress& press) {
    const int modifiers = (press.ctrl ? ctrl : 0) | (press.shift ? shift : 0) | (press.alt ? alt : 0);
    if (press.key == 'Z' && modifiers == (ctrl | shift)) return CommandId::redo;
    if (press.key == 'F' && modifiers == shift) return CommandId::frame_all;
    if (press.key == 'A' && modifiers == shift) return CommandId::add;
    for (const Command& command : commands)
        if (command.key == press.key && command.modifiers == modifiers) return command.id;
    return std::nullopt;
}

std::optional<View> view_for(const KeyPress& press) {
    const int index = press.key - '1';
    if (press.ctrl || press.alt || press.shift || index < 0 || index >= static_cast<int>(views().size()))
        return std::nullopt;
    return views()[static_cast<std::size_t>(index)].view;
}

std::optional<CommandId> command_menus(Ui& ui, const std::function<bool(CommandId)>& enabled,
                                       const std::function<void(CommandId)>& below) {
    std::optional<CommandId> chosen;
    for (const char* menu : menus) {
        const bool open = ImGui::BeginMenu(menu);
        ui.report.item("menu", menu);
        if (!open) continue;
        if (std::strcmp(menu, "View") == 0) view_entries(ui);
        for (const Command& command : commands) {
            if (std::strcmp(command.menu, menu) != 0) continue;
            if (command.separated) ImGui::Separator();
            if (ImGui::MenuItem(command.label, command.key_text, is_on(ui, command.id), enabled(command.id)))
                chosen = command.id;
            ui.report.item(fmt::format("menu/{}", menu), command.name);
            below(command.id);
        }
        ImGui::EndMenu();
    }
    if (code_switch(ui)) chosen = CommandId::code;
    return chosen;
}

void shortcut_list(Ui& ui) {
    if (!ui.show_shortcuts) return;
    ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Appearing, {0.5f, 0.5f});
    if (ImGui::Begin(
            "Keys and mouse", &ui.show_shortcuts,
            ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoCollapse)) {
        if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_PadOuterX)) {
            for (const auto& [action, effect] : mouse) table_line(ui, action, effect);
            for (const Command& command : commands)
                if (command.key != 0) table_line(ui, command.key_text, command.label);
            table_line(ui, "1 ... 9", "Views, from Result to Step count");
            ImGui::EndTable();
        }
    }
    ImGui::End();
}

}  // namespace farfield
