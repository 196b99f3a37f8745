#include "app/editor_commands.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <utility>
#include <vector>

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
    {CommandId::cut, "Edit", "cut", "Cut", 'X', ctrl, "Ctrl+X", true},
    {CommandId::copy, "Edit", "copy", "Copy", 'C', ctrl, "Ctrl+C"},
    {CommandId::paste, "Edit", "paste", "Paste", 'V', ctrl, "Ctrl+V"},
    {CommandId::add, "Edit", "add", "Add...", 'A', plain, "A, Shift+A", true},
    {CommandId::duplicate, "Edit", "duplicate", "Duplicate", 'D', ctrl, "Ctrl+D"},
    {CommandId::rename, "Edit", "rename", "Rename", GLFW_KEY_F2, plain, "F2"},
    {CommandId::remove, "Edit", "delete", "Delete", GLFW_KEY_DELETE, plain, "Del"},
    {CommandId::select_all, "Edit", "select_all", "Select all", 'A', ctrl, "Ctrl+A", true},
    {CommandId::search, "Edit", "search", "Search the tree", 'F', ctrl, "Ctrl+F"},
    {CommandId::group, "Node", "group", "Group", 'G', ctrl, "Ctrl+G"},
    {CommandId::dissolve, "Node", "dissolve", "Dissolve", 'G', ctrl | shift, "Ctrl+Shift+G"},
    {CommandId::move_up, "Node", "move_up", "Move up", GLFW_KEY_UP, alt, "Alt+Up", true},
    {CommandId::move_down, "Node", "move_down", "Move down", GLFW_KEY_DOWN, alt, "Alt+Down"},
    {CommandId::hide, "Node", "hide", "Hide or show", 'H', plain, "H", true},
    {CommandId::show_only, "Node", "show_only", "Show only this, or all again", 'H', shift, "Shift+H"},
    {CommandId::show_everything, "Node", "show_everything", "Show everything", 'H', alt, "Alt+H"},
    {CommandId::lock, "Node", "lock", "Lock or unlock", 'L', plain, "L"},
    {CommandId::make_definition, "Node", "make_definition", "Make definition", 'I', ctrl, "Ctrl+I", true},
    {CommandId::make_independent, "Node", "make_independent", "Make independent", 'I', ctrl | shift, "Ctrl+Shift+I"},
    {CommandId::select, "Tools", "select", "No handles", 'Q', plain, "Q"},
    {CommandId::move, "Tools", "move", "Move", 'W', plain, "W"},
    {CommandId::rotate, "Tools", "rotate", "Rotate", 'E', plain, "E"},
    {CommandId::scale, "Tools", "scale", "Scale", 'R', plain, "R"},
    {CommandId::axes, "Tools", "axes", "Local axes", 'X', plain, "X", true},
    {CommandId::lights, "Tools", "lights", "Signs of lights", 'L', shift, "Shift+L", true},
    {CommandId::grid, "Tools", "grid", "Grid and axes", 'G', plain, "G"},
    {CommandId::split, "Tools", "split", "Split view", 'V', plain, "V"},
    {CommandId::frame_selection, "View", "frame_selection", "Frame selection", 'F', plain, "F", true},
    {CommandId::frame_all, "View", "frame_all", "Frame all", GLFW_KEY_HOME, plain, "Home, Shift+F"},
    {CommandId::reset_camera, "View", "reset_camera", "Reset camera", GLFW_KEY_HOME, shift, "Shift+Home"},
    {CommandId::bookmark, "View", "bookmark", "Bookmark this view", 'B', ctrl, "Ctrl+B", true},
    {CommandId::front, "View", "front", "From the front", GLFW_KEY_KP_1, plain, "Numpad 1", true},
    {CommandId::back, "View", "back", "From the back", GLFW_KEY_KP_1, ctrl, "Ctrl+Numpad 1"},
    {CommandId::right, "View", "right", "From the right", GLFW_KEY_KP_3, plain, "Numpad 3"},
    {CommandId::left, "View", "left", "From the left", GLFW_KEY_KP_3, ctrl, "Ctrl+Numpad 3"},
    {CommandId::top, "View", "top", "From above", GLFW_KEY_KP_7, plain, "Numpad 7"},
    {CommandId::bottom, "View", "bottom", "From below", GLFW_KEY_KP_7, ctrl, "Ctrl+Numpad 7"},
    {CommandId::history, "View", "history", "History", 'H', ctrl, "Ctrl+H", true},
    {CommandId::statistics, "View", "statistics", "Statistics", GLFW_KEY_F3, plain, "F3"},
    {CommandId::code, "View", "code", "Code", GLFW_KEY_F4, plain, "F4"},
    {CommandId::measure, "View", "measure", "Speed and accuracy", GLFW_KEY_F6, plain, "F6"},
    {CommandId::shortcuts, "Help", "shortcuts", "Keys and mouse", GLFW_KEY_F1, plain, "F1"},
};

constexpr const char* menus[] = {"File", "Edit", "Node", "View", "Tools", "Help"};

