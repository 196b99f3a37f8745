#include "sdf/custom_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <span>

namespace farfield {
namespace {

constexpr std::size_t largest_text = 64 * 1024;
constexpr std::size_t longest_name = 64;
// glslang, the compiler of the tree and the drivers' compilers recurse through expressions and nested statements.
constexpr int deepest_nesting = 64;
constexpr int longest_statement = 2000;
constexpr int most_alternatives = 200;

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)); }
bool is_word(char c) { return is_letter(c) || is_digit(c); }

/// Length of the UTF-8 sequence at the start of `text`, 0 where there is none.
std::size_t utf8_length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
    const unsigned first = byte(0);
    if (first < 0x80) return 1;
    const std::size_t length = first >= 0xc2 && first < 0xe0   ? 2
                               : first >= 0xe0 && first < 0xf0 ? 3
                               : first >= 0xf0 && first < 0xf5 ? 4
                                                               : 0;
    for (std::size_t i = 1; i < length; ++i)
        if ((byte(i) & 0xc0) != 0x80) return 0;
    if ((first == 0xe0 && byte(1) < 0xa0) || (first == 0xed && byte(1) >= 0xa0) || (first == 0xf0 && byte(1) < 0x90) ||
        (first == 0xf4 && byte(1) >= 0x90))
        return 0;
    return length;
}

using Words = std::span<const std::string_view>;

bool is_one_of(std::string_view word, Words words) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

/// GLSL words whose meaning does not belong into a distance function.
constexpr std::string_view refused_words[]{
    "discard",   "layout",     "shared",    "buffer",  "coherent",      "volatile", "restrict", "readonly", "writeonly",
    "attribute", "varying",    "flat",      "smooth",  "noperspective", "centroid", "patch",    "sample",   "invariant",
    "precise",   "subroutine", "precision", "highp",   "mediump",       "lowp",     "double",   "dvec2",    "dvec3",
    "dvec4",     "dmat2",      "dmat3",     "dmat4",   "dmat2x2",       "dmat2x3",  "dmat2x4",  "dmat3x2",  "dmat3x3",
    "dmat3x4",   "dmat4x2",    "dmat4x3",   "dmat4x4", "atomic_uint"};

constexpr std::string_view built_in_functions[]{"radians",
                                                "degrees",
                                                "sin",
                                                "cos",
                                                "tan",
                                                "asin",
                                                "acos",
                                                "atan",
                                                "sinh",
                                                "cosh",
                                                "tanh",
                                                "asinh",
                                                "acosh",
                                                "atanh",
                                                "pow",
                                                "exp",
                                                "log",
                                                "exp2",
                                                "log2",
                                                "sqrt",
                                                "inversesqrt",
                                                "abs",
                                                "sign",
                                                "floor",
                                                "trunc",
                                                "round",
                                                "roundEven",
                                                "ceil",
                                                "fract",
                                                "mod",
                                                "modf",
                                                "min",
                                                "max",
                                                "clamp",
                                                "mix",
                                                "step",
                                                "smoothstep",
                                                "isnan",
                                                "isinf",
                                                "floatBitsToInt",
                                                "floatBitsToUint",
                                                "intBitsToFloat",
                                                "uintBitsToFloat",
                                                "fma",
                                                "frexp",
                                                "ldexp",
                                                "length",
                                                "distance",
                                                "dot",
                                                "cross",
                                                "normalize",
                                                "faceforward",
                                                "reflect",
                                                "refract",
                                                "matrixCompMult",
                                                "outerProduct",
                                                "transpose",
                                                "determinant",
                                                "inverse",
                                                "lessThan",
                                                "lessThanEqual",
                                                "greaterThan",
                                                "greaterThanEqual",
                                                "equal",
                                                "notEqual",
                                                "any",
                                                "all",
                                                "not",
                                                "bitCount",
                                                "findLSB"};

/// Built-in functions that read or write something outside, or that depend on neighbouring pixels.
bool is_refused_function(std::string_view name) {
    constexpr std::string_view prefixes[]{"texture",   "texel",  "imageLoad",    "imageStore",    "imageAtomic",
                                          "imageSize", "atomic", "barrier",      "memoryBarrier", "groupMemoryBarrier",
                                          "dFd",       "fwidth", "interpolateAt"};
    return std::any_of(std::begin(prefixes), std::end(prefixes),
                       [&](std::string_view p) { return name.starts_with(p); });
}

