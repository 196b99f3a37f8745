#include "sdf/march_writer.h"

#include <fmt/format.h>

#include <algorithm>

namespace farfield {
namespace {

constexpr const char* indent = "    ";

std::string with_level(const std::string& distance, float level) {
    return level == 0.0f ? fmt::format("vec2({})", distance)
                         : fmt::format("vec2(0.0, {}) + {}", literal(-level), distance);
}

/// Whether one function does for both numbers: the least or the largest.
bool is_hard(const KindInfo& kind) { return kind.when_zero && kind.gather != Gather::first; }

/// Whether the field is at least the opposite of that of each child after the first.
bool takes_away(const KindInfo& kind) { return kind.when_zero && kind.gather == Gather::first; }
/// Whether the field is at most that of each child.
bool adds(const KindInfo& kind) { return kind.when_zero && kind.gather == Gather::any; }

}  // namespace

MarchWriter::MarchWriter(const FieldTree& tree, const CodeNames& names, ParameterBlock& block, bool by_distance,
                         bool whole)
    : CodeWriter(tree, names, block, false), by_distance_(by_distance), whole_(whole) {
    writes_copies_ = false;
    for (const FieldNode& n : tree.definitions) definitions_live_.push_back(is_live_below(n));
}

CodeLines MarchWriter::write() {
    CodeLines all{names_};
    for (std::size_t i = 0; i < tree_.definitions.size(); ++i) {
        const FieldNode& n = tree_.definitions[i];
        materials_.emplace_back();
        next_group_ = next_child_ = 0;
        CodeLines body{names_};
        const March result = march(n, "p", "v", 0.0f, body);
        definitions_gain_.push_back(gains(n, 0.0f));
        if (!definitions_gain_.back()) continue;
        take_functions(all);
        all.add(fmt::format("vec2 {}_march(vec3 p, vec3 v) {{", CodeNames::of_definition(i)), n.id,
                n.kind->takes_children() ? "" : comment(n));
        all.append(body);
        all.add(fmt::format("    return {};", result.value), n.id);
        all.add("}");
        all.add("");
    }
    next_group_ = next_child_ = 0;
    CodeLines body{names_};
    const bool says_more = tree_.root && (!whole_ || gains(*tree_.root, 0.0f));
    const March result = says_more ? march(*tree_.root, "p", "v", 0.0f, body) : March{"vec2(scene_distance(p))"};
    take_functions(all);
    all.add("vec2 scene_march(vec3 p, vec3 v) {");
    all.append(body);
    all.add(fmt::format("    return {};", result.value));
    all.add("}");
    return all;
}

void MarchWriter::take_functions(CodeLines& out) {
    out.append(functions_);
    functions_.text.clear(), functions_.key.clear(), functions_.nodes.clear();
}

bool MarchWriter::is_live_below(const FieldNode& n) const {
    return block_.is_live(n) || block_.is_derived_live(n) ||
           (n.kind->role == Role::instance && definitions_live_[n.definition]) ||
           std::any_of(n.children.begin(), n.children.end(), [&](const FieldNode& c) { return is_live_below(c); });
}

bool MarchWriter::has_box(const FieldNode& n, float level) const {
    return n.extent.box.is_bounded() && (level == 0.0f || n.kind->role == Role::primitive) && !is_live_below(n);
}

bool MarchWriter::gains(const FieldNode& n, float level) const {
    if (by_distance_) return false;
    const KindInfo& kind = *n.kind;
    // A live number may change under the code: no level may depend on it.
    if (block_.is_live(n) && (level != 0.0f || kind.reach)) return false;
    if (kind.role == Role::primitive) return kind.along || has_box(n, level);
    if (kind.role == Role::instance) return level == 0.0f && definitions_gain_[n.definition];
    const float below = level / n.scale + n.reach();
    if (kind.role == Role::domain || kind.role == Role::repeat)
        return has_box(n, level) || (is_straight(n) && any_child_gains(n, below));
    if (kind.gather != Gather::first) return any_child_gains(n, below);
    return gains(n.children[0], below) ||
           (takes_away(kind) && std::any_of(n.children.begin() + 1, n.children.end(),
                                            [&](const FieldNode& c) { return knows_stay(c, below); }));
}

MarchWriter::March MarchWriter::march(const FieldNode& n, const std::string& p, const std::string& v, float level,
                                      CodeLines& out) {
    if (!gains(n, level)) return plain(n, p, v, level, out);
    switch (n.kind->role) {
        case Role::primitive:
            return n.kind->along ? primitive(n, p, v, level) : plain(n, p, v, level, out);
        case Role::instance: {
            const Numbers own = numbers(n, p);
            return {fmt::format("{}{}_march({}, {})", own.factor, CodeNames::of_definition(n.definition), own.point,
                                direction(n, v))};
        }
        case Role::combine:
        case Role::distance:
            return group(n, p, v, level, out);
        case Role::domain:
        case Role::repeat:
            break;
    }
    if (is_straight(n) && any_child_gains(n, level / n.scale + n.reach())) return moved(n, p, v, level, out);
    return plain(n, p, v, level, out);
}

MarchWriter::March MarchWriter::plain(const FieldNode& n, const std::string& p, const std::string& v, float level,
                                      CodeLines& out) {
    const std::string d = node(n, p, out, indent).distance;
    if (!has_box(n, level)) return {with_level(d, level)};
    const Box& box = n.extent.box;
    return {fmt::format("advance_in_box({}, {}, {} - {}, {}, {})", d, literal(level), p, literal(box.centre()), v,
                        literal(0.5f * box.size()))};
}

std::string MarchWriter::tangent(const FieldNode& n, const std::string& p, const std::string& v) {
    const Numbers own = numbers(n, p);
    const std::string in_own = fmt::format("{}({}, {}{})", n.kind->along, own.point, direction(n, v), own.arguments);
    // Scaled, the distance is longer and the slope the same.
    return own.factor.empty() ? in_own
                              : fmt::format("vec2({}, 1.0) * {}", own.factor.substr(0, own.factor.size() - 3), in_own);
}

MarchWriter::March MarchWriter::primitive(const FieldNode& n, const std::string& p, const std::string& v, float level) {
    return {fmt::format("advance({}, {})", tangent(n, p, v), literal(level))};
}

bool MarchWriter::is_convex_pair(const FieldNode& n) const {
    const auto is_convex = [](const FieldNode& c) { return c.kind->along != nullptr; };
    return n.kind->kind == NodeKind::union_ && n.children.size() == 2 && n.values[0].x > 0.0f && !block_.is_live(n) &&
           std::all_of(n.children.begin(), n.children.end(), is_convex);
}

bool MarchWriter::blends_primitives(const FieldNode& n) const {
    const auto is_convex = [](const FieldNode& c) { return c.kind->along != nullptr; };
    const auto is_held = [&](const FieldNode& c) {
        return c.kind->role == Role::primitive && !block_.is_live(c) && (is_convex(c) || has_box(c, 0.0f));
    };
    return n.kind->kind == NodeKind::union_ && n.values[0].x > 0.0f && !block_.is_live(n) &&
           std::any_of(n.children.begin(), n.children.end(), is_convex) &&
           std::all_of(n.children.begin(), n.children.end(), is_held);
}

MarchWriter::March MarchWriter::end(const FieldNode& n, const Group& group, float level, bool knows_distance,
                                    CodeLines& out) {
    const std::string d = variable(group), &factor = group.numbers.factor;
    if (!factor.empty()) out.add(fmt::format("{}{} = {}{};", indent, d, factor, d), n.id);
    if (!knows_distance)
        out.add(
            fmt::format("{}{}.y = max({}.y, {}.x{});", indent, d, d, d, level == 0.0f ? "" : " - " + literal(level)),
            n.id);
    return {d, true};
}

void MarchWriter::fold(const FieldNode& n, const Numbers& num, const std::string& d, const std::string& p,
                       const std::string& v, float below, CodeLines& out) {
    const KindInfo& kind = *n.kind;
    const bool combines = kind.role == Role::combine;
    const bool hard = !combines || (num.hard && is_hard(kind));
    const char* gather = combines && kind.gather == Gather::all ? "max" : "min";
    for (const FieldNode& child : n.children) {
        const bool first = &child == &n.children[0];
        if (!first && !hard && kind.gather == Gather::first) {
            const Result next = node(child, p, out, indent);
            out.add(fmt::format("{}{}.x = {};", indent, d, combination(kind, num, d + ".x", next.distance)), child.id,
                    next.named ? "" : comment(child));
            if (takes_away(kind) && knows_stay(child, below))
                out.add(fmt::format("{}{}.y = max({}.y, {});", indent, d, d, stay(child, p, v, below)), child.id);
            continue;
        }
        const March next = march(child, p, v, below, out);
        const std::string name = next.named || child.kind->takes_children() ? "" : comment(child);
        if (first) {
            out.add(fmt::format("{}vec2 {} = {};", indent, d, next.value), child.id, name);
        } else if (hard) {
            out.add(fmt::format("{}{} = {}({}, {});", indent, d, gather, d, next.value), child.id, name);
        } else {
            std::string e = next.value;
            if (!next.named) {
                e = fmt::format("e{}", next_child_++);
                out.add(fmt::format("{}vec2 {} = {};", indent, e, next.value), child.id, name);
            }
            out.add(fmt::format("{}{} = vec2({}, {}({}.y, {}.y));", indent, d,
                                combination(kind, num, d + ".x", e + ".x"), gather, d, e),
                    child.id);
        }
    }
}

void MarchWriter::blend(const FieldNode& n, const Group& group, float level, CodeLines& out) {
    const auto& [id, num, own, turned] = group;
    const std::string d = variable(group);
    const float fill = n.reach(), radius = n.values[0].x;
    const std::string levels = literal(glm::vec3(level, level + fill, level + fill + radius)),
                      ways = fmt::format("w{}", id);
    for (const FieldNode& child : n.children) {
        const bool first = &child == &n.children[0];
        const bool convex = child.kind->along;
        const std::string shape = convex ? tangent(child, own, turned) : node(child, own, out, indent).distance;
        std::string e = d;
        if (!first) e = fmt::format("e{}", next_child_++);
        out.add(convex ? fmt::format("{}vec2 {} = {};", indent, e, shape)
                       : fmt::format("{}vec2 {} = vec2({}, 0.0);", indent, e, shape),
                child.id, comment(child));
        const Box& box = child.extent.box;
        const std::string to = convex ? fmt::format("ways_to({}, {})", e, levels)
                                      : fmt::format("ways_to_box({}.x, {}, {} - {}, {}, {})", e, levels, own,
                                                    literal(box.centre()), turned, literal(0.5f * box.size()));
        if (first) {
            out.add(fmt::format("{}vec4 {} = vec4({}, {});", indent, ways, to, literal(empty_distance)), child.id);
        } else {
            out.add(fmt::format("{}{} = nearer_ways({}, {});", indent, ways, ways, to), child.id);
            out.add(fmt::format("{}{}.x = {};", indent, d, combination(*n.kind, num, d + ".x", e + ".x")), child.id);
        }
    }
    out.add(fmt::format("{}{}.y = way_to_blend({});", indent, d, ways), n.id);
}

MarchWriter::March MarchWriter::group(const FieldNode& n, const std::string& p, const std::string& v, float level,
                                      CodeLines& out) {
    const KindInfo& kind = *n.kind;
    const Group group = begin(n, p, v, out);
    const auto& [id, num, own, turned] = group;
    const std::string d = variable(group);
    if (is_convex_pair(n)) {
        out.add(fmt::format("{}vec2 {} = {};", indent, d, tangent(n.children[0], own, turned)), n.children[0].id,
                comment(n.children[0]));
        out.add(fmt::format("{}{} = smooth_union_advance({}, {}{}, {});", indent, d, d,
                            tangent(n.children[1], own, turned), num.arguments, literal(level / n.scale)),
                n.children[1].id, comment(n.children[1]));
        return end(n, group, level, true, out);
    }
    if (blends_primitives(n)) {
        blend(n, group, level / n.scale, out);
        return end(n, group, level, false, out);
    }
    fold(n, num, d, own, turned, level / n.scale + n.reach(), out);
    if (kind.role == Role::distance)
        out.add(fmt::format("{}{}.x = {}({}.x{});", indent, d, kind.function, d, num.arguments), n.id);
    return end(n, group, level, kind.role == Role::combine && num.hard && is_hard(kind), out);
}

MarchWriter::March MarchWriter::moved(const FieldNode& n, const std::string& p, const std::string& v, float level,
                                      CodeLines& out) {
    const KindInfo& kind = *n.kind;
    const Group group = begin(n, p, v, out);
    const auto& [id, num, own, turned] = group;
    const std::string d = variable(group);
    const std::string args = num.arguments + num.derived;
    const int cells = kind.role == Role::repeat ? kind.cells(n.values) : 1;
    std::string along = turned;
    if (kind.direction) {
        along = fmt::format("u{}", id);
        out.add(fmt::format("{}vec3 {} = {}({}, {}{});", indent, along, kind.direction, own, turned, num.arguments),
                n.id);
    }
    const float below = level / n.scale + n.reach();
    if (cells == 1) {
        const std::string q = fmt::format("q{}", id);
        out.add(fmt::format("{}vec3 {} = {}({}{}{});", indent, q, kind.function, own,
                            kind.function_takes_derived ? args : num.arguments, kind.role == Role::repeat ? ", 0" : ""),
                n.id);
        fold(n, num, d, q, along, below, out);
    } else {
        const std::string content = fmt::format("march_of_copy{}", next_copy_++);
        CodeLines body{names_};
        fold(n, num, d, "p", "v", below, body);
        const std::string region = fmt::format("{}, {}, {}", args, num.low, num.high);
        if (n.guarded) body.add(fmt::format("{}{}.x = {}({}.x, p{});", indent, d, kind.guard_copy, d, region), n.id);
        functions_.add(fmt::format("vec2 {}(vec3 p, vec3 v) {{", content), n.id, "one copy of " + comment(n));
        functions_.append(body);
        functions_.add(fmt::format("{}return {};", indent, d));
        functions_.add("}");
        functions_.add("");
        out.add(fmt::format("{}vec2 {} = vec2({});", indent, d, literal(empty_distance)), n.id);
        out.add_for_cells(indent, std::to_string(cells), writes_out_cells(n), n.id, [&](const std::string& cell) {
            return std::vector{fmt::format("{} = min({}, {}({}({}{}, {}), {}));", d, d, content, kind.function, own,
                                           args, cell, along)};
        });
        if (n.guarded)
            out.add(fmt::format("{}{}.x = {}({}.x, {}{});", indent, d, kind.guard_nearest, d, own, region), n.id);
    }
    out.add(fmt::format("{}{}.y = min({}.y, {}({}, {}{}));", indent, d, d, kind.way, own, turned, args), n.id);
    if (has_box(n, level)) {
        const Box& box = n.region;
        out.add(fmt::format("{}{}.y = max({}.y, advance(box_along({} - {}, {}, {}), 0.0).y);", indent, d, d, own,
                            literal(box.centre()), turned, literal(0.5f * box.size())),
                n.id);
    }
    return end(n, group, level, false, out);
}

bool MarchWriter::is_straight(const FieldNode& n) const {
    return n.kind->way && !block_.is_live(n) && !block_.is_derived_live(n) && n.kind->straight(n.values);
}

bool MarchWriter::any_child_gains(const FieldNode& n, float below) const {
    return std::any_of(n.children.begin(), n.children.end(), [&](const FieldNode& c) { return gains(c, below); });
}

bool MarchWriter::knows_stay(const FieldNode& n, float level) const {
    if (block_.is_live(n) && level != 0.0f) return false;
    if (n.kind->role == Role::primitive) return n.kind->within;
    // In a row of copies: inside one of them, which stand still as the ray goes on.
    const bool adds_up = n.kind->role == Role::combine
                             ? adds(*n.kind)
                             : n.kind->role == Role::repeat && is_straight(n) && !n.guarded && writes_out_cells(n);
    return adds_up && std::any_of(n.children.begin(), n.children.end(),
                                  [&](const FieldNode& c) { return knows_stay(c, level / n.scale); });
}

std::string MarchWriter::stay(const FieldNode& n, const std::string& p, const std::string& v, float level) {
    const Numbers own = numbers(n, p);
    const std::string turned = direction(n, v);
    if (n.kind->role == Role::primitive)
        return fmt::format("{}{}({}, {}, {}{})", own.factor, n.kind->within, own.point, turned,
                           literal(level / n.scale), own.arguments);
    std::string longest;
    const auto add_children = [&](const std::string& at) {
        for (const FieldNode& child : n.children) {
            if (!knows_stay(child, level / n.scale)) continue;
            const std::string next = stay(child, at, turned, level / n.scale);
            longest = longest.empty() ? next : fmt::format("max({}, {})", longest, next);
        }
    };
    if (n.kind->role == Role::repeat)
        for (int cell = 0; cell < n.kind->cells(n.values); ++cell)
            add_children(fmt::format("{}({}{}{}, {})", n.kind->function, own.point, own.arguments, own.derived, cell));
    else
        add_children("(" + own.point + ")");
    return own.factor + longest;
}

}  // namespace farfield
