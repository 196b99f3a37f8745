#include "sdf/codegen.h"

#include "sdf/evaluate.h"
#include "sdf/shape_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

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
/// columns, scale, the kind's parameters, material index.
class ParameterBlock {
public:
    ParameterBlock(Tier tier, Id tuned) : all_(tier == Tier::live), tuned_(tuned) {}

    bool is_live(const Node& n) const { return all_ || n.id == tuned_; }
    /// Index of the node's first value; both functions of the program share it.
    std::size_t first(const Node& n, const glm::mat3& inverse_rotation, std::uint32_t material) {
        const auto [place, fresh] = first_.try_emplace(n.id, values.size());
        if (!fresh) return place->second;
        add(n.transform.translate);
        for (int column = 0; column < 3; ++column) add(inverse_rotation[column]);
        values.push_back(n.transform.scale);
        for (std::size_t i = 0; i < n.values.size(); ++i) {
            const Parameter& parameter = info(n.kind).parameters[i];
            const glm::vec3 v = to_code_units(parameter, n.values[i]);
            if (parameter.components() == 1)
                values.push_back(v.x);
            else
                add(v);
        }
        values.push_back(static_cast<float>(material));
        return place->second;
    }

    std::vector<float> values;

private:
    void add(glm::vec3 v) { values.insert(values.end(), {v.x, v.y, v.z}); }

    bool all_;
    Id tuned_;
    std::map<Id, std::size_t> first_;
};

constexpr std::size_t scale_offset = 12, parameters_offset = 13;

/// Writes one function body, for the distance alone or for distance and material together.
class Writer {
public:
    Writer(const Scene& scene, ParameterBlock& block, bool with_material)
        : scene_(scene), block_(block), with_material_(with_material) {}

    Lines write() {
        Lines body;
        std::optional<Result> result;
        if (!is_empty(scene_.root)) result = node(scene_.root, "p", 0, body, "    ");
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
        std::string material;   ///< the material's index
        bool hard;              ///< all parameters are known to be zero
    };

    Numbers numbers(const Node& n, const std::string& p, std::uint32_t index) {
        const glm::mat3 inverse = glm::transpose(rotation_matrix(n.transform));
        return block_.is_live(n) ? live_numbers(n, p, block_.first(n, inverse, index)) : literals(n, p, inverse, index);
    }

    static Numbers live_numbers(const Node& n, const std::string& p, std::size_t first) {
        Numbers numbers{fmt::format("place({}, {})", p, first), fmt::format("parameter({}) * ", first + scale_offset),
                        "", "", false};
        std::size_t at = first + parameters_offset;
        for (const Parameter& parameter : info(n.kind).parameters) {
            const int components = parameter.components();
            numbers.arguments +=
                fmt::format(fmt::runtime(components == 1 ? ", parameter({})" : ", parameter3({})"), at);
            at += static_cast<std::size_t>(components);
        }
        numbers.material = fmt::format("uint(parameter({}))", at);
        return numbers;
    }

    static Numbers literals(const Node& n, const std::string& p, const glm::mat3& inverse, std::uint32_t index) {
        const Transform& t = n.transform;
        Numbers numbers{p, "", "", fmt::format("{}u", index), true};
        std::string& q = numbers.point;
        const bool moved = t.translate != glm::vec3(0.0f), turned = inverse != glm::mat3(1.0f),
                   scaled = t.scale != 1.0f;
        if (moved) q = fmt::format("{} - {}", p, literal(t.translate));
        if (moved && (turned || scaled)) q = "(" + q + ")";
        if (turned) q = literal(inverse) + " * " + q;
        if (scaled) {
            q += " / " + literal(t.scale);
            numbers.factor = literal(t.scale) + " * ";
        }
        for (std::size_t i = 0; i < n.values.size(); ++i) {
            const Parameter& parameter = info(n.kind).parameters[i];
            const glm::vec3 v = to_code_units(parameter, n.values[i]);
            numbers.arguments += ", " + (parameter.components() == 1 ? literal(v.x) : literal(v));
            numbers.hard = numbers.hard && v == glm::vec3(0.0f);
        }
        return numbers;
    }

    static std::string comment(const Node& n) {
        const KindInfo& kind = info(n.kind);
        return n.name.empty() ? kind.key : kind.takes_children() ? fmt::format("{} ({})", n.name, kind.key) : n.name;
    }

    Result node(const Node& n, const std::string& p, std::uint32_t inherited, Lines& out, const std::string& indent) {
        const KindInfo& kind = info(n.kind);
        const std::uint32_t index = material_index(scene_, n.material, inherited);
        return kind.role == Role::primitive ? primitive(n, kind, p, index) : group(n, kind, p, index, out, indent);
    }

    Result primitive(const Node& n, const KindInfo& kind, const std::string& p, std::uint32_t index) {
        const Numbers own = numbers(n, p, index);
        return {fmt::format("{}{}({}{})", own.factor, kind.function, own.point, own.arguments),
                with_material_ ? own.material : ""};
    }

