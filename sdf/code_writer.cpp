#include "sdf/code_writer.h"

#include <fmt/format.h>

#include <optional>
#include <string_view>
#include <utility>

namespace farfield {
namespace {

constexpr int most_written_out = 16;

/// Nodes in the code once it has been written out; what an instance shows counts as too many.
int written_nodes(const FieldNode& n) {
    int sum = n.kind->role == Role::instance ? most_written_out + 1 : 1;
    for (const FieldNode& child : n.children) sum = std::min(sum + written_nodes(child), most_written_out + 1);
    return n.kind->role == Role::repeat ? std::min(sum * n.kind->cells(n.values), most_written_out + 1) : sum;
}

}  // namespace

bool writes_out_cells(const FieldNode& repetition) { return written_nodes(repetition) <= most_written_out; }

CodeLines CodeWriter::custom_functions(std::string& called) {
    CodeLines out{names_};
    std::set<Id> done;
    for (const FieldNode& definition : tree_.definitions) custom_functions(definition, done, out, called);
    if (tree_.root) custom_functions(*tree_.root, done, out, called);
    return out;
}

CodeLines CodeWriter::write() {
    for (std::size_t i = 0; i < tree_.definitions.size(); ++i) write_definition(i);
    in_definition_ = false;
    next_group_ = next_child_ = 0;
    CodeLines body{names_};
    std::optional<Result> result;
    if (tree_.root) result = node(*tree_.root, "p", body, "    ");
    CodeLines all{names_};
    all.append(functions_);
    all.add(with_material_ ? "float scene_surface(vec3 p, out uint material) {" : "float scene_distance(vec3 p) {");
    all.append(body);
    if (with_material_) all.add(fmt::format("    material = {};", result ? result->material : "0u"));
    all.add(fmt::format("    return {};", result ? result->distance : literal(empty_distance)));
    all.add("}");
    return all;
}

void CodeWriter::write_definition(std::size_t index) {
    const std::string name = CodeNames::of_definition(index);
    const FieldNode& n = tree_.definitions[index];
    in_definition_ = true;
    next_group_ = next_child_ = 0;
    CodeLines body{names_};
    const Result result = node(n, "p", body, "    ");
    materials_.push_back(result);
    if (with_material_ && !result.varies) return;
    functions_.add(with_material_ ? fmt::format("float {}_surface(vec3 p, uint inherited, out uint material) {{", name)
                                  : fmt::format("float {}_distance(vec3 p) {{", name),
                   n.id, n.kind->takes_children() ? "" : comment(n));
    functions_.append(body);
    if (with_material_) functions_.add(fmt::format("    material = {};", result.material), n.id);
    functions_.add(fmt::format("    return {};", result.distance), n.id);
    functions_.add("}");
    functions_.add("");
}

CodeWriter::Numbers CodeWriter::numbers(const FieldNode& n, const std::string& p) {
    Numbers numbers = block_.is_live(n) ? live_numbers(n, p, block_.first(n)) : literals(n, p);
    if (!block_.is_live(n) && n.material == inherited_material) numbers.material = "inherited";
    add_derived(n, numbers);
    return numbers;
}

std::string CodeWriter::read(const Parameter& parameter, std::size_t at) {
    return fmt::format(fmt::runtime(parameter.components() == 1 ? "parameter({})" : "parameter3({})"), at);
}

std::string CodeWriter::written(const Parameter& parameter, glm::vec3 v) {
    return parameter.components() == 1 ? literal(v.x) : literal(v);
}

CodeWriter::Numbers CodeWriter::live_numbers(const FieldNode& n, const std::string& p, std::size_t first) const {
    Numbers numbers{fmt::format("place({}, {})", p, first),
                    fmt::format("parameter({}) * ", first + ParameterBlock::scale_offset),
                    "",
                    "",
                    "",
                    "",
                    "",
                    false};
    std::size_t at = first + ParameterBlock::parameters_offset;
    for (const Parameter& parameter : n.parameters) {
        numbers.arguments += ", " + read(parameter, at);
        at += static_cast<std::size_t>(parameter.components());
    }
    numbers.material =
        fmt::format(fmt::runtime(in_definition_ ? "live_material({}, inherited)" : "uint(parameter({}))"), at);
    return numbers;
}

CodeWriter::Numbers CodeWriter::literals(const FieldNode& n, const std::string& p) {
    Numbers numbers{p, "", "", "", fmt::format("{}u", n.material), "", "", true};
    std::string& q = numbers.point;
    const bool moved = n.translate != glm::vec3(0.0f), turned = n.to_own != glm::mat3(1.0f), scaled = n.scale != 1.0f;
    if (moved) q = fmt::format("{} - {}", p, literal(n.translate));
    if (moved && (turned || scaled)) q = "(" + q + ")";
    if (turned) q = literal(n.to_own) + " * " + q;
    if (scaled) {
        q += " / " + literal(n.scale);
        numbers.factor = literal(n.scale) + " * ";
    }
    for (std::size_t i = 0; i < n.parameters.size(); ++i) {
        numbers.arguments += ", " + written(n.parameters[i], n.values[i]);
        numbers.hard = numbers.hard && n.values[i] == glm::vec3(0.0f);
    }
    return numbers;
}

void CodeWriter::add_derived(const FieldNode& n, Numbers& numbers) {
    const bool live = block_.is_derived_live(n);
    std::size_t at = live ? block_.first_derived(n) : 0;
    for (std::size_t i = 0; i < n.kind->derived.size(); ++i) {
        const Parameter& parameter = n.kind->derived[i];
        const glm::vec3 v = n.values[n.kind->parameters.size() + i];
        numbers.derived += ", " + (live ? read(parameter, at) : written(parameter, v));
        at += static_cast<std::size_t>(parameter.components());
    }
    if (!n.kind->confined && !n.guarded) return;
    if (live)
        numbers.low = fmt::format("parameter3({})", at), numbers.high = fmt::format("parameter3({})", at + 3);
    else if (n.guarded || n.region.is_bounded(0) || n.region.is_bounded(1) || n.region.is_bounded(2))
        numbers.low = literal(n.region.low), numbers.high = literal(n.region.high);
}

std::string CodeWriter::direction(const FieldNode& n, const std::string& v) {
    if (block_.is_live(n)) return fmt::format("turn({}, {})", v, block_.first(n));
    return n.to_own == glm::mat3(1.0f) ? v : literal(n.to_own) + " * " + v;
}

CodeWriter::Group CodeWriter::begin(const FieldNode& n, const std::string& p, const std::string& v, CodeLines& out) {
    constexpr const char* indent = "    ";
    const int id = next_group_++;
    out.add(indent, n.id, comment(n));
    Group group{id, numbers(n, p), p, v};
    if (group.numbers.point != p) {
        group.p = fmt::format("p{}", id);
        out.add(fmt::format("{}vec3 {} = {};", indent, group.p, group.numbers.point), n.id);
    }
    if (const std::string turned = direction(n, v); turned != v) {
        group.v = fmt::format("v{}", id);
        out.add(fmt::format("{}vec3 {} = {};", indent, group.v, turned), n.id);
    }
    return group;
}

std::string CodeWriter::comment(const FieldNode& n) {
    if (n.name.empty() && n.kind->role == Role::instance) return "";  // the function's name tells
    return n.name.empty()             ? n.kind->key
           : n.kind->takes_children() ? fmt::format("{} ({})", n.name, n.kind->key)
                                      : n.name;
}

Result CodeWriter::node(const FieldNode& n, const std::string& p, CodeLines& out, const std::string& indent) {
    return n.kind->role == Role::instance ? instance(n, p, out, indent)
           : n.kind->takes_children()     ? group(n, p, out, indent)
                                          : primitive(n, p);
}

Result CodeWriter::instance(const FieldNode& n, const std::string& p, CodeLines& out, const std::string& indent) {
    const Numbers own = numbers(n, p);
    const Result& shown = materials_[n.definition];
    if (!shown.varies)
        return {fmt::format("{}{}_distance({})", own.factor, CodeNames::of_definition(n.definition), own.point),
                with_material_ ? with_inherited(shown.material, own.material) : ""};
    const int id = next_child_++;
    const Result result{fmt::format("e{}", id), fmt::format("n{}", id), true, true};
    out.add(fmt::format("{}uint {};", indent, result.material), n.id);
    out.add(fmt::format("{}float {} = {}{}_surface({}, {}, {});", indent, result.distance, own.factor,
                        CodeNames::of_definition(n.definition), own.point, own.material, result.material),
            n.id, comment(n));
    return result;
}

std::string CodeWriter::with_inherited(std::string material, const std::string& inherited) {
    const std::string_view word = "inherited";
    if (const std::size_t at = material.find(word); at != std::string::npos)
        material.replace(at, word.size(), inherited);
    return material;
}

void CodeWriter::custom_functions(const FieldNode& n, std::set<Id>& done, CodeLines& out, std::string& called) {
    for (const FieldNode& child : n.children) custom_functions(child, done, out, called);
    if (!n.code || !done.insert(n.id).second) return;
    const bool live = block_.is_live(n);
    std::size_t at = live ? block_.first(n) + ParameterBlock::parameters_offset : 0;
    std::vector<std::string> arguments;
    for (std::size_t i = 0; i < n.parameters.size(); ++i) {
        arguments.push_back(live ? read(n.parameters[i], at) : written(n.parameters[i], n.values[i]));
        at += static_cast<std::size_t>(n.parameters[i].components());
    }
    const std::string suffix = names_.of_custom(n);
    const auto code = [&](const std::string& ending) {
        return n.code->glsl(ending, std::span(arguments).subspan(n.kind->parameters.size()));
    };
    out.add("", n.id, comment(n));
    out.add_as_it_is(code(names_.in(suffix)), code(suffix.substr(1)), n.id);
    out.add("", n.id);
    out.add(fmt::format("float sdf_{}_in_bounds(vec3 p) {{", suffix), n.id);
    out.add(fmt::format("    vec3 nearest = nearest_custom(p, {});", arguments[0]), n.id);
    out.add(fmt::format("    return custom_distance(sdf_{}(nearest), {}, p, nearest, {});", suffix,
                        literal(n.code->lipschitz()), arguments[0]),
            n.id);
    out.add("}", n.id);
    out.add("");
    called += n.code->called() + "nearest_custom custom_distance ";
}

Result CodeWriter::primitive(const FieldNode& n, const std::string& p) {
    const Numbers own = numbers(n, p);
    if (n.code)
        return {fmt::format("{}sdf_{}_in_bounds({})", own.factor, names_.of_custom(n), own.point),
                with_material_ ? own.material : ""};
    return {fmt::format("{}{}({}{})", own.factor, n.kind->function, own.point, own.arguments),
            with_material_ ? own.material : ""};
}

Result CodeWriter::group(const FieldNode& n, const std::string& p, CodeLines& out, const std::string& indent) {
    const KindInfo& kind = *n.kind;
    const int id = next_group_++;
    out.add(indent, n.id, comment(n));

    const Numbers num = numbers(n, p);
    std::string own = p;
    if (num.point != p) {
        own = fmt::format("p{}", id);
        out.add(fmt::format("{}vec3 {} = {};", indent, own, num.point), n.id);
    }
    Result result;
    switch (kind.role) {
        case Role::combine:
            result = fold(n, num, own, id, out, indent);
            break;
        case Role::distance:
            result = fold(n, num, own, id, out, indent);
            set(result, fmt::format("{}({}{})", kind.function, result.distance, num.arguments), n, out, indent);
            break;
        case Role::domain:
            result = domain(n, num, own, id, out, indent);
            break;
        case Role::repeat:
            result = repeat(n, num, own, id, out, indent);
            break;
        case Role::primitive:
        case Role::instance:
            break;
    }
    if (!num.factor.empty()) set(result, num.factor + result.distance, n, out, indent);
    result.named = true;
    return result;
}

void CodeWriter::set(const Result& result, const std::string& value, const FieldNode& n, CodeLines& out,
                     const std::string& indent) {
    out.add(fmt::format("{}{} = {};", indent, result.distance, value), n.id);
}

Result CodeWriter::fold(const FieldNode& n, const Numbers& num, const std::string& p, int id, CodeLines& out,
                        const std::string& indent) {
    const KindInfo& kind = *n.kind;
    Result result;
    for (const FieldNode& child : n.children) {
        Result next = node(child, p, out, indent);
        const bool named = next.named;
        const std::string name = named ? "" : comment(child);
        if (result.distance.empty()) {
            result = next;
            if (named) continue;
            result.distance = fmt::format("d{}", id);
            out.add(fmt::format("{}float {} = {};", indent, result.distance, next.distance), child.id, name);
            continue;
        }
        const bool other_material = next.material != result.material;
        if (other_material) {
            if (!named) {
                const std::string e = fmt::format("e{}", next_child_++);
                out.add(fmt::format("{}float {} = {};", indent, e, next.distance), child.id, name);
                next.distance = e;
            }
            const std::string m = fmt::format("m{}", id), blended = blend(kind, num, result, next);
            out.add(fmt::format("{}{}{} = {};", indent, result.material == m ? "" : "uint ", m, blended), child.id);
            result.material = m;
            result.varies = true;
        }
        out.add(
            fmt::format("{}{} = {};", indent, result.distance, combination(kind, num, result.distance, next.distance)),
            child.id, other_material ? "" : name);
    }
    return result;
}

std::string CodeWriter::combination(const KindInfo& kind, const Numbers& num, const std::string& a,
                                    const std::string& b) {
    if (kind.role != Role::combine) return fmt::format("min({}, {})", a, b);
    if (num.hard && kind.when_zero) return fmt::format(fmt::runtime(kind.when_zero), a, b);
    return fmt::format("{}({}, {}{})", kind.function, a, b, num.arguments);
}

std::string CodeWriter::blend(const KindInfo& kind, const Numbers& num, const Result& so_far, const Result& next) {
    const std::string& a = so_far.distance;
    const std::string& b = next.distance;
    if (kind.role != Role::combine || (num.hard && kind.when_zero)) {
        const KindInfo& hard = kind.role == Role::combine ? kind : info(NodeKind::union_);
        return fmt::format("{} ? {} : {}", fmt::format(fmt::runtime(hard.second_shows), a, b), next.material,
                           so_far.material);
    }
    return fmt::format("blend_materials({}, {}, {}({}, {}{}))", so_far.material, next.material, kind.secondary, a, b,
                       num.arguments);
}

Result CodeWriter::domain(const FieldNode& n, const Numbers& num, const std::string& p, int id, CodeLines& out,
                          const std::string& indent) {
    std::string nearest = p, moved = p;
    if (!num.low.empty()) {
        nearest = fmt::format("c{}", id);
        out.add(fmt::format("{}vec3 {} = clamp({}, {}, {});", indent, nearest, p, num.low, num.high), n.id);
    }
    if (n.kind->function) {
        moved = fmt::format("q{}", id);
        out.add(fmt::format("{}vec3 {} = {}({}{}{});", indent, moved, n.kind->function, nearest, num.arguments,
                            n.kind->function_takes_derived ? num.derived : ""),
                n.id);
    }
    const Result result = fold(n, num, moved, id, out, indent);
    const std::string& d = result.distance;
    if (n.kind->secondary)
        set(result, fmt::format("{}({}, {}{}{})", n.kind->secondary, d, nearest, num.arguments, num.derived), n, out,
            indent);
    if (nearest != p) set(result, fmt::format("beyond({}, {} - {})", d, p, nearest), n, out, indent);
    return result;
}

Result CodeWriter::repeat(const FieldNode& n, const Numbers& num, const std::string& p, int id, CodeLines& out,
                          const std::string& indent) {
    const KindInfo& kind = *n.kind;
    const bool live = block_.is_live(n) || block_.is_derived_live(n);
    const std::string args = num.arguments + num.derived;
    const std::string cells =
        live ? fmt::format("{}({})", kind.secondary, args.substr(2)) : std::to_string(kind.cells(n.values));
    if (cells == "1") {
        const std::string q = fmt::format("q{}", id);
        out.add(fmt::format("{}vec3 {} = {}({}{}, 0);", indent, q, kind.function, p, args), n.id);
        return fold(n, num, q, id, out, indent);
    }
    const int copy_id = next_copy_++;
    const std::string content = fmt::format("distance_of_copy{}", copy_id),
                      material_of = fmt::format("material_of_copy{}", copy_id);
    CodeLines body{names_};
    const Result copy = fold(n, num, "p", id, body, "    ");
    const std::string region = fmt::format("{}, {}, {}", args, num.low, num.high);
    if (n.guarded) set(copy, fmt::format("{}({}, p{})", kind.guard_copy, copy.distance, region), n, body, "    ");
    const bool materials = copy.varies;
    if (writes_copies_ && (!with_material_ || materials)) {
        functions_.add(with_material_
                           ? fmt::format("uint {}(vec3 p{}) {{", material_of, in_definition_ ? ", uint inherited" : "")
                           : fmt::format("float {}(vec3 p) {{", content),
                       n.id, "one copy of " + comment(n));
        functions_.append(body);
        functions_.add(fmt::format("    return {};", with_material_ ? copy.material : copy.distance));
        functions_.add("}");
        functions_.add("");
    }

    const std::string d = fmt::format("d{}", id);
    const auto place = [&](const std::string& cell) {
        return fmt::format("{}({}{}, {})", kind.function, p, args, cell);
    };
    const bool written_out = !live && writes_out_cells(n);
    out.add(fmt::format("{}float {} = {};", indent, d, literal(empty_distance)), n.id);
    if (!materials) {
        out.add_for_cells(indent, cells, written_out, n.id, [&](const std::string& cell) {
            return std::vector{fmt::format("{} = min({}, {}({}));", d, d, content, place(cell))};
        });
        if (n.guarded) out.add(fmt::format("{}{} = {}({}, {}{});", indent, d, kind.guard_nearest, d, p, region), n.id);
        return {d, copy.material};
    }
    const std::string nearest = fmt::format("q{}", id), q = fmt::format("r{}", id),
                      e = fmt::format("e{}", next_child_++);
    out.add(fmt::format("{}vec3 {} = {};", indent, nearest, p), n.id);
    out.add_for_cells(indent, cells, written_out, n.id, [&](const std::string& cell) {
        return std::vector{fmt::format("vec3 {} = {};", q, place(cell)),
                           fmt::format("float {} = {}({});", e, content, q),
                           fmt::format("{} = {} < {} ? {} : {};", nearest, e, d, q, nearest),
                           fmt::format("{} = min({}, {});", d, d, e)};
    });
    if (n.guarded) out.add(fmt::format("{}{} = {}({}, {}{});", indent, d, kind.guard_nearest, d, p, region), n.id);
    const std::string m = fmt::format("m{}", id);
    out.add(fmt::format("{}uint {} = {}({}{});", indent, m, material_of, nearest, in_definition_ ? ", inherited" : ""),
            n.id);
    return {d, m, true, true};
}

}  // namespace farfield
