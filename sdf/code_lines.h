// Generated code as it grows: lines of GLSL, and numbers as they stand in them.
#pragma once

#include "sdf/code_names.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <functional>
#include <string>
#include <vector>

namespace farfield {

/// As GLSL that reads back to the same bits; a vector of equal components as one.
std::string literal(float v);
std::string literal(glm::vec3 v);
std::string literal(const glm::mat3& m);

/// Lines of code with the nodes they belong to; the key gathers the code alone.
struct CodeLines {
    const CodeNames& names;
    std::string text = {};
    std::string key = {};
    std::vector<Id> nodes = {};

    void add(const std::string& code, Id node = 0, const std::string& comment = {});
    /// Text and key of several lines of the user's own, in which @ means nothing.
    void add_as_it_is(const std::string& in_text, const std::string& in_key, Id node);
    /// The lines that `of` gives for the number of each of so many cells (a number or an expression): in a loop, or one
    /// after the other if `written_out`.
    void add_for_cells(const std::string& indent, const std::string& cells, bool written_out, Id node,
                       const std::function<std::vector<std::string>(const std::string& cell)>& of);
    void append(const CodeLines& other);
};

}  // namespace farfield
