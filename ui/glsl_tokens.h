// Splits a line of GLSL into what an editor colours alike.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace farfield {

enum class GlslToken { plain, keyword, type, number, function, comment };

/// A run of bytes of the line up to the start of the next, or to the line's end.
struct GlslRun {
    std::size_t start;
    GlslToken token;
};

/// Runs in order, the first at 0; empty for an empty line. Knows what generated code has: `//` comments and no other,
/// no preprocessor.
std::vector<GlslRun> glsl_runs(std::string_view line);

}  // namespace farfield