bool is_opaque_type(std::string_view word) {
    if (word.starts_with("i") || word.starts_with("u")) {
        if (is_opaque_type(word.substr(1)) && !word.substr(1).starts_with("i") && !word.substr(1).starts_with("u"))
            return true;
    }
    for (const std::string_view start : {"sampler", "image"})
        if (word.starts_with(start))
            for (const std::string_view end : {"1D", "2D", "3D", "Cube", "Buffer"})
                if (word.substr(start.size()).starts_with(end)) return true;
    return false;
}

std::string_view trimmed(std::string_view text) {
    const auto space = [](char c) { return std::isspace(static_cast<unsigned char>(c)); };
    while (!text.empty() && space(text.front())) text.remove_prefix(1);
    while (!text.empty() && space(text.back())) text.remove_suffix(1);
    return text;
}

/// Takes a number from the front of `text`.
bool take_number(std::string_view& text, float& value) {
    const std::string copy(trimmed(text));
    char* end = nullptr;
    value = std::strtof(copy.c_str(), &end);
    text = trimmed(text).substr(static_cast<std::size_t>(end - copy.c_str()));
    return end != copy.c_str() && std::isfinite(value);
}

bool take(std::string_view& text, char c) {
    text = trimmed(text);
    if (text.empty() || text.front() != c) return false;
    text.remove_prefix(1);
    return true;
}

}  // namespace

CustomSource::CustomSource(std::string_view text, std::vector<CodeError>& errors) : errors_(errors) {
    if (text.size() > largest_text) {
        fail(1, fmt::format("the code has {} bytes, at most {} are allowed", text.size(), largest_text));
        return;
    }
    normalise(text);
    if (errors_.empty()) tokenise();
    if (errors_.empty()) check_words();
    if (errors_.empty()) check_nesting();
    if (errors_.empty()) read_declarations();
}

int CustomSource::lines() const { return std::max(1, static_cast<int>(std::count(text_.begin(), text_.end(), '\n'))); }

std::string_view CustomSource::word(std::size_t i) const {
    return i < tokens_.size() ? std::string_view(text_).substr(tokens_[i].start, tokens_[i].length)
                              : std::string_view();
}

/// Characters that GLSL takes for a line end or a continuation where a reader does not see one would let the compiler
/// see other code than this scanner does.
void CustomSource::normalise(std::string_view text) {
    int line = 1;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '\r' && i + 1 < text.size() && text[i + 1] == '\n') continue;
        if (c != '\n' && c != '\t' && (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)) {
            fail(line, fmt::format("holds a control character (code {})", static_cast<int>(c)));
            return;
        }
        if (c == '\\' && i + 1 < text.size() && (text[i + 1] == '\n' || text[i + 1] == '\r')) {
            fail(line, "a line must not end in a backslash");
            return;
        }
        if (c == '\n') ++line;
        text_ += c;
    }
    if (text_.empty() || text_.back() == '\\') {
        fail(line, text_.empty() ? "there is no code" : "a line must not end in a backslash");
        return;
    }
    if (text_.back() != '\n') text_ += '\n';
}

