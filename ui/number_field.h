// One number to drag or to type. Nothing changes before the mouse has moved or the text was accepted: a double-click
// that opens the text, and Escape that closes it, leave the number and the list of undo steps as they were.
#pragma once

#include "sdf/parameter.h"
#include "ui/ui.h"

#include <optional>
#include <string>
#include <string_view>

namespace farfield {

/// What a slider shows; values outside can still be typed.
struct SliderRange {
    float low, high;
    bool logarithmic = false;
};

/// Of the next item's width, a slider with a range and a drag field without. True when `value` was changed; the limits
/// of the parameter are left to the caller. `full` gets the whole number where the field has room for less.
bool number_field(Ui& ui, const char* label, const Parameter& parameter, float& value, std::string_view unit,
                  const SliderRange* range, std::string* full = nullptr);

/// What someone typed, a number or arithmetic, with or without the unit; nothing when that is neither.
std::optional<float> typed_number(std::string_view text, std::string_view unit);

}  // namespace farfield
