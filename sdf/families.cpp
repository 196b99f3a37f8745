#include "sdf/families.h"

#include "sdf/code_lines.h"
#include "sdf/parameter_block.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <functional>
#include <map>
#include <span>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace farfield {
namespace {

/// Of smaller families the boxes take longer than literals save: a city of 100 nodes gains nothing by them, and loses a
/// quarter by families of two.
constexpr std::size_t fewest_members = 4, fewest_nodes = 32;

/// All is forgotten where there were more.
constexpr std::size_t most_codes = 16384;

/// The code with `replaced(text of a number)` for each of its floats and unsigned numbers, in their order. Integers,
/// which count, are left alone. A vector of one number is one of three.
std::string replace_numbers(std::string_view code, const std::function<std::string(std::string_view)>& replaced) {
    const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
    const auto is_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '@'; };
    std::string result;
    std::size_t at = 0;
    const auto number_length = [&](std::size_t from) {
        std::size_t to = from + (code[from] == '-' ? 1 : 0);
        while (to < code.size() &&
               (is_digit(code[to]) || code[to] == '.' || (code[to] == 'e' && to + 1 < code.size()) ||
                ((code[to] == '-' || code[to] == '+') && code[to - 1] == 'e')))
            ++to;
        if (to < code.size() && code[to] == 'u') ++to;
        return to - from;
    };
    const auto starts_number = [&](std::size_t from) {
        return from < code.size() &&
               (is_digit(code[from]) || (code[from] == '-' && from + 1 < code.size() && is_digit(code[from + 1])));
    };
    while (at < code.size()) {
        if (code.substr(at, 2) == "//") {
            const std::size_t end = std::min(code.find('\n', at), code.size());
            result += code.substr(at, end - at);
            at = end;
        } else if (is_word(code[at]) && !is_digit(code[at])) {
            std::size_t end = at;
            while (end < code.size() && is_word(code[end])) ++end;
            const std::string_view word = code.substr(at, end - at);
            result += word;
            at = end;
            if (word != "vec3" || at >= code.size() || code[at] != '(' || !starts_number(at + 1)) continue;
            const std::size_t length = number_length(at + 1);
            if (code[at + 1 + length] != ')') continue;
            const std::string_view number = code.substr(at + 1, length);
            for (const char* before : {"(", ", ", ", "}) result += before + replaced(number);
            at += 1 + length;
        } else if (starts_number(at)) {
            const std::string_view number = code.substr(at, number_length(at));
            result += number.find_first_of(".eu") == std::string_view::npos ? std::string(number) : replaced(number);
            at += number.size();
        } else {
            result += code[at++];
        }
    }
    return result;
}

float value_of(std::string_view number) {
    float value = 0.0f;
    std::from_chars(number.data(), number.data() + number.size(), value);
    return value;
}

/// Where a member stands: 3 numbers of its translation and 9 of its inverse rotation, which come before those of its
/// code.
constexpr std::size_t placement = 12;

/// Members before it is decided which numbers differ.
struct Alike {
    std::vector<Id> members;
    std::vector<Box> bounds;
    std::size_t nodes = 0;                    ///< of each
    std::vector<std::vector<float>> numbers;  ///< of placement and code, for each member
};

bool same_in_all(const Alike& alike, std::size_t a, std::size_t b) {
    return std::all_of(alike.numbers.begin(), alike.numbers.end(), [&](const auto& n) { return n[a] == n[b]; });
}

bool is_constant(const Alike& alike, std::size_t i, float value) {
    return std::all_of(alike.numbers.begin(), alike.numbers.end(), [&](const auto& n) { return n[i] == value; });
}

bool serves(const NumberLayout& layout, const Alike& alike) {
    std::vector<int> first(static_cast<std::size_t>(layout.width), -1);
    for (std::size_t i = 0; i < layout.places.size(); ++i) {
        if (layout.places[i] < 0) {
            if (!is_constant(alike, i, layout.literals[i])) return false;
            continue;
        }
        int& other = first[static_cast<std::size_t>(layout.places[i])];
        if (other < 0)
            other = static_cast<int>(i);
        else if (!same_in_all(alike, i, static_cast<std::size_t>(other)))
            return false;
    }
    return true;
}

