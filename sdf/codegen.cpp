#include "sdf/codegen.h"

#include "sdf/custom_suffixes.h"
#include "sdf/field_tree.h"
#include "sdf/shape_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

namespace farfield {
namespace {

/// A float as a GLSL literal that reads back to the same bits.
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

/// Code calls a definition "@" and its number; the text has a name there, the key, which does not depend on names, the
/// number.
std::string with_names(const std::string& code, const std::vector<std::string>& names) {
    std::string text;
    std::size_t from = 0;
    for (std::size_t at = code.find('@'); at != std::string::npos; at = code.find('@', from)) {
        std::size_t number = 0;
        text += code.substr(from, at - from);
        for (from = at + 1; from < code.size() && code[from] >= '0' && code[from] <= '9'; ++from)
            number = 10 * number + static_cast<std::size_t>(code[from] - '0');
        text += from > at + 1 && number < names.size() ? names[number] : code.substr(at, from - at);
    }
    return text + code.substr(from);
}

/// Lines of code with the nodes they belong to; the key gathers the code alone.
struct Lines {
    const std::vector<std::string>& names;  ///< of definitions
    std::string text = {};
    std::string key = {};
    std::vector<Id> nodes = {};

    void add(const std::string& code, Id node = 0, const std::string& comment = {}) {
        const std::size_t column = 72;
        const bool blank = code.find_first_not_of(' ') == std::string::npos;
        std::string line = with_names(code, names);
        if (!comment.empty()) {
            if (!blank) line += std::string(line.size() < column ? column - line.size() : 1, ' ') + " ";
            line += "// " + comment;
            std::replace(line.begin(), line.end(), '\\', '/');  // at the end of a line it would continue the comment
        }
        text += line + "\n";
        if (!blank) key += code + "\n";
        nodes.push_back(node);
    }
    /// A line of the user's own, in which @ means nothing.
    void add_as_it_is(const std::string& code, Id node) {
        text += code + "\n";
        key += code + "\n";
        nodes.push_back(node);
    }
    void append(const Lines& other) {
        text += other.text;
        key += other.key;
        nodes.insert(nodes.end(), other.nodes.begin(), other.nodes.end());
    }
};

/// Names by which the code can call the definitions, made from their own: of letters, digits and single underscores, in
/// a form that no keyword has and no other function of the program. They stand before "_distance" and "_surface".
std::vector<std::string> code_names(const std::vector<FieldNode>& definitions) {
    std::vector<std::string> names;
    std::set<std::string> taken{"scene", "no"};  // scene_distance, no_surface
    std::map<std::string, int> numbers;
    for (const FieldNode& definition : definitions) {
        constexpr std::size_t longest = 40;
        std::string name;
        for (const char c : definition.name.substr(0, longest)) {
            const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'), digit = c >= '0' && c <= '9';
            if (letter || digit)
                name += c;
            else if (!name.empty() && name.back() != '_')
                name += '_';
        }
        if (!name.empty() && name.back() == '_') name.pop_back();
        if (name.empty() || (name[0] >= '0' && name[0] <= '9') || name.starts_with("gl_"))
            name = name.empty() ? "part" : "part_" + name;
        std::string free = name;
        int& number = numbers[name];
        while (!taken.insert(free).second || is_shape(free + "_distance") || is_shape(free + "_surface"))
            free = fmt::format("{}_{}", name, number++ + 2);
        names.push_back(free);
    }
    return names;
}

/// What a node comes to in the code: an expression of the distance and one of the material code.
struct Result {
    std::string distance;
    std::string material;
    bool named = false;   ///< the distance is a variable
    bool varies = false;  ///< the material is one: it is not the same everywhere
};

/// Which numbers are live, and where their nodes' values stand in the parameter block: translation, inverse rotation by
/// columns, scale, the kind's parameters, material index. What follows from a node's content stands apart: it is live
/// where anything below is.
class ParameterBlock {
public:
    ParameterBlock(const FieldTree& tree, Tier tier, Id tuned) : all_(tier == Tier::live), tuned_(tuned) {
        if (tuned == 0) return;
        for (const FieldNode& definition : tree.definitions) above_tuned_.push_back(find_above(definition));
        if (tree.root) find_above(*tree.root);
    }

