#include "sdf/custom_suffixes.h"

#include <fmt/format.h>

#include <cctype>

namespace farfield {
namespace {

constexpr std::size_t longest = 32;

/// The letters and digits of ASCII alone; begins with a letter.
std::string camel_case(const std::string& name) {
    std::string text;
    bool begins = true;
    for (const char c : name) {
        const auto u = static_cast<unsigned char>(c);
        const bool letter = u < 0x80 && std::isalpha(u), digit = u < 0x80 && std::isdigit(u);
        if (letter || (digit && !text.empty())) {
            text += static_cast<char>(begins ? std::toupper(u) : std::tolower(u));
            begins = digit;
        } else if (u < 0x80) {
            begins = true;
        }
        if (text.size() == longest) break;
    }
    return text;
}

}  // namespace

CustomSuffixes::CustomSuffixes(const FieldTree& tree, bool by_name) : by_name_(by_name) {
    for (const FieldNode& definition : tree.definitions) gather(definition);
    if (tree.root) gather(*tree.root);
}

void CustomSuffixes::gather(const FieldNode& node) {
    for (const FieldNode& child : node.children) gather(child);
    if (!node.code || suffixes_.contains(node.id)) return;
    std::string suffix = by_name_ ? camel_case(node.name) : "";
    if (suffix.size() < 2) suffix += "Custom";  // one capital alone might be the end of a name in capitals
    std::string free = suffix + (suffix == "Custom" ? "1" : "");
    for (int i = 2; !taken_.insert(free).second; ++i) free = fmt::format("{}{}", suffix, i);
    suffixes_.emplace(node.id, free);
}

}  // namespace farfield
