// One row of an inspector: label, editable value, unit. Made from the Parameter alone, so every object of the scene is
// edited in the same way: drag to change (Shift: fine, Ctrl: coarse), double-click or Ctrl-click to type, right-click
// for the default.
#pragma once

#include "sdf/parameter.h"
#include "ui/number_field.h"

#include <optional>

namespace farfield {

/// The new value when it was changed, in the parameter's limits. `panel` prefixes the name in the report. With a range
/// one-component numbers become sliders.
std::optional<glm::vec3> value_row(Ui& ui, const char* panel, const Parameter& parameter, glm::vec3 value,
                                   const SliderRange* range = nullptr);

/// Puts a label into the left column and the cursor into the right one, with the next item as wide as that.
void row_label(const Ui& ui, std::string_view label, bool bright, std::string_view unit = {});

/// All values of an object, one row each, from parameter `first` on and `count` of them at most.
void value_rows(Ui& ui, const char* panel, const Scene& scene, ObjectRef object, Edits& edits, std::size_t first = 0,
                std::size_t count = ~std::size_t{0});

/// Linear radiance as a colour to draw: scaled into 0..1 when brighter, then sRGB-encoded.
ImVec4 display_color(glm::vec3 linear);

}  // namespace farfield
