#include "sdf/codegen.h"

#include "sdf/evaluate.h"
#include "sdf/shape_library.h"

#include <fmt/format.h>

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
        for (int row = 0; row < 3; ++row)
            text += literal(m[column][row]) + (column == 2 && row == 2 ? ")" : ", ");
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

/// Writes one function body, for the distance alone or for distance and material together.
class Writer {
public:
    Writer(const Scene& scene, Tier tier, bool with_material, std::vector<float>& parameters)
        : scene_(scene), tier_(tier), with_material_(with_material), parameters_(parameters) {}

    Lines write() {
        Lines body;
        std::optional<Result> result;
        if (!is_empty(scene_.root)) result = node(scene_.root, "p", 0, body, "    ");
        Lines all;
        all.append(functions_);
        all.add(with_material_ ? "uint scene_material(vec3 p) {" : "float scene_distance(vec3 p) {");
        all.append(body);
        const std::string nothing = with_material_ ? "0u" : literal(empty_distance);
        all.add(fmt::format("    return {};", !result ? nothing : with_material_ ? result->material : result->distance));
        all.add("}");
        return all;
    }

private:
    /// A value of the parameter block (live) or its literal.
    std::string number(float v) {
        if (tier_ == Tier::specialised) return literal(v);
        parameters_.push_back(v);
        return fmt::format("parameter({})", parameters_.size() - 1);
    }
    std::string vector(glm::vec3 v) {
        if (tier_ == Tier::specialised) return literal(v);
        for (int i = 0; i < 3; ++i) parameters_.push_back(v[i]);
        return fmt::format("parameter3({})", parameters_.size() - 3);
    }

    /// p in the node's own frame.
    std::string own_point(const Transform& t, const std::string& p) {
        const glm::mat3 inverse = glm::transpose(rotation_matrix(t));
        if (tier_ == Tier::live) {
            const std::size_t first = parameters_.size();
            for (int i = 0; i < 3; ++i) parameters_.push_back(t.translate[i]);
            for (int i = 0; i < 9; ++i) parameters_.push_back(inverse[i / 3][i % 3]);
            parameters_.push_back(t.scale);
            return fmt::format("place({}, {})", p, first);
        }
        const bool moved = t.translate != glm::vec3(0.0f), turned = inverse != glm::mat3(1.0f), scaled = t.scale != 1.0f;
        std::string q = moved ? fmt::format("{} - {}", p, literal(t.translate)) : p;
        if (moved && (turned || scaled)) q = "(" + q + ")";
        if (turned) q = literal(inverse) + " * " + q;
        if (scaled) q += " / " + literal(t.scale);
        return q;
    }
    /// The factor that brings own distances to the parent's frame, as "0.5 * " or nothing. Follows own_point.
    std::string scale_factor(const Transform& t) {
        if (tier_ == Tier::live) return fmt::format("parameter({}) * ", parameters_.size() - 1);
        return t.scale == 1.0f ? "" : literal(t.scale) + " * ";
    }

    /// The parameters as further arguments: ", a, b".
    std::string arguments(const Node& n, const KindInfo& kind) {
        std::string text;
        for (std::size_t i = 0; i < kind.parameters.size(); ++i) {
            const glm::vec3 v = to_code_units(kind.parameters[i], n.values[i]);
            text += ", " + (kind.parameters[i].components() == 1 ? number(v.x) : vector(v));
        }
        return text;
    }

    std::string material(std::uint32_t index) {
        if (tier_ == Tier::specialised) return fmt::format("{}u", index);
        parameters_.push_back(static_cast<float>(index));
        return fmt::format("uint(parameter({}))", parameters_.size() - 1);
    }

    std::string comment(const Node& n) const {
        const KindInfo& kind = info(n.kind);
        return n.name.empty() ? kind.key : kind.takes_children() ? fmt::format("{} ({})", n.name, kind.key) : n.name;
    }

    Result node(const Node& n, const std::string& p, std::uint32_t inherited, Lines& out, const std::string& indent) {
        const KindInfo& kind = info(n.kind);
        const std::uint32_t index = material_index(scene_, n.material, inherited);
        return kind.role == Role::primitive ? primitive(n, kind, p, index) : group(n, kind, p, index, out, indent);
    }

    Result primitive(const Node& n, const KindInfo& kind, const std::string& p, std::uint32_t index) {
        const std::string point = own_point(n.transform, p);
        const std::string factor = scale_factor(n.transform);
        const std::string call = fmt::format("{}{}({}{})", factor, kind.function, point, arguments(n, kind));
        return {call, with_material_ ? material(index) : ""};
    }