void CustomSource::tokenise() {
    const std::string_view text = text_;
    int line = 1;
    for (std::size_t i = 0; i < text.size();) {
        const char c = text[i];
        const std::size_t start = i;
        if (c == '\n') {
            ++line, ++i;
        } else if (c == ' ' || c == '\t') {
            ++i;
        } else if (text.substr(i, 2) == "//" || text.substr(i, 2) == "/*") {
            const bool block = text[i + 1] == '*';
            const std::size_t end = block ? text.find("*/", i + 2) : text.find('\n', i);
            if (end == text.npos) return fail(line, "this comment has no end");
            comments_.push_back({start, end - start, line});
            for (i += 2; i < end; i += utf8_length(text.substr(i))) {
                if (text[i] == '\n') ++line;
                if (utf8_length(text.substr(i)) == 0) return fail(line, "the comment is not valid UTF-8");
            }
            i = block ? end + 2 : end;
        } else if (is_letter(c)) {
            while (is_word(text[i])) ++i;
            const bool member = !tokens_.empty() && word(tokens_.size() - 1) == ".";
            tokens_.push_back({Kind::name, start, i - start, line, member});
        } else if (is_digit(c) || (c == '.' && is_digit(text[i + 1]))) {
            const bool hexadecimal = text.substr(i, 2) == "0x" || text.substr(i, 2) == "0X";
            for (++i; is_word(text[i]) || text[i] == '.'; ++i)
                if (!hexadecimal && (text[i] == 'e' || text[i] == 'E') && (text[i + 1] == '+' || text[i + 1] == '-'))
                    ++i;
            tokens_.push_back({Kind::number, start, i - start, line});
        } else if (std::string_view("+-*/%<>=!&|^~?:;,.()[]{}").find(c) != text.npos) {
            tokens_.push_back({Kind::symbol, start, 1, line});
            ++i;
        } else if (c == '#') {
            return fail(line, "preprocessor lines (#define, #if, ...) are not available");
        } else if (static_cast<unsigned char>(c) >= 0x80) {
            return fail(line, "only comments may hold letters beyond ASCII");
        } else {
            return fail(line, fmt::format("unexpected character {}", c));
        }
    }
}

void CustomSource::check_words() {
    for (std::size_t i = 0; i < tokens_.size() && errors_.size() < 20; ++i) {
        if (!is_name(i)) continue;
        const std::string_view w = word(i);
        const int line = tokens_[i].line;
        if (w.size() > longest_name)
            fail(line, fmt::format("the name {}... has more than {} letters", w.substr(0, 20), longest_name));
        else if (w == "while" || w == "do")
            fail(line, fmt::format("{} loops are not available; use for with a known number of steps", w));
        else if (w.starts_with("gl_") || w.starts_with("GL_"))
            fail(line, fmt::format("{} is not available in distance code", w));
        else if (w.find("__") != w.npos)
            fail(line, fmt::format("{}: names with two underscores in a row belong to GLSL", w));
        else if (is_one_of(w, refused_words) || is_opaque_type(w))
            fail(line, fmt::format("{} is not available in distance code", w));
        else if (word(i + 1) == "(" && is_refused_function(w))
            fail(line, fmt::format("the function {} is not available in distance code", w));
    }
}

void CustomSource::check_nesting() {
    std::vector<std::size_t> open;
    int statement = 0, alternatives = 0;
    for (std::size_t i = 0; i < tokens_.size(); ++i) {
        const std::string_view w = word(i);
        const int line = tokens_[i].line;
        if (w == "(" || w == "[" || w == "{") {
            open.push_back(i);
            if (open.size() > deepest_nesting)
                return fail(line, fmt::format("more than {} brackets inside one another", deepest_nesting));
        } else if (w == ")" || w == "]" || w == "}") {
            const char wanted = w == ")" ? '(' : w == "]" ? '[' : '{';
            if (open.empty()) return fail(line, fmt::format("this {} closes nothing", w));
            if (word(open.back())[0] != wanted)
                return fail(line,
                            fmt::format("this {} meets the {} of line {}", w, word(open.back()), line_of(open.back())));
            open.pop_back();
        }
        if (w == "else" && ++alternatives > most_alternatives)
            return fail(line, fmt::format("more than {} times else in a function", most_alternatives));
        if (open.empty()) alternatives = 0;
        const bool ends = w == "}" || w == "{" || (w == ";" && (open.empty() || word(open.back()) == "{"));
        statement = ends ? 0 : statement + 1;
        if (statement > longest_statement)
            return fail(line, fmt::format("a statement of more than {} words and signs", longest_statement));
    }
    if (!open.empty()) fail(line_of(open.back()), fmt::format("this {} is never closed", word(open.back())));
}

std::size_t CustomSource::skip_brackets(std::size_t at) const {
    int depth = 0;
    for (; at < tokens_.size(); ++at) {
        const std::string_view w = word(at);
        if (w == "(" || w == "[" || w == "{") ++depth;
        if ((w == ")" || w == "]" || w == "}") && --depth == 0) return at + 1;
    }
    return at;
}

