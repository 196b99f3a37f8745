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

/// Lines of code with the nodes they belong to; the key gathers the code alone.
struct Lines {
    std::string text;
    std::string key;
    std::vector<Id> nodes;

    void add(const std::string& code, Id node = 0, const std::string& comment = {}) {
        const std::size_t column = 72;
        std::string line = code;
        if (!comment.empty()) {
            if (!code.empty()) line += std::string(code.size() < column ? column - code.size() : 1, ' ') + " ";
            line += "// " + comment;
            std::replace(line.begin(), line.end(), '\\', '/');  // at the end of a line it would continue the comment
        }
        text += line + "\n";
        if (!code.empty()) key += code + "\n";
        nodes.push_back(node);
    }
    void append(const Lines& other) {
        text += other.text;
        key += other.key;
        nodes.insert(nodes.end(), other.nodes.begin(), other.nodes.end());
    }
};

/// What a node comes to in the code: an expression of the distance and one of the material code.
struct Result {
    std::string distance;
    std::string material;
};

/// Which numbers are live, and where their nodes' values stand in the parameter block: translation, inverse rotation by
/// columns, scale, the kind's parameters, material index. What follows from a node's content stands apart: it is live
/// where anything below is.
class ParameterBlock {
public:
    ParameterBlock(const FieldTree& tree, Tier tier, Id tuned) : all_(tier == Tier::live), tuned_(tuned) {
        if (tree.root && tuned != 0) find_above(*tree.root);
    }

    bool is_live(const FieldNode& n) const { return all_ || n.id == tuned_; }
    bool is_derived_live(const FieldNode& n) const { return all_ || above_tuned_.contains(n.id); }

    /// Index of the node's first value; both functions of the program share it.
    std::size_t first(const FieldNode& n) {
        const auto [place, fresh] = first_.try_emplace(n.id, values.size());
        if (!fresh) return place->second;
        add(n.translate);
        for (int column = 0; column < 3; ++column) add(n.to_own[column]);
        values.push_back(n.scale);
        for (std::size_t i = 0; i < n.parameters.size(); ++i) add(n.parameters[i], n.values[i]);
        values.push_back(static_cast<float>(n.material));
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
        bool found = n.id == tuned_;
        for (const FieldNode& child : n.children) found = find_above(child) || found;
        if (found) above_tuned_.insert(n.id);
        return found;
    }

    bool all_;
    Id tuned_;
    std::set<Id> above_tuned_;
    std::map<Id, std::size_t> first_, first_derived_;
};

constexpr std::size_t scale_offset = 12, parameters_offset = 13;

/// Writes one function body, for the distance alone or for distance and material together.
class Writer {
public:
    Writer(const FieldTree& tree, ParameterBlock& block, const CustomSuffixes& suffixes, bool with_material)
        : tree_(tree), block_(block), suffixes_(suffixes), with_material_(with_material) {}

    /// The code of the custom nodes, once for each; `called` gets the names in it that are not its own.
    Lines custom_functions(std::string& called) {
        Lines out;
        std::set<Id> done;
        if (tree_.root) custom_functions(*tree_.root, done, out, called);
        return out;
    }

    Lines write() {
        Lines body;
        std::optional<Result> result;
        if (tree_.root) result = node(*tree_.root, "p", body, "    ");
        Lines all;
        all.append(functions_);
        all.add(with_material_ ? "float scene_surface(vec3 p, out uint material) {" : "float scene_distance(vec3 p) {");
        all.append(body);
        if (with_material_) all.add(fmt::format("    material = {};", result ? result->material : "0u"));
        all.add(fmt::format("    return {};", result ? result->distance : literal(empty_distance)));
        all.add("}");
        return all;
    }

private:
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
        add_derived(n, numbers);
        return numbers;
    }

    static std::string read(const Parameter& parameter, std::size_t at) {
        return fmt::format(fmt::runtime(parameter.components() == 1 ? "parameter({})" : "parameter3({})"), at);
    }

    static std::string written(const Parameter& parameter, glm::vec3 v) {
        return parameter.components() == 1 ? literal(v.x) : literal(v);
    }

    static Numbers live_numbers(const FieldNode& n, const std::string& p, std::size_t first) {
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
        numbers.material = fmt::format("uint(parameter({}))", at);
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
        return n.name.empty()             ? n.kind->key
               : n.kind->takes_children() ? fmt::format("{} ({})", n.name, n.kind->key)
                                          : n.name;
    }

    Result node(const FieldNode& n, const std::string& p, Lines& out, const std::string& indent) {
        return n.kind->takes_children() ? group(n, p, out, indent) : primitive(n, p);
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
            out.add(code.substr(start, end - start), n.id);
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
        out.add(indent + "// " + comment(n), n.id);

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
                break;
        }
        if (!num.factor.empty()) set(result, num.factor + result.distance, n, out, indent);
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
            const bool group = child.kind->takes_children();
            const std::string name = group ? "" : comment(child);
            if (result.distance.empty()) {
                result = next;
                if (group) continue;
                result.distance = fmt::format("d{}", id);
                out.add(fmt::format("{}float {} = {};", indent, result.distance, next.distance), child.id, name);
                continue;
            }
            const bool other_material = next.material != result.material;
            if (other_material) {
                if (!group) {
                    const std::string e = fmt::format("e{}", next_child_++);
                    out.add(fmt::format("{}float {} = {};", indent, e, next.distance), child.id, name);
                    next.distance = e;
                }
                const std::string m = fmt::format("m{}", id), blended = blend(kind, num, result, next);
                out.add(fmt::format("{}{}{} = {};", indent, result.material == m ? "" : "uint ", m, blended), child.id);
                result.material = m;
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
            out.add(fmt::format("{}vec3 {} = {}({}{});", indent, moved, n.kind->function, nearest, num.arguments),
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
        const std::string content = fmt::format("distance_of_copy{}", id),
                          material_of = fmt::format("material_of_copy{}", id);
        Lines body;
        const Result copy = fold(n, num, "p", id, body, "    ");
        const bool materials = with_material_ && copy.material.starts_with('m');  // it varies across the copy
        if (!with_material_ || materials) {
            functions_.add(with_material_ ? fmt::format("uint {}(vec3 p) {{", material_of)
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
        out.add(fmt::format("{}uint {} = {}({});", indent, m, material_of, nearest), n.id);
        return {d, m};
    }

    const FieldTree& tree_;
    ParameterBlock& block_;
    const CustomSuffixes& suffixes_;
    bool with_material_;
    Lines functions_;
    int next_group_ = 0;  ///< counts the same in both functions, so that they share the contents of repetitions
    int next_child_ = 0;
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

Lines write(const FieldTree& tree, ParameterBlock& block, const CustomSuffixes& suffixes) {
    std::string called;
    const Lines custom = Writer(tree, block, suffixes, false).custom_functions(called);
    const Lines distance = Writer(tree, block, suffixes, false).write();
    const Lines material = Writer(tree, block, suffixes, true).write();

    Lines all;
    std::string library = used_shapes(called + distance.key + material.key);
    if (!block.values.empty()) library += std::string(live_helpers) + "\n";
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
    const CustomSuffixes suffixes(tree, true);
    Lines all = write(tree, block, suffixes);
    // Names of nodes are part of the text, not of the program.
    if (!suffixes.empty()) all.key = write(tree, block, CustomSuffixes(tree, false)).key;
    generated.text = std::move(all.text);
    generated.key = std::move(all.key);
    generated.parameters = std::move(block.values);
    generated.line_nodes = std::move(all.nodes);
    generated.bounds = tree.bounds();
    return generated;
}

}  // namespace farfield