    Result group(const Node& n, const KindInfo& kind, const std::string& p, std::uint32_t index, Lines& out,
                 const std::string& indent) {
        const int id = next_group_++;
        const std::string d = fmt::format("d{}", id);
        const Result result{d, with_material_ ? fmt::format("m{}", id) : ""};
        out.add(indent + "// " + comment(n), n.id);

        const Numbers num = numbers(n, p, index);
        const std::string& args = num.arguments;
        std::string own = p;
        if (num.point != p) {
            own = fmt::format("p{}", id);
            out.add(fmt::format("{}vec3 {} = {};", indent, own, num.point), n.id);
        }
        switch (kind.role) {
            case Role::combine:
                fold(n, kind, num, own, index, result, out, indent);
                break;
            case Role::distance:
                fold(n, kind, num, own, index, result, out, indent);
                out.add(fmt::format("{}{} = {}({}{});", indent, d, kind.function, d, args), n.id);
                break;
            case Role::domain: {
                const std::string moved = fmt::format("q{}", id);
                out.add(fmt::format("{}vec3 {} = {}({}{});", indent, moved, kind.function, own, args), n.id);
                fold(n, kind, num, moved, index, result, out, indent);
                if (kind.secondary)
                    out.add(fmt::format("{}{} = {}({}, {}{});", indent, d, kind.secondary, d, own, args), n.id);
                break;
            }
            case Role::repeat:
                repeat(n, kind, num, own, index, result, id, out, indent);
                break;
            case Role::primitive:
                break;
        }
        if (!num.factor.empty()) out.add(fmt::format("{}{} = {}{};", indent, d, num.factor, d), n.id);
        return result;
    }

    /// Declares the result and folds the children into it, one line each.
    void fold(const Node& n, const KindInfo& kind, const Numbers& num, const std::string& p, std::uint32_t index,
              const Result& result, Lines& out, const std::string& indent) {
        const std::string& d = result.distance;
        const std::string& m = result.material;
        bool first = true;
        for (const Node& child : n.children) {
            if (is_empty(child)) continue;
            Result next = node(child, p, index, out, indent);
            const std::string name = info(child.kind).takes_children() ? "" : comment(child);
            if (first) {
                out.add(fmt::format("{}float {} = {};", indent, d, next.distance), child.id, name);
                if (with_material_) out.add(fmt::format("{}uint {} = {};", indent, m, next.material), child.id);
                first = false;
                continue;
            }
            if (with_material_) {
                if (!info(child.kind).takes_children()) {
                    const std::string e = fmt::format("e{}", next_child_++);
                    out.add(fmt::format("{}float {} = {};", indent, e, next.distance), child.id, name);
                    next.distance = e;
                }
                out.add(fmt::format("{}{} = {};", indent, m, blend(kind, num, result, next)), child.id);
            }
            out.add(fmt::format("{}{} = {};", indent, d, combination(kind, num, d, next.distance)), child.id,
                    with_material_ ? "" : name);
        }
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

    /// The content becomes a function of its own, called for each cell that can hold the nearest copy.
    void repeat(const Node& n, const KindInfo& kind, const Numbers& num, const std::string& p, std::uint32_t index,
                const Result& result, int id, Lines& out, const std::string& indent) {
        const std::string& d = result.distance;
        const std::string content = fmt::format("distance_of_copy{}", id),
                          material_of = fmt::format("material_of_copy{}", id);
        Lines body;
        fold(n, kind, num, "p", index, {"d", with_material_ ? "m" : ""}, body, "    ");
        functions_.add(with_material_ ? fmt::format("uint {}(vec3 p) {{", material_of)
                                      : fmt::format("float {}(vec3 p) {{", content),
                       n.id, "one copy of " + display_name(n));
        functions_.append(body);
        functions_.add(with_material_ ? "    return m;" : "    return d;");
        functions_.add("}");
        functions_.add("");

        std::string cells;
        if (block_.is_live(n)) {
            cells = fmt::format("{}({})", kind.secondary, num.arguments.substr(2));
        } else {
            std::vector<glm::vec3> values;
            for (std::size_t i = 0; i < n.values.size(); ++i)
                values.push_back(to_code_units(kind.parameters[i], n.values[i]));
            cells = std::to_string(kind.cells(values));
        }
        const std::string loop = fmt::format("{}for (int cell = 0; cell < {}; ++cell)", indent, cells);
        const std::string copy = fmt::format("{}({}{}, cell)", kind.function, p, num.arguments);
        out.add(fmt::format("{}float {} = {};", indent, d, literal(empty_distance)), n.id);
        if (!with_material_) {
            out.add(fmt::format("{} {} = min({}, {}({}));", loop, d, d, content, copy), n.id);
            return;
        }
        const std::string nearest = fmt::format("q{}", id), q = fmt::format("r{}", id),
                          e = fmt::format("e{}", next_child_++);
        out.add(fmt::format("{}vec3 {} = {};", indent, nearest, p), n.id);
        out.add(loop + " {", n.id);
        out.add(fmt::format("{}    vec3 {} = {};", indent, q, copy), n.id);
        out.add(fmt::format("{}    float {} = {}({});", indent, e, content, q), n.id);
        out.add(fmt::format("{}    {} = {} < {} ? {} : {};", indent, nearest, e, d, q, nearest), n.id);
        out.add(fmt::format("{}    {} = min({}, {});", indent, d, d, e), n.id);
        out.add(indent + "}", n.id);
        out.add(fmt::format("{}uint {} = {}({});", indent, result.material, material_of, nearest), n.id);
    }

    const Scene& scene_;
    ParameterBlock& block_;
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

}  // namespace

GeneratedScene generate(const Scene& scene, Tier tier, Id tuned) {
    GeneratedScene generated;
    ParameterBlock block(tier, tuned);
    const Lines distance = Writer(scene, block, false).write();
    const Lines material = Writer(scene, block, true).write();

    Lines all;
    std::string library = used_shapes(distance.key + material.key);
    if (!block.values.empty()) library += std::string(live_helpers) + "\n";
    for (std::size_t start = 0; start < library.size();) {
        const std::size_t end = library.find('\n', start);
        all.add(library.substr(start, end - start));
        start = end + 1;
    }
    all.append(distance);
    all.add("");
    all.append(material);
    generated.text = std::move(all.text);
    generated.key = std::move(all.key);
    generated.parameters = std::move(block.values);
    generated.line_nodes = std::move(all.nodes);
    return generated;
}

}  // namespace farfield