/// The next `end` outside of brackets.
std::size_t CustomSource::skip_to(std::size_t at, std::string_view end) const {
    while (at < tokens_.size() && word(at) != end) {
        const std::string_view w = word(at);
        at = w == "(" || w == "[" || w == "{" ? skip_brackets(at) : at + 1;
    }
    return at;
}

void CustomSource::read_declarations() {
    for (std::size_t at = 0; at < tokens_.size() && errors_.size() < 20;) {
        const std::string_view w = word(at);
        if (w == ";")
            ++at;
        else if (w == "struct")
            at = read_structure(at);
        else if (w == "uniform")
            at = read_uniform(at);
        else if (w == "const")
            at = read_constants(at);
        else
            at = read_function(at);
    }
    for (CustomUniform& uniform : uniforms_) describe(uniform);
}

std::size_t CustomSource::read_structure(std::size_t at) {
    const std::size_t name = at + 1, body = at + 2;
    if (!is_name(name) || word(body) != "{") {
        fail(line_of(at), "expected a structure as struct Name { ... };");
        return tokens_.size();
    }
    globals_.emplace(word(name));
    const std::size_t end = skip_brackets(body);
    bool type = true;  // the first name of a member's declaration is its type, the others outside of brackets its names
    for (std::size_t i = body + 1; i + 1 < end;) {
        if (word(i) == "[") {
            i = skip_brackets(i);
            continue;
        }
        if (is_name(i)) tokens_[i].member = !type, type = false;
        if (word(i) == ";") type = true;
        ++i;
    }
    if (word(end) != ";") fail(line_of(end - 1), "expected ; after the structure");
    return end + 1;
}

std::size_t CustomSource::read_uniform(std::size_t at) {
    const std::size_t end = skip_to(at, ";");
    CustomUniform uniform;
    uniform.type = word(at + 1);
    uniform.name = word(at + 2);
    uniform.line = line_of(at);
    uniform.tokens = {at, end};
    uniform.name_token = at + 2;
    constexpr std::string_view types[]{"float", "int", "bool", "vec3", "ivec3", "bvec3"};
    if (end == tokens_.size() || !is_name(at + 2) || (word(at + 3) != "=" && word(at + 3) != ";"))
        fail(uniform.line, "expected a parameter as uniform float name = 0.5;");
    else if (!is_one_of(uniform.type, types))
        fail(uniform.line,
             fmt::format("a parameter is a float, int, bool, vec3, ivec3 or bvec3, not a {}", uniform.type));
    else if (!globals_.insert(uniform.name).second)
        fail(uniform.line, fmt::format("the name {} is used twice", uniform.name));
    else if (uniforms_.size() == most_uniforms)
        fail(uniform.line, fmt::format("more than {} parameters", most_uniforms));
    else
        uniforms_.push_back(std::move(uniform));
    return end + 1;
}

std::size_t CustomSource::read_constants(std::size_t at) {
    const std::size_t end = skip_to(at, ";");
    std::size_t name = at + 2;  // after const and the type
    while (name < end && word(name) == "[") name = skip_brackets(name);
    if (is_name(name) && word(name + 1) == "(") return read_function(at + 1);  // a function with a const result
    while (name < end) {
        if (!is_name(name)) {
            fail(line_of(at), "expected a constant as const float name = 1.0;");
            break;
        }
        globals_.emplace(word(name));
        name = skip_to(name, ",") < end ? skip_to(name, ",") + 1 : end;
    }
    return end + 1;
}

std::size_t CustomSource::read_function(std::size_t at) {
    std::size_t name = at + 1;
    while (word(name) == "[") name = skip_brackets(name);
    if (is_name(at) && is_name(name) && word(name + 1) == "(") {
        const std::string_view n = word(name);
        if (is_one_of(n, built_in_functions))
            fail(line_of(name), fmt::format("{} is a function of GLSL; take another name", n));
        if (n == "main") fail(line_of(name), "the name main is taken; the entry is float sdf(vec3 p)");
        globals_.emplace(n);
        const std::size_t after = skip_brackets(name + 1);
        if (word(after) == "{") return skip_brackets(after);
        if (word(after) == ";") return after + 1;
        fail(line_of(after), fmt::format("expected {{ after the parameters of {}", n));
        return tokens_.size();
    }
    if (is_name(at) && is_name(name) &&
        (word(name + 1) == "=" || word(name + 1) == ";" || word(name + 1) == "," || word(name + 1) == "["))
        fail(line_of(at), fmt::format("{} is a global variable; make it const or uniform", word(name)));
    else
        fail(line_of(at), fmt::format("expected a function, a constant, a structure or a uniform, found {}", word(at)));
    return tokens_.size();
}

