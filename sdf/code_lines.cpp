#include "sdf/code_lines.h"

#include <fmt/format.h>

#include <algorithm>

namespace farfield {

std::string literal(float v) {
    std::string text = fmt::format("{}", v == 0.0f ? 0.0f : v);  // no negative zero
    if (text.find_first_of(".e") == std::string::npos) text += ".0";
    return text;
}

std::string literal(glm::vec3 v) {
    if (v.x == v.y && v.y == v.z) return fmt::format("vec3({})", literal(v.x));
    return fmt::format("vec3({}, {}, {})", literal(v.x), literal(v.y), literal(v.z));
}

std::string literal(const glm::mat3& m) {
    std::string text = "mat3(";
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) text += literal(m[column][row]) + (column == 2 && row == 2 ? ")" : ", ");
    return text;
}

void CodeLines::add(const std::string& code, Id node, const std::string& comment) {
    const std::size_t column = 72;
    const bool blank = code.find_first_not_of(' ') == std::string::npos;
    std::string line = names.in(code);
    if (!comment.empty()) {
        if (!blank) line += std::string(line.size() < column ? column - line.size() : 1, ' ') + " ";
        line += "// " + comment;
        std::replace(line.begin(), line.end(), '\\', '/');  // at the end of a line it would continue the comment
    }
    text += line + "\n";
    if (!blank) key += code + "\n";
    nodes.push_back(node);
}

void CodeLines::add_as_it_is(const std::string& in_text, const std::string& in_key, Id node) {
    const std::string whole = in_text + (in_text.ends_with('\n') ? "" : "\n");
    text += whole;
    key += in_key + "\n";
    nodes.insert(nodes.end(), static_cast<std::size_t>(std::count(whole.begin(), whole.end(), '\n')), node);
}

void CodeLines::add_for_cells(const std::string& indent, const std::string& cells, bool written_out, Id node,
                              const std::function<std::vector<std::string>(const std::string& cell)>& of) {
    const auto add_block = [&](const std::string& head, const std::string& cell) {
        const std::vector<std::string> lines = of(cell);
        if (lines.size() == 1) return add(indent + head + lines.front(), node);
        add(indent + head + "{", node);
        for (const std::string& line : lines) add(indent + "    " + line, node);
        add(indent + "}", node);
    };
    if (!written_out) return add_block(fmt::format("for (int cell = 0; cell < {}; ++cell) ", cells), "cell");
    for (int cell = 0; cell < std::stoi(cells); ++cell) add_block("", std::to_string(cell));
}

void CodeLines::append(const CodeLines& other) {
    text += other.text;
    key += other.key;
    nodes.insert(nodes.end(), other.nodes.begin(), other.nodes.end());
}

}  // namespace farfield