    bool is_live(const FieldNode& n) const { return all_ || (tuned_ != 0 && n.id == tuned_); }
    bool is_derived_live(const FieldNode& n) const { return all_ || nodes_above_tuned_.contains(n.id); }

    /// Index of the node's first value; both functions of the program share it.
    std::size_t first(const FieldNode& n) {
        const auto [place, fresh] = first_.try_emplace(n.id, values.size());
        if (!fresh) return place->second;
        add(n.translate);
        for (int column = 0; column < 3; ++column) add(n.to_own[column]);
        values.push_back(n.scale);
        for (std::size_t i = 0; i < n.parameters.size(); ++i) add(n.parameters[i], n.values[i]);
        values.push_back(n.material == inherited_material ? -1.0f : static_cast<float>(n.material));
        return place->second;
    }
    /// Index of the first derived value; the low and high corner of the region follow where the node needs them.
    std::size_t first_derived(const FieldNode& n) {
        const auto [place, fresh] = first_derived_.try_emplace(n.id, values.size());
        if (!fresh) return place->second;
        for (std::size_t i = 0; i < n.kind->derived.size(); ++i)
            add(n.kind->derived[i], n.values[n.kind->parameters.size() + i]);
        if (n.kind->confined) add(n.region.low), add(n.region.high);
        return place->second;
    }

    std::vector<float> values;

private:
    void add(glm::vec3 v) { values.insert(values.end(), {v.x, v.y, v.z}); }
    void add(const Parameter& parameter, glm::vec3 v) {
        if (parameter.components() == 1)
            values.push_back(v.x);
        else
            add(v);
    }
    /// Whether the tuned node is this one or below it; remembers those for which it is.
    bool find_above(const FieldNode& n) {
        bool found = n.id == tuned_ || (n.kind->role == Role::instance && above_tuned_[n.definition]);
        for (const FieldNode& child : n.children) found = find_above(child) || found;
        if (found) nodes_above_tuned_.insert(n.id);
        return found;
    }

    bool all_;
    Id tuned_;
    std::vector<bool> above_tuned_;  ///< for each definition
    std::set<Id> nodes_above_tuned_;
    std::map<Id, std::size_t> first_, first_derived_;
};

constexpr std::size_t scale_offset = 12, parameters_offset = 13;

/// Writes the functions of the definitions and of the scene, for the distance alone or for distance and material
/// together.
class Writer {
public:
    Writer(const FieldTree& tree, const std::vector<std::string>& names, ParameterBlock& block,
           const CustomSuffixes& suffixes, bool with_material)
        : tree_(tree),
          names_(names),
          block_(block),
          suffixes_(suffixes),
          with_material_(with_material),
          functions_{names} {}

    /// The code of the custom nodes, once for each; `called` gets the names in it that are not its own.
    Lines custom_functions(std::string& called) {
        Lines out{names_};
        std::set<Id> done;
        for (const FieldNode& definition : tree_.definitions) custom_functions(definition, done, out, called);
        if (tree_.root) custom_functions(*tree_.root, done, out, called);
        return out;
    }

