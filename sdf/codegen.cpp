#include "sdf/codegen.h"

#include "sdf/cast_writer.h"
#include "sdf/march_writer.h"
#include "sdf/shape_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

namespace farfield {
namespace {

constexpr std::uint64_t largest_march = 1500;

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
           std::any_of(n.children.begin(), n.children.end(), [](const FieldNode& child) { return is_flat(child); });
}

bool is_flat(const FieldTree& tree) {
    return (tree.root && is_flat(*tree.root)) ||
           std::any_of(tree.definitions.begin(), tree.definitions.end(),
                       [](const FieldNode& definition) { return is_flat(definition); });
}

/// Of the node's loops in one evaluation, `definitions` those of the tree's. A loop takes two turns more than those
/// that do something, because it ends with one and drivers may add one.
double loop_turns(const FieldNode& n, const std::vector<double>& definitions, bool live) {
    double turns = n.kind->role == Role::instance ? definitions[n.definition] : 0.0;
    for (const FieldNode& child : n.children) turns += loop_turns(child, definitions, live);
    if (n.kind->role == Role::repeat) {
        const double cells = n.kind->cells(n.values);
        turns = turns * cells + (live || !writes_out_cells(n) ? cells + 2.0 : 0.0);
    }
    if (n.kind->turns) turns += n.kind->turns(n.values) + 2.0;
    return n.code ? turns + n.code->loop_turns() : turns;
}

/// Twice that, because the distance may be asked for beside how far the ray may go.
std::uint64_t loop_turns(const FieldTree& tree, bool live) {
    std::vector<double> definitions;
    for (const FieldNode& definition : tree.definitions)
        definitions.push_back(loop_turns(definition, definitions, live));
    return tree.root ? static_cast<std::uint64_t>(std::min(2.0 * loop_turns(*tree.root, definitions, live), 1e9)) : 0;
}

constexpr const char* direction_helper =
    "\n"
    "// The same for a direction, which stays a unit vector.\n"
    "vec3 turn(vec3 v, int i) {\n"
    "    return mat3(parameter3(i + 3), parameter3(i + 6), parameter3(i + 9)) * v;\n"
    "}\n";

constexpr const char* inherited_helper =
    "\n"
    "// The material that a node of a definition has by parameter i: that of the instance where there is none.\n"
    "uint live_material(int i, uint inherited) {\n"
    "    return parameter(i) < 0.0 ? inherited : uint(parameter(i));\n"
    "}\n";

CodeLines write_for_rays(const FieldTree& tree, ParameterBlock& block, const CodeNames& names, bool by_distance,
                         GeneratedScene& generated) {
    CastAndMarched rays{{}, tree};
    if (!by_distance) rays = divide_for_rays(tree, block);
    const FieldTree& marched = rays.marched;
    generated.casts = rays.cast.root.has_value();
    generated.marches = marched.root || !generated.casts;
    generated.loop_turns = generated.marches ? loop_turns(marched, !block.values.empty()) : 0;
    generated.marches_flat = is_flat(marched);
    generated.marched_bounds = marched.bounds();
    CodeLines all{names};
    if (generated.casts) all.append(CastWriter(rays.cast, names, block).write());
    if (generated.casts && generated.marches) all.add("");
    if (generated.marches) all.append(MarchWriter(marched, names, block, by_distance, !generated.casts).write());
    return all;
}

CodeLines write(const FieldTree& tree, ParameterBlock& block, const CodeNames& names, bool by_distance,
                GeneratedScene& generated) {
    std::string called;
    const CodeLines custom = CodeWriter(tree, names, block, false).custom_functions(called);
    const CodeLines distance = CodeWriter(tree, names, block, false).write();
    const CodeLines material = CodeWriter(tree, names, block, true).write();
    const CodeLines rays = write_for_rays(tree, block, names, by_distance, generated);

    CodeLines all{names};
    std::string library = used_shapes(called + distance.key + material.key + rays.key);
    if (!block.values.empty()) library += live_helpers;
    if (rays.key.find("turn(") != std::string::npos) library += direction_helper;
    if (material.key.find("live_material(") != std::string::npos) library += inherited_helper;
    if (!block.values.empty()) library += "\n";
    for (std::size_t start = 0; start < library.size();) {
        const std::size_t end = library.find('\n', start);
        all.add(library.substr(start, end - start));
        start = end + 1;
    }
    all.append(custom);
    generated.own_at = all.text.size();
    generated.own_key_at = all.key.size();
    all.append(distance);
    all.add("");
    generated.surface_at = all.text.size();
    all.append(material);
    all.add("");
    generated.march_at = all.text.size();
    all.append(rays);
    return all;
}

}  // namespace

bool marches_by_distance(const Scene& scene) { return expanded_node_count(scene) > largest_march; }

GeneratedScene generate(const Scene& scene, Tier tier, Id tuned) {
    return generate(scene, tier, tuned, marches_by_distance(scene));
}

GeneratedScene generate(const Scene& scene, Tier tier, Id tuned, bool by_distance) {
    return generate(FieldTree(scene), tier, tuned, by_distance);
}

GeneratedScene generate(const FieldTree& tree, Tier tier, Id tuned, bool by_distance) {
    GeneratedScene generated;
    ParameterBlock block(tree, tier, tuned);
    const CodeNames names(tree);
    CodeLines all = write(tree, block, names, by_distance, generated);
    generated.text = std::move(all.text);
    generated.key = std::move(all.key);
    generated.parameters = std::move(block.values);
    generated.line_nodes = std::move(all.nodes);
    generated.bounds = tree.bounds();
    generated.flat = is_flat(tree);
    return generated;
}

}  // namespace farfield