/// The comment that follows a token on its line.
std::string_view CustomSource::comment_after(std::size_t token) const {
    const Token& t = tokens_[token];
    for (const Comment& c : comments_)
        if (c.start > t.start && c.line == t.line &&
            (token + 1 == tokens_.size() || tokens_[token + 1].start > c.start))
            return std::string_view(text_).substr(c.start + 2, c.length - 2);
    return {};
}

/// From the comment "[0, 2] m Radius of the ball": range, unit and tip, each optional.
void CustomSource::describe(CustomUniform& uniform) {
    std::string_view rest = trimmed(comment_after(uniform.tokens.last));
    if (take(rest, '[')) {
        uniform.has_range = take_number(rest, uniform.minimum) && take(rest, ',') &&
                            take_number(rest, uniform.maximum) && take(rest, ']');
        if (!uniform.has_range || !(uniform.minimum < uniform.maximum)) {
            fail(uniform.line, fmt::format("{}: expected a range as [0, 2] after the declaration", uniform.name));
            return;
        }
        rest = trimmed(rest);
    }
    const std::size_t space = std::min(rest.find_first_of(" \t\n"), rest.size());
    const std::string_view unit = rest.substr(0, space);
    if (unit == "m") uniform.unit = Unit::metres;
    if (unit == "°" || unit == "deg") uniform.unit = Unit::degrees;
    if (unit == "°/m" || unit == "deg/m") uniform.unit = Unit::degrees_per_metre;
    if (uniform.unit != Unit::none) rest = trimmed(rest.substr(space));
    uniform.tip = rest;
    std::replace(uniform.tip.begin(), uniform.tip.end(), '\n', ' ');
    if (!uniform.tip.empty()) return;
    uniform.tip = uniform.name;
    std::replace(uniform.tip.begin(), uniform.tip.end(), '_', ' ');
}

int CustomSource::first_line(std::string_view name) const {
    for (std::size_t i = 0; i < tokens_.size(); ++i)
        if (word(i) == name) return tokens_[i].line;
    return 1;
}

Names CustomSource::foreign_names() const {
    Names names;
    for (std::size_t i = 0; i < tokens_.size(); ++i)
        if (is_name(i) && !tokens_[i].member && !globals_.contains(word(i))) names.emplace(word(i));
    return names;
}

std::string CustomSource::renamed(const Names& names, std::string_view suffix,
                                  const std::vector<std::string>& declarations) const {
    const std::string end = fmt::format("_{}", suffix);
    const auto name = [&](std::size_t i) {
        const std::string_view w = word(i);
        const bool changes = is_name(i) && !tokens_[i].member && (names.contains(w) || w.ends_with(end));
        return changes ? std::string(w) + end : std::string(w);
    };
    std::string result;
    std::size_t copied = 0, next_uniform = 0;
    for (std::size_t i = 0; i < tokens_.size(); ++i) {
        result.append(text_, copied, tokens_[i].start - copied);
        copied = tokens_[i].start + tokens_[i].length;
        if (next_uniform < declarations.size() && i == uniforms_[next_uniform].tokens.first) {
            const CustomUniform& uniform = uniforms_[next_uniform];
            const Token& last = tokens_[uniform.tokens.last];
            const std::string& declaration = declarations[next_uniform++];
            const std::size_t hole = declaration.find("{}");
            result += declaration.substr(0, hole) + name(uniform.name_token) + declaration.substr(hole + 2);
            copied = last.start + last.length;
            result.append(static_cast<std::size_t>(last.line - tokens_[i].line), '\n');
            i = uniform.tokens.last;
        } else {
            result += name(i);
        }
    }
    return result.append(text_, copied);
}

}  // namespace farfield
