// What the menus and the keyboard can ask for, in one table: menus, shortcuts and the list on F1 read it.
#pragma once

#include "app/input_queue.h"
#include "ui/ui.h"

#include <glm/vec3.hpp>

#include <functional>
#include <optional>

namespace farfield {

enum class CommandId {
    create,
    open,
    save,
    save_as,
    export_picture,
    recover,
    quit,
    undo,
    redo,
    add,
    duplicate,
    rename,
    remove,
    cut,
    copy,
    paste,
    select_all,
    search,
    group,
    dissolve,
    hide,
    show_only,
    show_everything,
    lock,
    move_up,
    move_down,
    make_definition,
    make_independent,
    frame_selection,
    frame_all,
    reset_camera,
    bookmark,
    front,
    back,
    right,
    left,
    top,
    bottom,
    select,
    move,
    rotate,
    scale,
    axes,
    lights,
    grid,
    split,
    history,
    code,
    measure,
    statistics,
    shortcuts,
};

/// The command on a key, if any.
std::optional<CommandId> command_for(const KeyPress& press);
/// The view on a number key, if any.
std::optional<View> view_for(const KeyPress& press);
/// Which bookmark is on a number key with Ctrl, from 0.
std::optional<std::size_t> bookmark_for(const KeyPress& press);

/// What a command of the menu Tools makes of the tools; false for other commands.
bool choose_tool(PictureTools& tools, CommandId id);

/// The way that one of the standard views looks; nothing for other commands.
glm::vec3 view_direction(CommandId id);

/// Draws the menus inside an open menu bar. `enabled` says what can be done now.
/// `below` draws what a menu has below a command beside the table's entries.
std::optional<CommandId> command_menus(Ui& ui, const std::function<bool(CommandId)>& enabled,
                                       const std::function<void(CommandId)>& below);

/// The window that lists keys and mouse, while ui.show_shortcuts.
void shortcut_list(Ui& ui);

}  // namespace farfield