    Lines write() {
        for (std::size_t i = 0; i < tree_.definitions.size(); ++i) write_definition(i);
        in_definition_ = false;
        next_group_ = next_child_ = 0;
        Lines body{names_};
        std::optional<Result> result;
        if (tree_.root) result = node(*tree_.root, "p", body, "    ");
        Lines all{names_};
        all.append(functions_);
        all.add(with_material_ ? "float scene_surface(vec3 p, out uint material) {" : "float scene_distance(vec3 p) {");
        all.append(body);
        if (with_material_) all.add(fmt::format("    material = {};", result ? result->material : "0u"));
        all.add(fmt::format("    return {};", result ? result->distance : literal(empty_distance)));
        all.add("}");
        return all;
    }

private:
    /// A definition whose material is the same everywhere needs no function for it.
    void write_definition(std::size_t index) {
        const FieldNode& n = tree_.definitions[index];
        in_definition_ = true;
        next_group_ = next_child_ = 0;
        Lines body{names_};
        const Result result = node(n, "p", body, "    ");
        materials_.push_back(result);
        if (with_material_ && !result.varies) return;
        functions_.add(with_material_
                           ? fmt::format("float @{}_surface(vec3 p, uint inherited, out uint material) {{", index)
                           : fmt::format("float @{}_distance(vec3 p) {{", index),
                       n.id, n.kind->takes_children() ? "" : comment(n));
        functions_.append(body);
        if (with_material_) functions_.add(fmt::format("    material = {};", result.material), n.id);
        functions_.add(fmt::format("    return {};", result.distance), n.id);
        functions_.add("}");
        functions_.add("");
    }

    /// A node's numbers as they stand in the code: literals, or reads of the parameter block.
    struct Numbers {
        std::string point;      ///< p in the node's own frame
        std::string factor;     ///< brings own distances to the parent's frame: "0.5 * " or nothing
        std::string arguments;  ///< the parameters as further arguments: ", a, b"
        std::string derived;    ///< the derived values likewise
        std::string material;   ///< the material's index
        std::string low, high;  ///< corners of the region, where the node is stretched and has an end
        bool hard;              ///< all parameters are known to be zero
    };

    Numbers numbers(const FieldNode& n, const std::string& p) {
        Numbers numbers = block_.is_live(n) ? live_numbers(n, p, block_.first(n)) : literals(n, p);
        if (!block_.is_live(n) && n.material == inherited_material) numbers.material = "inherited";
        add_derived(n, numbers);
        return numbers;
    }

    static std::string read(const Parameter& parameter, std::size_t at) {
        return fmt::format(fmt::runtime(parameter.components() == 1 ? "parameter({})" : "parameter3({})"), at);
    }

    static std::string written(const Parameter& parameter, glm::vec3 v) {
        return parameter.components() == 1 ? literal(v.x) : literal(v);
    }

    Numbers live_numbers(const FieldNode& n, const std::string& p, std::size_t first) const {
        Numbers numbers{fmt::format("place({}, {})", p, first),
                        fmt::format("parameter({}) * ", first + scale_offset),
                        "",
                        "",
                        "",
                        "",
                        "",
                        false};
        std::size_t at = first + parameters_offset;
        for (const Parameter& parameter : n.parameters) {
            numbers.arguments += ", " + read(parameter, at);
            at += static_cast<std::size_t>(parameter.components());
        }
        numbers.material =
            fmt::format(fmt::runtime(in_definition_ ? "live_material({}, inherited)" : "uint(parameter({}))"), at);
        return numbers;
    }

