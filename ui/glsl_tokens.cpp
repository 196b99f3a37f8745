#include "ui/glsl_tokens.h"

#include <algorithm>

namespace farfield {
namespace {

constexpr std::string_view keywords[] = {"break", "const", "continue", "else",   "false",  "for",
                                         "if",    "in",    "inout",    "out",    "return", "struct",
                                         "true",  "while", "uniform",  "switch", "case",   "default"};
constexpr std::string_view types[] = {"bool", "float", "int",   "ivec2", "ivec3", "ivec4", "mat2", "mat3", "mat4",
                                      "uint", "uvec2", "uvec3", "uvec4", "vec2",  "vec3",  "vec4", "void"};

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_word(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || is_digit(c); }

template <std::size_t count>
bool holds(const std::string_view (&list)[count], std::string_view word) {
    return std::find(std::begin(list), std::end(list), word) != std::end(list);
}

/// The end of the number that starts at `at`, with fraction, exponent and suffix.
std::size_t number_end(std::string_view line, std::size_t at) {
    for (; at < line.size(); ++at) {
        const bool signed_exponent =
            (line[at] == '+' || line[at] == '-') && (line[at - 1] == 'e' || line[at - 1] == 'E');
        if (!is_word(line[at]) && line[at] != '.' && !signed_exponent) break;
    }
    return at;
}

}  // namespace

std::vector<GlslRun> glsl_runs(std::string_view line) {
    std::vector<GlslRun> runs;
    const auto add = [&](std::size_t start, GlslToken token) {
        if (runs.empty() || runs.back().token != token) runs.push_back({start, token});
    };
    for (std::size_t at = 0; at < line.size();) {
        if (line.substr(at, 2) == "//") {
            add(at, GlslToken::comment);
            break;
        }
        if (is_digit(line[at]) || (line[at] == '.' && at + 1 < line.size() && is_digit(line[at + 1]))) {
            add(at, GlslToken::number);
            at = number_end(line, at);
        } else if (is_word(line[at])) {
            const std::size_t start = at;
            while (at < line.size() && is_word(line[at])) ++at;
            const std::string_view word = line.substr(start, at - start);
            add(start, holds(keywords, word)                 ? GlslToken::keyword
                       : holds(types, word)                  ? GlslToken::type
                       : at < line.size() && line[at] == '(' ? GlslToken::function
                                                             : GlslToken::plain);
        } else {
            add(at, GlslToken::plain);
            ++at;
        }
    }
    return runs;
}

}  // namespace farfield
