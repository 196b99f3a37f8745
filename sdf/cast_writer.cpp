#include "sdf/cast_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace farfield {
namespace {

constexpr const char* indent = "    ";

/// So many others are taken away at most: n of them are looked at n² - n + 1 times.
constexpr std::size_t most_cuts = 5;

/// Whether the node is what `gather` and its distance say of hard edges.
bool is_hard(const FieldNode& n, Gather gather, const ParameterBlock& block) {
    return n.kind->role == Role::combine && n.kind->when_zero && n.kind->gather == gather && !block.is_live(n) &&
           std::all_of(n.values.begin(), n.values.end(), [](glm::vec3 v) { return v == glm::vec3(0.0f); });
}

/// Whether a line crosses it from one place to another, both known.
bool is_crossed(const FieldNode& n, const ParameterBlock& block) {
    if (n.kind->role == Role::primitive) return n.kind->span;
    return is_hard(n, Gather::all, block) &&
           std::all_of(n.children.begin(), n.children.end(), [&](const FieldNode& c) { return is_crossed(c, block); });
}

/// How many spans it takes to say what is taken away; too many where not all of it is known.
std::size_t count_cuts(const FieldNode& n, const ParameterBlock& block) {
    if (is_crossed(n, block)) return 1;
    if (!is_hard(n, Gather::any, block)) return most_cuts + 1;
    std::size_t count = 0;
    for (const FieldNode& child : n.children) count += count_cuts(child, block);
    return count;
}

bool is_cast(const FieldNode& n, const ParameterBlock& block) {
    if (is_crossed(n, block)) return true;
    if (!is_hard(n, Gather::first, block) || !is_crossed(n.children[0], block)) return false;
    std::size_t count = 0;
    for (std::size_t i = 1; i < n.children.size(); ++i) count += count_cuts(n.children[i], block);
    return count <= most_cuts;
}

/// What of the node and below is as `wanted`.
std::optional<FieldNode> part(const FieldNode& n, const ParameterBlock& block, bool wanted) {
    if (!is_hard(n, Gather::any, block)) return is_cast(n, block) == wanted ? std::optional(n) : std::nullopt;
    FieldNode some = n;
    some.children.clear();
    for (const FieldNode& child : n.children)
        if (std::optional<FieldNode> below = part(child, block, wanted)) some.children.push_back(std::move(*below));
    if (some.children.empty()) return std::nullopt;
    some.region = content_extent(some).box;
    move(some, some.translate, some.to_own);  // its extent follows
    return some;
}

}  // namespace

CastAndMarched divide_for_rays(const FieldTree& tree, const ParameterBlock& block) {
    CastAndMarched both;
    both.cast.definitions = both.marched.definitions = tree.definitions;
    if (!tree.root) return both;
    both.cast.root = part(*tree.root, block, true);
    both.marched.root = part(*tree.root, block, false);
    return both;
}

CodeLines CastWriter::write() {
    CodeLines body{names_};
    meet(*tree_.root, "p", "v", "", body);
    CodeLines all{names_};
    all.add("float scene_cast(vec3 p, vec3 v) {");
    all.append(body);
    all.add("    return t;");
    all.add("}");
    return all;
}

void CastWriter::add(const FieldNode& n, const std::string& span, const std::string& factor, const std::string& comment,
                     CodeLines& out) {
    const bool first = std::exchange(is_first_, false);
    out.add(fmt::format("{}{}way_into({}{}){};", indent, first ? "float t = " : "t = min(t, ", factor, span,
                        first ? "" : ")"),
            n.id, comment);
}

void CastWriter::meet(const FieldNode& n, const std::string& p, const std::string& v, const std::string& factor,
                      CodeLines& out) {
    if (n.kind->role == Role::primitive) return add(n, span(n, p, v, out), factor, comment(n), out);
    if (n.kind->gather == Gather::all) return add(n, span(n, p, v, out), factor, "", out);
    const Group group = begin(n, p, v, out);
    const std::string own = factor + group.numbers.factor;
    if (n.kind->gather == Gather::any) {
        for (const FieldNode& child : n.children) meet(child, group.p, group.v, own, out);
        return;
    }
    const std::string whole = fmt::format("s{}", group.id), way = fmt::format("t{}", group.id);
    const std::string of_whole = span(n.children[0], group.p, group.v, out);
    const bool named = n.children[0].kind->takes_children();
    out.add(fmt::format("{}vec2 {} = {};", indent, whole, of_whole), n.children[0].id,
            named ? "" : comment(n.children[0]));
    std::vector<std::string> all;
    for (std::size_t i = 1; i < n.children.size(); ++i) cuts(n.children[i], group.p, group.v, "", all, out);
    out.add(fmt::format("{}float {} = max({}.x, 0.0);", indent, way, whole), n.id);
    const std::size_t looks = all.empty() ? 0 : all.size() * (all.size() - 1) + 1;
    for (std::size_t i = 0; i < looks; ++i)
        out.add(fmt::format("{}{} = way_out_of({}, {});", indent, way, all[i % all.size()], way), n.id);
    add(n, fmt::format("vec2({}, {}.y)", way, whole), own, "", out);
}

std::string CastWriter::span(const FieldNode& n, const std::string& p, const std::string& v, CodeLines& out) {
    if (n.kind->role == Role::primitive) {
        const Numbers own = numbers(n, p);
        return fmt::format("{}{}({}, {}{})", own.factor, n.kind->span, own.point, direction(n, v), own.arguments);
    }
    const Group group = begin(n, p, v, out);
    const std::string common = fmt::format("s{}", group.id);
    for (const FieldNode& child : n.children) {
        const std::string next = span(child, group.p, group.v, out);
        const std::string name = child.kind->takes_children() ? "" : comment(child);
        out.add(&child == &n.children[0] ? fmt::format("{}vec2 {} = {};", indent, common, next)
                                         : fmt::format("{}{} = span_of_both({}, {});", indent, common, common, next),
                child.id, name);
    }
    return group.numbers.factor + common;
}

void CastWriter::cuts(const FieldNode& n, const std::string& p, const std::string& v, const std::string& factor,
                      std::vector<std::string>& names, CodeLines& out) {
    if (is_crossed(n, block_)) {
        const std::string of_cut = span(n, p, v, out);
        names.push_back(fmt::format("c{}", next_child_++));
        out.add(fmt::format("{}vec2 {} = {}{};", indent, names.back(), factor, of_cut), n.id,
                n.kind->takes_children() ? "" : comment(n));
        return;
    }
    const Group group = begin(n, p, v, out);
    for (const FieldNode& child : n.children) cuts(child, group.p, group.v, factor + group.numbers.factor, names, out);
}

}  // namespace farfield
