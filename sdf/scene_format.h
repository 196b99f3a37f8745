// What reader, writer and documentation of scene files share beyond the tables of node_kinds and fields.
#pragma once

#include "sdf/scene_file.h"

namespace farfield::format {

inline constexpr int version = 1;

// The top-level keys, in the order of writing.
inline constexpr const char* schema = "$schema";
inline constexpr const char* version_key = "farfield";
inline constexpr const char* camera = "camera";
inline constexpr const char* bookmarks = "bookmarks";
inline constexpr const char* settings = "settings";
inline constexpr const char* sky = "sky";
inline constexpr const char* materials = "materials";
inline constexpr const char* lights = "lights";
inline constexpr const char* definitions = "definitions";
inline constexpr const char* root = "root";

// Keys of a node (and `kind` of a light) beside its parameters.
inline constexpr const char* kind = "kind";
inline constexpr const char* name = "name";
inline constexpr const char* of = "of";  ///< of an instance: the name of its definition
inline constexpr const char* material = "material";
inline constexpr const char* hidden = "hidden";
inline constexpr const char* locked = "locked";
inline constexpr const char* children = "children";
inline constexpr const char* code = "code";  ///< of a custom node

/// A file beyond this is refused unread: some fifty thousand nodes, far more than any program can be generated from.
inline constexpr std::size_t largest_file = 8'000'000;

/// Different texts of custom code in one file: each is compiled to be checked, which takes some milliseconds.
inline constexpr std::size_t most_codes = 256;

}  // namespace farfield::format
