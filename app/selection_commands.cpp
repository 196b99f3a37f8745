#include "app/selection_commands.h"

#include "ui/tree_edits.h"

namespace farfield {

std::optional<Edits> edits_for(CommandId command, const Scene& scene, const Selection& selection) {
    switch (command) {
        case CommandId::duplicate:
            return duplicate_selection(scene, selection);
        case CommandId::remove:
            return delete_selection(scene, selection);
        case CommandId::make_definition:
            return define_selection(scene, selection);
        case CommandId::make_independent:
            return free_selection(scene, selection);
        case CommandId::move_up:
            return shift_selection(scene, selection, -1);
        case CommandId::move_down:
            return shift_selection(scene, selection, 1);
        case CommandId::group:
            return group_selection(scene, selection);
        case CommandId::dissolve:
            return dissolve_selection(scene, selection);
        case CommandId::hide:
            return hide_selection(scene, selection);
        case CommandId::show_only:
            return show_only_selection(scene, selection);
        case CommandId::show_everything:
            return show_everything(scene);
        case CommandId::lock:
            return lock_selection(scene, selection);
        default:
            return std::nullopt;
    }
}

}  // namespace farfield
