#include "app/check.h"

#include "sdf/audit.h"
#include "sdf/evaluate.h"
#include "sdf/located_json.h"
#include "sdf/scene_file.h"
#include "sdf/scene_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <sstream>
#include <unordered_map>

namespace farfield {
namespace {

/// Where nodes stand in the file: "LINE: PATH", as in messages about errors.
class Places {
public:
    Places(const std::filesystem::path& file, const Scene& scene) {
        std::ifstream in(file, std::ios::binary);
        std::ostringstream text;
        text << in.rdbuf();
        try {
            const Json document = parse_json(text.str());
            const JsonPath top;
            if (const Json* root = document.find(format::root))
                visit(scene.root, *root, {&top, format::root, -1, root});
            if (const Json* list = document.find(format::definitions))
                visit_list(scene.definitions, *list, {&top, format::definitions});
        } catch (const JsonError&) {  // changed since the scene was read: then there are no lines
        }
    }

    std::string of(const Scene& scene, Id id) const {
        const auto found = places_.find(id);
        const Node* node = find_node(scene, id);
        return found != places_.end() ? found->second : node ? display_name(scene, *node) : "scene";
    }

private:
    void visit(const Node& node, const Json& json, const JsonPath& path) {
        places_[node.id] = fmt::format("{}: {}", json.line, path.text());
        if (const Json* children = json.find(format::children))
            visit_list(node.children, *children, {&path, format::children});
    }
    void visit_list(const std::vector<Node>& nodes, const Json& json, const JsonPath& path) {
        const auto* array = json.as<Json::Array>();
        if (!array || array->size() != nodes.size()) return;
        for (std::size_t i = 0; i < array->size(); ++i)
            visit(nodes[i], (*array)[i], {&path, {}, static_cast<int>(i), &(*array)[i]});
    }

    std::unordered_map<Id, std::string> places_;
};

using Row = std::array<std::string, 6>;
constexpr bool to_the_right[] = {false, false, true, true, false, false};

/// Columns as wide as what is in them: characters, of which UTF-8 has one for each byte that continues none.
std::size_t width(std::string_view text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

void print_table(const std::vector<Row>& rows) {
    std::array<std::size_t, 6> widths{};
    for (const Row& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width(row[i]));
    for (const Row& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i) {
            const std::string space(widths[i] - width(row[i]), ' ');
            line += to_the_right[i] ? space + row[i] : row[i] + space;
            if (i + 1 < row.size()) line += "  ";
        }
        line.erase(line.find_last_not_of(' ') + 1);
        fmt::print("{}\n", line);
    }
}

std::string range_text(const Box& box, int axis) {
    if (box.is_bounded(axis)) return fmt::format("{:.3g} to {:.3g}", box.low[axis], box.high[axis]);
    const bool low = !is_unbounded(box.low[axis]), high = !is_unbounded(box.high[axis]);
    if (low) return fmt::format("from {:.3g}", box.low[axis]);
    return high ? fmt::format("up to {:.3g}", box.high[axis]) : "no end";
}

void print_facts(const Scene& scene, const FieldEvaluator& field) {
    const Box box = field.tree().bounds();
    if (!field.tree().root) {
        fmt::print("bounds  none: there is no shape\n");
        return;
    }
    fmt::print("bounds  x {}, y {}, z {} m\n", range_text(box, 0), range_text(box, 1), range_text(box, 2));
    const float distance = field.distance(scene.camera.position);
    fmt::print("camera  {}, at least {:.3g} m from the surface\n",
               distance < 0.0f ? "inside of something solid" : "outside of what is solid", std::abs(distance));
}

}  // namespace

int run_check(const CheckOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    const Scene scene = load_scene(options.scene);
    const std::string file = options.scene.string();
    int instances = 0;
    for (const Node& definition : scene.definitions) instances += count_uses(scene, definition.id);
    fmt::print("{}: {} nodes, {} definitions, {} instances, {} materials, {} lights\n", file, count_nodes(scene),
               scene.definitions.size(), instances, scene.materials.size(), scene.lights.size());
    print_facts(scene, FieldEvaluator(scene));

    AuditOptions audit_options;
    audit_options.samples = options.samples;
    const Audit result = audit(scene, audit_options);
    std::vector<Row> rows{{"node", "kind", "Lipschitz", "slope", "size", "the Lipschitz constant's origin"}};
    for (const NodeAudit& node : result.nodes) {
        const Node* in_scene = find_node(scene, node.id);
        Row row{std::string(2 * static_cast<std::size_t>(node.depth), ' ') +
                    (in_scene ? display_name(scene, *in_scene) : ""),
                node.kind->key,
                "",
                "",
                "",
                node.origin};
        if (node.shows) row[2] = fmt::format("{:.4g}", node.stretch), row[4] = size_text(node.world);
        if (node.samples > 0) row[3] = fmt::format("{:.3f}", node.slope);
        if (node.unsafe_slope) row[5] += fmt::format("; {:.3g} found", *node.unsafe_slope);
        rows.push_back(std::move(row));
    }
    fmt::print("\n");
    print_table(rows);

    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    fmt::print("\nslope: the steepest among {} pairs of points for each node, at most 1 where it is safe; {:.1f} s\n",
               options.samples, seconds.count());
    fmt::print("{} {}\n", result.findings.size(), result.findings.size() == 1 ? "warning" : "warnings");
    const Places places(options.scene, scene);
    std::fflush(stdout);
    for (const Finding& finding : result.findings)
        std::fputs(fmt::format("{}:{}: {}\n", file, places.of(scene, finding.node), finding.message).c_str(), stderr);
    return 0;
}

}  // namespace farfield
