// Everything about what is selected, made from the tables of node_kinds and fields.
#pragma once

#include "ui/ui.h"

namespace farfield {

Edits inspector_panel(Ui& ui, const Scene& scene);

}  // namespace farfield