    static Numbers literals(const FieldNode& n, const std::string& p) {
        Numbers numbers{p, "", "", "", fmt::format("{}u", n.material), "", "", true};
        std::string& q = numbers.point;
        const bool moved = n.translate != glm::vec3(0.0f), turned = n.to_own != glm::mat3(1.0f),
                   scaled = n.scale != 1.0f;
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

    void add_derived(const FieldNode& n, Numbers& numbers) {
        const bool live = block_.is_derived_live(n);
        std::size_t at = live ? block_.first_derived(n) : 0;
        for (std::size_t i = 0; i < n.kind->derived.size(); ++i) {
            const Parameter& parameter = n.kind->derived[i];
            const glm::vec3 v = n.values[n.kind->parameters.size() + i];
            numbers.derived += ", " + (live ? read(parameter, at) : written(parameter, v));
            at += static_cast<std::size_t>(parameter.components());
        }
        if (!n.kind->confined) return;
        if (live)
            numbers.low = fmt::format("parameter3({})", at), numbers.high = fmt::format("parameter3({})", at + 3);
        else if (n.region.is_bounded(0) || n.region.is_bounded(1) || n.region.is_bounded(2))
            numbers.low = literal(n.region.low), numbers.high = literal(n.region.high);
    }

    static std::string comment(const FieldNode& n) {
        if (n.name.empty() && n.kind->role == Role::instance) return "";  // the function's name tells
        return n.name.empty()             ? n.kind->key
               : n.kind->takes_children() ? fmt::format("{} ({})", n.name, n.kind->key)
                                          : n.name;
    }

    Result node(const FieldNode& n, const std::string& p, Lines& out, const std::string& indent) {
        return n.kind->role == Role::instance ? instance(n, p, out, indent)
               : n.kind->takes_children()     ? group(n, p, out, indent)
                                              : primitive(n, p);
    }

    Result instance(const FieldNode& n, const std::string& p, Lines& out, const std::string& indent) {
        const Numbers own = numbers(n, p);
        const Result& shown = materials_[n.definition];
        if (!shown.varies)
            return {fmt::format("{}@{}_distance({})", own.factor, n.definition, own.point),
                    with_material_ ? with_inherited(shown.material, own.material) : ""};
        const int id = next_child_++;
        const Result result{fmt::format("e{}", id), fmt::format("n{}", id), true, true};
        out.add(fmt::format("{}uint {};", indent, result.material), n.id);
        out.add(fmt::format("{}float {} = {}@{}_surface({}, {}, {});", indent, result.distance, own.factor,
                            n.definition, own.point, own.material, result.material),
                n.id, comment(n));
        return result;
    }

    /// A definition's material as the instance's function sees it.
    static std::string with_inherited(std::string material, const std::string& inherited) {
        const std::string_view word = "inherited";
        if (const std::size_t at = material.find(word); at != std::string::npos)
            material.replace(at, word.size(), inherited);
        return material;
    }

    void custom_functions(const FieldNode& n, std::set<Id>& done, Lines& out, std::string& called) {
        for (const FieldNode& child : n.children) custom_functions(child, done, out, called);
        if (!n.code || !done.insert(n.id).second) return;
        const bool live = block_.is_live(n);
        std::size_t at = live ? block_.first(n) + parameters_offset : 0;
        std::vector<std::string> arguments;
        for (std::size_t i = 0; i < n.parameters.size(); ++i) {
            arguments.push_back(live ? read(n.parameters[i], at) : written(n.parameters[i], n.values[i]));
            at += static_cast<std::size_t>(n.parameters[i].components());
        }
        const std::string& suffix = suffixes_.of(n);
        out.add("", n.id, comment(n));
        const std::string code = n.code->glsl(suffix, std::span(arguments).subspan(n.kind->parameters.size()));
        for (std::size_t start = 0; start < code.size();) {
            const std::size_t end = std::min(code.find('\n', start), code.size());
            out.add_as_it_is(code.substr(start, end - start), n.id);
            start = end + 1;
        }
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

    Result primitive(const FieldNode& n, const std::string& p) {
        const Numbers own = numbers(n, p);
        if (n.code)
            return {fmt::format("{}sdf_{}_in_bounds({})", own.factor, suffixes_.of(n), own.point),
                    with_material_ ? own.material : ""};
        return {fmt::format("{}{}({}{})", own.factor, n.kind->function, own.point, own.arguments),
                with_material_ ? own.material : ""};
    }

    Result group(const FieldNode& n, const std::string& p, Lines& out, const std::string& indent) {
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

    /// Gives the variable of the distance a new value.
    static void set(const Result& result, const std::string& value, const FieldNode& n, Lines& out,
                    const std::string& indent) {
        out.add(fmt::format("{}{} = {};", indent, result.distance, value), n.id);
    }

    /// Folds the children, one line each, into variables: the first child's where it has some, or those numbered `id`.
    /// The material needs none as long as it is the same.
    Result fold(const FieldNode& n, const Numbers& num, const std::string& p, int id, Lines& out,
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
            out.add(fmt::format("{}{} = {};", indent, result.distance,
                                combination(kind, num, result.distance, next.distance)),
                    child.id, other_material ? "" : name);
        }
        return result;
    }

    static std::string combination(const KindInfo& kind, const Numbers& num, const std::string& a,
                                   const std::string& b) {
        if (kind.role != Role::combine) return fmt::format("min({}, {})", a, b);
        if (num.hard && kind.when_zero) return fmt::format(fmt::runtime(kind.when_zero), a, b);
        return fmt::format("{}({}, {}{})", kind.function, a, b, num.arguments);
    }

    /// The material code where `next` is combined with `so_far`; next.distance must be a variable.
    static std::string blend(const KindInfo& kind, const Numbers& num, const Result& so_far, const Result& next) {
        const std::string& a = so_far.distance;
        const std::string& b = next.distance;
        if (kind.role != Role::combine || (num.hard && kind.when_zero)) {
            const KindInfo& hard = kind.role == Role::combine ? kind : info(NodeKind::union_);
            return fmt::format("{} ? {} : {}", fmt::format(fmt::runtime(hard.second_shows), a, b), next.material,
                               so_far.material);
        }
        return fmt::format("blend_materials({}, {}, {}({}, {}{}))", so_far.material, next.material, kind.secondary, a,
                           b, num.arguments);
    }

    Result domain(const FieldNode& n, const Numbers& num, const std::string& p, int id, Lines& out,
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
            set(result, fmt::format("{}({}, {}{}{})", n.kind->secondary, d, nearest, num.arguments, num.derived), n,
                out, indent);
        if (nearest != p) set(result, fmt::format("beyond({}, {} - {})", d, p, nearest), n, out, indent);
        return result;
    }

    /// The content becomes a function of its own, called for each cell that can hold the nearest copy.
    Result repeat(const FieldNode& n, const Numbers& num, const std::string& p, int id, Lines& out,
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
        Lines body{names_};
        const Result copy = fold(n, num, "p", id, body, "    ");
        if (n.cut) set(copy, fmt::format("{}({}, p{})", kind.cut, copy.distance, args), n, body, "    ");
        const bool materials = copy.varies;
        if (!with_material_ || materials) {
            functions_.add(with_material_ ? fmt::format("uint {}(vec3 p{}) {{", material_of,
                                                        in_definition_ ? ", uint inherited" : "")
                                          : fmt::format("float {}(vec3 p) {{", content),
                           n.id, "one copy of " + comment(n));
            functions_.append(body);
            functions_.add(fmt::format("    return {};", with_material_ ? copy.material : copy.distance));
            functions_.add("}");
            functions_.add("");
        }

        const std::string d = fmt::format("d{}", id);
        const std::string loop = fmt::format("{}for (int cell = 0; cell < {}; ++cell)", indent, cells);
        const std::string place = fmt::format("{}({}{}, cell)", kind.function, p, args);
        out.add(fmt::format("{}float {} = {};", indent, d, literal(empty_distance)), n.id);
        if (!materials) {
            out.add(fmt::format("{} {} = min({}, {}({}));", loop, d, d, content, place), n.id);
            return {d, copy.material};
        }
        const std::string nearest = fmt::format("q{}", id), q = fmt::format("r{}", id),
                          e = fmt::format("e{}", next_child_++);
        out.add(fmt::format("{}vec3 {} = {};", indent, nearest, p), n.id);
        out.add(loop + " {", n.id);
        out.add(fmt::format("{}    vec3 {} = {};", indent, q, place), n.id);
        out.add(fmt::format("{}    float {} = {}({});", indent, e, content, q), n.id);
        out.add(fmt::format("{}    {} = {} < {} ? {} : {};", indent, nearest, e, d, q, nearest), n.id);
        out.add(fmt::format("{}    {} = min({}, {});", indent, d, d, e), n.id);
        out.add(indent + "}", n.id);
        const std::string m = fmt::format("m{}", id);
        out.add(
            fmt::format("{}uint {} = {}({}{});", indent, m, material_of, nearest, in_definition_ ? ", inherited" : ""),
            n.id);
        return {d, m, true, true};
    }

    const FieldTree& tree_;
    const std::vector<std::string>& names_;
    ParameterBlock& block_;
    const CustomSuffixes& suffixes_;
    bool with_material_;
    Lines functions_;
    std::vector<Result> materials_;  ///< of the definitions
    bool in_definition_ = false;
    int next_group_ = 0;
    int next_child_ = 0;
    int next_copy_ =
        0;  ///< counts the same for both kinds of functions, so that they share the contents of repetitions
};

constexpr const char* live_helpers =
    "vec3 parameter3(int i) {\n"
    "    return vec3(parameter(i), parameter(i + 1), parameter(i + 2));\n"
    "}\n"
    "\n"
    "// p in the frame of a node whose translation, inverse rotation (by columns) and scale start at i.\n"
    "vec3 place(vec3 p, int i) {\n"
    "    return mat3(parameter3(i + 3), parameter3(i + 6), parameter3(i + 9)) * (p - parameter3(i)) / parameter(i + "
    "12);\n"
    "}\n";

bool is_flat(const FieldNode& n) {
    return n.code || n.kind->stretch || (n.kind->role == Role::primitive && !n.kind->exact) ||
           std::any_of(n.children.begin(), n.children.end(), is_flat);
}

constexpr const char* inherited_helper =
    "\n"
    "// The material that a node of a definition has by parameter i: that of the instance where there is none.\n"
    "uint live_material(int i, uint inherited) {\n"
    "    return parameter(i) < 0.0 ? inherited : uint(parameter(i));\n"
    "}\n";

Lines write(const FieldTree& tree, ParameterBlock& block, const std::vector<std::string>& names,
            const CustomSuffixes& suffixes) {
    std::string called;
    const Lines custom = Writer(tree, names, block, suffixes, false).custom_functions(called);
    const Lines distance = Writer(tree, names, block, suffixes, false).write();
    const Lines material = Writer(tree, names, block, suffixes, true).write();

    Lines all{names};
    std::string library = used_shapes(called + distance.key + material.key);
    if (!block.values.empty()) library += live_helpers;
    if (material.key.find("live_material(") != std::string::npos) library += inherited_helper;
    if (!block.values.empty()) library += "\n";
    for (std::size_t start = 0; start < library.size();) {
        const std::size_t end = library.find('\n', start);
        all.add(library.substr(start, end - start));
        start = end + 1;
    }
    all.append(custom);
    all.append(distance);
    all.add("");
    all.append(material);
    return all;
}

}  // namespace

GeneratedScene generate(const Scene& scene, Tier tier, Id tuned) {
    GeneratedScene generated;
    const FieldTree tree(scene);
    ParameterBlock block(tree, tier, tuned);
    const std::vector<std::string> names = code_names(tree.definitions);
    const CustomSuffixes suffixes(tree, true);
    Lines all = write(tree, block, names, suffixes);
    // Names of nodes are part of the text, not of the program.
    if (!suffixes.empty()) all.key = write(tree, block, names, CustomSuffixes(tree, false)).key;
    generated.text = std::move(all.text);
    generated.key = std::move(all.key);
    generated.parameters = std::move(block.values);
    generated.line_nodes = std::move(all.nodes);
    generated.bounds = tree.bounds();
    generated.flat =
        (tree.root && is_flat(*tree.root)) || std::any_of(tree.definitions.begin(), tree.definitions.end(), is_flat);
    return generated;
}

}  // namespace farfield