std::size_t count_nodes(const FieldNode& node, const FieldTree& tree) {
    std::size_t count = 1;
    if (node.kind->role == Role::instance) count += count_nodes(tree.definitions[node.definition], tree);
    for (const FieldNode& child : node.children) count += count_nodes(child, tree);
    return count;
}

/// What stood in the table before stays there, and what has changed comes to it.
NumberLayout make_layout(const Alike& alike, const NumberLayout* before) {
    const std::vector<float>& first = alike.numbers.front();
    NumberLayout layout{std::vector<int>(first.size(), -1), first, 0};
    std::unordered_map<std::string, int> known;
    for (std::size_t i = 0; i < first.size(); ++i) {
        const bool was_read = before && (before->places[i] >= 0 || before->literals[i] != first[i]);
        if (!was_read && is_constant(alike, i, first[i])) continue;
        std::string column;
        for (const auto& numbers : alike.numbers)
            column.append(reinterpret_cast<const char*>(&numbers[i]), sizeof(float));
        const auto [place, fresh] = known.try_emplace(std::move(column), layout.width);
        layout.places[i] = place->second;
        layout.width += fresh ? 1 : 0;
    }
    return layout;
}

/// Number `i` as the code of all members has it; `number` is how it stands in that of the first.
std::string read(const NumberLayout& layout, std::size_t i, std::string_view number) {
    const int place = layout.places[i];
    if (place < 0) return std::string(number);
    const std::string read = fmt::format("member{}.{}", place / 4, "xyzw"[place % 4]);
    return number.ends_with('u') ? fmt::format("uint({})", read) : read;
}

/// From the world's frame to that of a member: what the functions of the scene begin with.
struct Placement {
    std::string point, direction;
};
Placement placement_code(const NumberLayout& layout) {
    const auto numbers = [&](std::size_t from, std::size_t count) {
        std::string text;
        for (std::size_t i = from; i < from + count; ++i)
            text += (text.empty() ? "" : ", ") + read(layout, i, literal(layout.literals[i]));
        return text;
    };
    const auto is_always = [&](std::size_t from, std::span<const float> values) {
        for (std::size_t i = 0; i < values.size(); ++i)
            if (layout.places[from + i] >= 0 || layout.literals[from + i] != values[i]) return false;
        return true;
    };
    const std::array<float, 9> identity{1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f};
    std::string turn;
    if (!is_always(3, identity)) turn = fmt::format("mat3({}) * ", numbers(3, 9));
    return {fmt::format(" p = {}(p - vec3({}));", turn, numbers(0, 3)),
            turn.empty() ? "" : fmt::format(" v = {}v;", turn)};
}

/// Puts `code` at the beginning of the function that starts so, on the same line.
void begin_with(std::string& text, std::string_view function, const std::string& code) {
    text.insert(text.find('{', text.rfind(function)) + 1, code);
}

/// The code of one as that of all.
GeneratedScene code_of_all(GeneratedScene code, const NumberLayout& layout) {
    const auto [point, direction] = placement_code(layout);
    std::size_t i = placement;
    const auto with_reads = [&](const std::string& text, std::size_t from, std::size_t to) {
        std::string part = replace_numbers(std::string_view(text).substr(from, to - from),
                                           [&](std::string_view number) { return read(layout, i++, number); });
        for (const char* function : {"float scene_distance(", "float scene_surface("})
            if (part.find(function) != std::string::npos) begin_with(part, function, point);
        for (const char* function : {"float scene_cast(", "vec2 scene_march("})
            if (part.find(function) != std::string::npos) begin_with(part, function, point + direction);
        return part;
    };
    std::string text = code.text.substr(0, code.own_at) + with_reads(code.text, code.own_at, code.surface_at);
    const std::size_t surface_at = text.size();
    text += with_reads(code.text, code.surface_at, code.march_at);
    const std::size_t march_at = text.size();
    text += with_reads(code.text, code.march_at, code.text.size());
    i = placement;
    code.key = code.key.substr(0, code.own_key_at) + with_reads(code.key, code.own_key_at, code.key.size());
    code.text = std::move(text);
    code.surface_at = surface_at;
    code.march_at = march_at;
    code.member_vectors = static_cast<std::size_t>(std::max(layout.width + 3, 4) / 4);
    return code;
}

