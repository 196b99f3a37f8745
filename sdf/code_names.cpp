#include "sdf/code_names.h"

#include "sdf/shape_library.h"

#include <fmt/format.h>

namespace farfield {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }
char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// Of ASCII letters and digits with single underscores between; no keyword of the language begins so.
std::string snake_case(const std::string& text) {
    constexpr std::size_t longest = 40;
    std::string name;
    for (const char c : text.substr(0, longest)) {
        if (is_letter(c) || is_digit(c))
            name += c;
        else if (!name.empty() && name.back() != '_')
            name += '_';
    }
    if (!name.empty() && name.back() == '_') name.pop_back();
    if (name.empty()) return "part";
    return is_digit(name[0]) || name.starts_with("gl_") ? "part_" + name : name;
}

/// Of ASCII letters and digits alone; begins with a capital. One capital alone might be the end of a name in capitals.
std::string camel_case(const std::string& text) {
    constexpr std::size_t longest = 32;
    std::string name;
    bool begins = true;
    for (const char c : text) {
        if (is_letter(c) || (is_digit(c) && !name.empty())) {
            name += begins ? upper(c) : lower(c);
            begins = is_digit(c);
        } else if (static_cast<unsigned char>(c) < 0x80) {
            begins = true;
        }
        if (name.size() == longest) break;
    }
    return name.size() < 2 ? name + "Custom" : name;
}

}  // namespace

CodeNames::CodeNames(const FieldTree& tree) {
    add_definitions(tree);
    std::set<std::string> taken;
    for (const FieldNode& definition : tree.definitions) add_customs(definition, taken);
    if (tree.root) add_customs(*tree.root, taken);
}

std::string CodeNames::of_definition(std::size_t index) { return fmt::format("@{}", index); }
std::string CodeNames::of_custom(const FieldNode& node) const { return fmt::format("@{}", customs_.at(node.id)); }

/// None is that of another function of the program.
void CodeNames::add_definitions(const FieldTree& tree) {
    std::set<std::string> taken{"scene", "no"};  // scene_distance, no_surface
    std::map<std::string, int> numbers;
    for (const FieldNode& definition : tree.definitions) {
        const std::string name = snake_case(definition.name);
        std::string free = name;
        int& number = numbers[name];
        while (!taken.insert(free).second || is_shape(free + "_distance") || is_shape(free + "_surface"))
            free = fmt::format("{}_{}", name, number++ + 2);
        names_.push_back(free);
    }
}

/// All other names of the program are small, with underscores, or all capitals; so none is the same.
void CodeNames::add_customs(const FieldNode& node, std::set<std::string>& taken) {
    for (const FieldNode& child : node.children) add_customs(child, taken);
    if (!node.code || !customs_.try_emplace(node.id, names_.size()).second) return;
    const std::string name = camel_case(node.name);
    std::string free = name == "Custom" ? "Custom1" : name;
    for (int i = 2; !taken.insert(free).second; ++i) free = fmt::format("{}{}", name, i);
    names_.push_back(free);
}

std::string CodeNames::in(const std::string& code) const {
    std::string text;
    std::size_t from = 0;
    for (std::size_t at = code.find('@'); at != std::string::npos; at = code.find('@', from)) {
        std::size_t number = 0;
        text += code.substr(from, at - from);
        for (from = at + 1; from < code.size() && is_digit(code[from]); ++from)
            number = 10 * number + static_cast<std::size_t>(code[from] - '0');
        text += from > at + 1 && number < names_.size() ? names_[number] : code.substr(at, from - at);
    }
    return text + code.substr(from);
}

}  // namespace farfield
