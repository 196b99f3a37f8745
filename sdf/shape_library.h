// The functions of shapes.glsl and operations.glsl, one by one, so that a program gets only those that it calls.
#pragma once

#include <string>
#include <string_view>

namespace farfield {

/// The functions of shapes.glsl that `code` calls, directly or through each other, in the files' order and with their
/// comments, each followed by an empty line.
std::string used_shapes(std::string_view code);

/// Whether one of them has this name.
bool is_shape(std::string_view name);

}  // namespace farfield