constexpr std::pair<const char*, const char*> mouse[] = {
    {"Click in the picture", "Select the shape, then the groups around it; Ctrl adds or takes out"},
    {"Ctrl-click, Shift-click in the tree", "Add to the selection or take out, select a range"},
    {"Left drag on the picture", "Orbit around what is under the mouse"},
    {"Middle drag, Shift + left drag", "Pan"},
    {"Wheel", "Zoom to what is under the mouse"},
    {"Right drag with W A S D, Q E", "Fly; the wheel sets the speed"},
    {"Drag a handle", "Move, turn or scale; Ctrl in steps, Escape takes it back"},
    {"Drag a number", "Change it; Shift finer, Ctrl coarser, Escape leaves it as it was"},
    {"Double-click or Ctrl-click a number", "Type it, or arithmetic as 2*(1+.5)"},
    {"Right-click a value", "Back to its default"},
    {"Drag a node in the tree", "Re-order, or move into another"},
    {"Right-click a node or a material", "What can be done with it"},
    {"Drag a material", "Onto a shape in the picture or the tree: it has it then"},
    {"Click a line of code", "Select its node; drag to select text"},
    {"Ctrl+Enter in custom code", "Compile it"},
};

bool is_on(const Ui& ui, CommandId id) {
    return (id == CommandId::statistics && ui.show_statistics) || (id == CommandId::code && ui.show_code) ||
           (id == CommandId::history && ui.show_history) || (id == CommandId::measure && ui.show_measure) ||
           (id == CommandId::select && ui.tools.tool == Tool::none) ||
           (id == CommandId::move && ui.tools.tool == Tool::move) ||
           (id == CommandId::rotate && ui.tools.tool == Tool::rotate) ||
           (id == CommandId::scale && ui.tools.tool == Tool::scale) ||
           (id == CommandId::axes && ui.tools.axes == Axes::local) || (id == CommandId::lights && ui.tools.lights) ||
           (id == CommandId::grid && ui.tools.grid) || (id == CommandId::split && ui.tools.split.on) ||
           (id == CommandId::shortcuts && ui.show_shortcuts);
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

std::optional<std::size_t> bookmark_for(const KeyPress& press) {
    if (!press.ctrl || press.alt || press.shift || press.key < '1' || press.key > '9') return std::nullopt;
    return static_cast<std::size_t>(press.key - '1');
}

bool choose_tool(PictureTools& tools, CommandId id) {
    switch (id) {
        case CommandId::select:
            tools.tool = Tool::none;
            return true;
        case CommandId::move:
            tools.tool = Tool::move;
            return true;
        case CommandId::rotate:
            tools.tool = Tool::rotate;
            return true;
        case CommandId::scale:
            tools.tool = Tool::scale;
            return true;
        case CommandId::axes:
            tools.axes = tools.axes == Axes::local ? Axes::world : Axes::local;
            return true;
        case CommandId::lights:
            tools.lights = !tools.lights;
            return true;
        case CommandId::grid:
            tools.grid = !tools.grid;
            return true;
        case CommandId::split:
            tools.split.on = !tools.split.on;
            return true;
        default:
            return false;
    }
}

glm::vec3 view_direction(CommandId id) {
    switch (id) {
        case CommandId::front:
            return {0.0f, 0.0f, -1.0f};
        case CommandId::back:
            return {0.0f, 0.0f, 1.0f};
        case CommandId::right:
            return {-1.0f, 0.0f, 0.0f};
        case CommandId::left:
            return {1.0f, 0.0f, 0.0f};
        case CommandId::top:
            return {0.0f, -1.0f, 0.0f};
        case CommandId::bottom:
            return {0.0f, 1.0f, 0.0f};
        default:
            return {};
    }
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
    std::vector<std::pair<const char*, const char*>> lines(std::begin(mouse), std::end(mouse));
    for (const Command& command : commands)
        if (command.key != 0) lines.emplace_back(command.key_text, command.label);
    lines.emplace_back("1 ... 9", "Views, from Result to Step count");
    lines.emplace_back("Ctrl+1 ... Ctrl+9", "Go to a bookmark of the camera");
    // As many columns as the window's height asks for.
    const float line = ImGui::GetTextLineHeight() + 2.0f * ImGui::GetStyle().CellPadding.y;
    const float room = std::max(0.8f * ImGui::GetMainViewport()->WorkSize.y, line);
    const int columns = 1 + static_cast<int>(static_cast<float>(lines.size()) * line / room);
    const std::size_t rows = (lines.size() + static_cast<std::size_t>(columns) - 1) / static_cast<std::size_t>(columns);
    ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Appearing, {0.5f, 0.5f});
    if (ImGui::Begin(
            "Keys and mouse", &ui.show_shortcuts,
            ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoCollapse)) {
        if (ImGui::BeginTable("keys", 2 * columns, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_PadOuterX)) {
            for (std::size_t i = 0; i < rows * static_cast<std::size_t>(columns); ++i) {
                ImGui::TableNextColumn();
                const std::size_t index =
                    i % static_cast<std::size_t>(columns) * rows + i / static_cast<std::size_t>(columns);
                const auto [key, effect] = index < lines.size() ? lines[index] : std::pair("", "");
                ImGui::PushStyleColor(ImGuiCol_Text, ui.theme.accent);
                ImGui::TextUnformatted(key);
                ImGui::PopStyleColor();
                ImGui::TableNextColumn();
                ImGui::TextUnformatted(effect);
            }
            ImGui::EndTable();
        }
    }
    ImGui::End();
}

}  // namespace farfield