    Result group(const Node& n, const KindInfo& kind, const std::string& p, std::uint32_t index, Lines& out,
                 const std::string& indent) {
        const int id = next_group_++;
        const std::string q = fmt::format("p{}", id), d = fmt::format("d{}", id);
        const Result result{d, with_material_ ? fmt::format("m{}", id) : ""};
        out.add(indent + "// " + comment(n), n.id);

        std::string own = own_point(n.transform, p);
        const std::string factor = scale_factor(n.transform);
        if (own != p) {
            out.add(fmt::format("{}vec3 {} = {};", indent, q, own), n.id);
            own = q;
        }
        std::string args = arguments(n, kind);
        switch (kind.role) {
            case Role::combine: fold(n, kind, args, own, index, result, out, indent); break;
            case Role::distance:
                fold(n, kind, args, own, index, result, out, indent);
                out.add(fmt::format("{}{} = {}({}{});", indent, d, kind.function, d, args), n.id);
                break;
            case Role::domain: {
                const std::string moved = fmt::format("q{}", id);
                out.add(fmt::format("{}vec3 {} = {}({}{});", indent, moved, kind.function, own, args), n.id);
                fold(n, kind, args, moved, index, result, out, indent);
                if (kind.secondary)
                    out.add(fmt::format("{}{} = {}({}, {}{});", indent, d, kind.secondary, d, own, args), n.id);
                break;
            }
            case Role::repeat: repeat(n, kind, args, own, index, result, id, out, indent); break;
            case Role::primitive: break;
        }
        if (!factor.empty()) out.add(fmt::format("{}{} = {}{};", indent, d, factor, d), n.id);
        return result;
    }

    /// Declares the result and folds the children into it, one line each.
    void fold(const Node& n, const KindInfo& kind, const std::string& args, const std::string& p, std::uint32_t index,
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
                const std::string share = kind.role == Role::combine
                                              ? fmt::format("{}({}, {}{})", kind.secondary, d, next.distance, args)
                                              : fmt::format("union_weight({}, {}, 0.0)", d, next.distance);
                out.add(fmt::format("{}{} = blend_materials({}, {}, {});", indent, m, m, next.material, share), child.id);
            }
            out.add(fmt::format("{}{} = {};", indent, d, combination(n, kind, args, d, next.distance)), child.id,
                    with_material_ ? "" : name);
        }
    }

    std::string combination(const Node& n, const KindInfo& kind, const std::string& args, const std::string& a,
                            const std::string& b) const {
        if (kind.role != Role::combine) return fmt::format("min({}, {})", a, b);
        bool all_zero = true;
        for (const glm::vec3& v : n.values) all_zero = all_zero && v == glm::vec3(0.0f);
        if (tier_ == Tier::specialised && all_zero) return fmt::format(fmt::runtime(kind.when_zero), a, b);
        return fmt::format("{}({}, {}{})", kind.function, a, b, args);
    }

    /// The content becomes a function of its own, called for each cell that can hold the nearest copy.
    void repeat(const Node& n, const KindInfo& kind, const std::string& args, const std::string& p, std::uint32_t index,
                const Result& result, int id, Lines& out, const std::string& indent) {
        const std::string& d = result.distance;
        const std::string content = fmt::format("distance_of_copy{}", id), material_of = fmt::format("material_of_copy{}", id);
        Lines body;
        fold(n, kind, args, "p", index, {"d", with_material_ ? "m" : ""}, body, "    ");
        functions_.add(with_material_ ? fmt::format("uint {}(vec3 p) {{", material_of) : fmt::format("float {}(vec3 p) {{", content),
                       n.id, "one copy of " + display_name(n));
        functions_.append(body);
        functions_.add(with_material_ ? "    return m;" : "    return d;");
        functions_.add("}");
        functions_.add("");

        std::string cells;
        if (tier_ == Tier::live) {
            cells = fmt::format("{}({})", kind.secondary, args.substr(2));
        } else {
            std::vector<glm::vec3> values;
            for (std::size_t i = 0; i < n.values.size(); ++i) values.push_back(to_code_units(kind.parameters[i], n.values[i]));
            cells = std::to_string(kind.cells(values));
        }
        const std::string loop = fmt::format("{}for (int cell = 0; cell < {}; ++cell)", indent, cells);
        const std::string copy = fmt::format("{}({}{}, cell)", kind.function, p, args);
        out.add(fmt::format("{}float {} = {};", indent, d, literal(empty_distance)), n.id);
        if (!with_material_) {
            out.add(fmt::format("{} {} = min({}, {}({}));", loop, d, d, content, copy), n.id);
            return;
        }
        const std::string nearest = fmt::format("q{}", id), q = fmt::format("r{}", id), e = fmt::format("e{}", next_child_++);
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
    Tier tier_;
    bool with_material_;
    std::vector<float>& parameters_;
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
    "    return mat3(parameter3(i + 3), parameter3(i + 6), parameter3(i + 9)) * (p - parameter3(i)) / parameter(i + 12);\n"
    "}\n";

}  // namespace

GeneratedScene generate(const Scene& scene, Tier tier) {
    GeneratedScene generated;
    const Lines distance = Writer(scene, tier, false, generated.parameters).write();
    // Both functions read one block: the second walk repeats the first one's values and adds the materials' indices.
    const Lines material = Writer(scene, tier, true, generated.parameters).write();

    Lines all;
    std::string library = used_shapes(distance.key + material.key);
    if (tier == Tier::live) library += std::string(live_helpers) + "\n";
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
    generated.line_nodes = std::move(all.nodes);
    return generated;
}

}  // namespace farfield