/// `first`: the code of one, at the origin.
Family family(Alike alike, GeneratedScene first, const NumberLayout& layout) {
    Family family{std::move(alike.members), std::move(alike.bounds), code_of_all(std::move(first), layout), {}};
    const std::size_t width = 4 * family.code.member_vectors;
    family.numbers.resize(width * family.members.size());
    for (std::size_t member = 0; member < family.members.size(); ++member)
        for (std::size_t i = 0; i < layout.places.size(); ++i)
            if (layout.places[i] >= 0)
                family.numbers[width * member + static_cast<std::size_t>(layout.places[i])] = alike.numbers[member][i];
    family.code.bounds = family.bounds.front();
    for (const Box& box : family.bounds) family.code.bounds = family.code.bounds.united(box);
    return family;
}

}  // namespace

FamilyFinder::Item FamilyFinder::make_item(FieldTree tree) {
    const GeneratedScene code = generate(tree, Tier::specialised, 0, false);
    Item item{std::move(tree), 0, 0, {}};
    std::string without = code.key.substr(0, code.own_key_at);
    without += replace_numbers(std::string_view(code.key).substr(code.own_key_at), [&](std::string_view number) {
        item.numbers.push_back(value_of(number));
        return number.ends_with('u') ? "u" : "f";
    });
    item.code = codes_.try_emplace(std::move(without), static_cast<int>(codes_.size())).first->second;
    item.nodes = count_nodes(*item.tree.root, item.tree);
    return item;
}

std::vector<Family> FamilyFinder::find(const Scene& scene, Id tuned) {
    if (codes_.size() > most_codes) codes_.clear(), layouts_.clear(), items_.clear();
    std::unordered_map<Id, Item> items;
    std::map<int, Alike> all;
    for (FieldTree& tree : united(FieldTree(scene))) {
        FieldNode& node = *tree.root;
        const Id id = node.id;
        const Box bounds = node.extent.box;
        if (!bounds.is_bounded()) continue;
        if (tuned != 0 && ParameterBlock(tree, Tier::specialised, tuned).is_derived_live(node)) continue;
        std::vector<float> numbers{node.translate.x, node.translate.y, node.translate.z};
        for (int column = 0; column < 3; ++column)
            for (int row = 0; row < 3; ++row) numbers.push_back(node.to_own[column][row]);
        move(node, glm::vec3(0.0f), glm::mat3(1.0f));
        const auto known = items_.find(id);
        const bool unchanged = known != items_.end() && known->second.tree == tree;
        const Item& item =
            items.emplace(id, unchanged ? std::move(known->second) : make_item(std::move(tree))).first->second;
        numbers.insert(numbers.end(), item.numbers.begin(), item.numbers.end());
        Alike& alike = all[item.code];
        alike.nodes = item.nodes;
        alike.members.push_back(id);
        alike.bounds.push_back(bounds);
        alike.numbers.push_back(std::move(numbers));
    }
    items_ = std::move(items);
    std::vector<Family> families;
    for (auto& [code, alike] : all) {
        if (alike.members.size() < fewest_members || alike.members.size() * alike.nodes < fewest_nodes) continue;
        const auto known = layouts_.find(code);
        const NumberLayout* before = known == layouts_.end() ? nullptr : &known->second;
        if (!before || !serves(*before, alike)) {
            NumberLayout layout = make_layout(alike, before);
            layouts_[code] = std::move(layout);
        }
        GeneratedScene first = generate(items_.at(alike.members.front()).tree, Tier::specialised, 0, false);
        families.push_back(family(std::move(alike), std::move(first), layouts_[code]));
    }
    return families;
}

}  // namespace farfield
