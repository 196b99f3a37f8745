#include "sdf/field_tree.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <unordered_map>
#include <utility>

namespace farfield {
namespace {

/// The definitions, and what is known of them so far.
struct Definitions {
    Definitions(const Scene& in_scene, std::vector<FieldNode>& to)
        : scene(in_scene), filled(filled_definitions(scene)), prepared(to) {
        for (const Node& definition : scene.definitions) nodes.emplace(definition.id, &definition);
    }
    const Scene& scene;
    std::set<Id> filled;
    std::unordered_map<Id, const Node*> nodes;
    std::vector<FieldNode>& prepared;
    std::unordered_map<Id, std::size_t> indices;
    std::map<std::pair<std::size_t, float>, Box> boxes;  ///< at levels other than 0
};

Box level_box(const FieldNode& node, float level, Definitions& definitions);

/// The level or a bit more, one of eight for each octave.
float rounded_up(float level) {
    int exponent = 0;
    const float mantissa = std::frexp(std::min(level, unbounded), &exponent);
    return std::ldexp(std::ceil(16.0f * mantissa) / 16.0f, exponent);
}

Box definition_box(std::size_t index, float level, Definitions& definitions) {
    if (level == 0.0f) return definitions.prepared[index].extent.box;
    level = rounded_up(level);
    const auto [box, fresh] = definitions.boxes.try_emplace({index, level});
    if (fresh) box->second = level_box(definitions.prepared[index], level, definitions);
    return box->second;
}

/// Leaves in `extent` what holds along the axes of both.
void both(Extent& extent, const Extent& other) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        extent.symmetric[axis] = extent.symmetric[axis] && other.symmetric[axis];
        extent.constant[axis] = extent.constant[axis] && other.constant[axis];
    }
}

/// What the children fill together, at this level of theirs, in the node's own frame.
Box content_box(const FieldNode& node, float level, Definitions& definitions) {
    const KindInfo& kind = *node.kind;
    level += node.reach();
    Box box = level_box(node.children[0], level, definitions);
    if (kind.gather == Gather::first) return box;
    for (std::size_t i = 1; i < node.children.size(); ++i) {
        const Box next = level_box(node.children[i], level, definitions);
        box = kind.gather == Gather::all ? box.common(next) : box.united(next);
    }
    return box;
}

/// What holds of all children.
Extent content_extent(const FieldNode& node, float level, Definitions& definitions) {
    Extent extent{content_box(node, level, definitions), {true, true, true}, {true, true, true}};
    for (const FieldNode& child : node.children) both(extent, child.extent);
    return extent;
}

/// Bounds of the points where the node's field is at most `level`, in its own frame.
Extent own_extent(const FieldNode& node, float level, Definitions& definitions) {
    const KindInfo& kind = *node.kind;
    if (kind.role == Role::primitive) {
        Extent extent = kind.extent(node.values);
        for (int axis = 0; axis < 3; ++axis)
            extent.constant[axis] =
                !node.code && is_unbounded(extent.box.low[axis]) && is_unbounded(extent.box.high[axis]);
        extent.box = extent.box.grown(level);
        return extent;
    }
    if (kind.role == Role::instance)
        return {definition_box(node.definition, level, definitions),
                definitions.prepared[node.definition].extent.symmetric,
                definitions.prepared[node.definition].extent.constant};
    if (!kind.image) return content_extent(node, level, definitions);
    // Of confined content the distance to its bounds counts outside of them.
    Extent extent = kind.image(content_extent(node, kind.confined ? 0.0f : level, definitions), node.values);
    if (kind.secondary && kind.role == Role::domain) extent.box = extent.box.grown(level);
    return extent;
}

/// A box's coordinates are rounded a few times on their way up; this is a hundred times that. Sides without end do not
/// count: a half-space ends where it does.
Box with_margin(const Box& box) {
    const auto size = [](float v) { return is_unbounded(v) ? 0.0f : std::abs(v); };
    glm::vec3 margin;
    for (int axis = 0; axis < 3; ++axis) margin[axis] = 1e-5f * std::max(size(box.low[axis]), size(box.high[axis]));
    return Box{box.low - margin, box.high + margin}.valid();
}

Box to_parent(const FieldNode& node, const Box& box) {
    return with_margin(box.transformed(glm::transpose(node.to_own), node.scale, node.translate));
}

Box level_box(const FieldNode& node, float level, Definitions& definitions) {
    return level == 0.0f ? node.extent.box : to_parent(node, own_extent(node, level / node.scale, definitions).box);
}

FieldNode prepare(const Node& node, std::uint32_t inherited, Definitions& definitions);

bool is_exact(const FieldNode& node) { return node.kind->role == Role::primitive && node.kind->exact; }

std::size_t definition_index(Id id, Definitions& definitions) {
    if (const auto found = definitions.indices.find(id); found != definitions.indices.end()) return found->second;
    FieldNode definition = prepare(*definitions.nodes.at(id), inherited_material, definitions);
    definitions.prepared.push_back(std::move(definition));
    return definitions.indices[id] = definitions.prepared.size() - 1;
}

FieldNode prepare(const Node& node, std::uint32_t inherited, Definitions& definitions) {
    const KindInfo& kind = info(node.kind);
    const Transform& t = node.transform;
    FieldNode part{node.id,     node.name,
                   &kind,       {},
                   t.translate, glm::transpose(rotation_matrix(t)),
                   t.scale,     material_index(definitions.scene, node.material, inherited),
                   {},          {},
                   {}};
    for (const Node& child : node.children)
        if (!is_empty(child, definitions.filled)) part.children.push_back(prepare(child, part.material, definitions));
    if (kind.role == Role::instance) part.definition = definition_index(node.definition, definitions);

    part.parameters = parameters(node);
    part.code = node.code;
    for (std::size_t i = 0; i < part.parameters.size(); ++i)
        part.values.push_back(to_code_units(part.parameters[i], node.values[i]));
    if (kind.derive) {
        const Extent content = content_extent(part, 0.0f, definitions);
        part.values.resize(kind.parameters.size() + kind.derived.size());
        kind.derive(content, part.values, std::span(part.values).subspan(kind.parameters.size()));
        part.guarded = kind.guard_copy && (!std::all_of(part.children.begin(), part.children.end(), is_exact) ||
                                           !kind.warnings(content, part.children.size(), part.values).empty());
    }

    const Extent own = own_extent(part, 0.0f, definitions);
    part.region = with_margin(own.box);
    part.extent.box = to_parent(part, own.box);
    const bool turned = part.to_own != glm::mat3(1.0f);
    for (int axis = 0; axis < 3; ++axis) {
        part.extent.symmetric[axis] = own.symmetric[axis] && t.translate[axis] == 0.0f && !turned;
        part.extent.constant[axis] = own.constant[axis] && !turned;
    }
    return part;
}

/// The nodes from `node` to the one with this id, in that order; empty where it is not below.
bool find_path(const FieldNode& node, Id id, std::vector<const FieldNode*>& path) {
    path.push_back(&node);
    if (node.id == id) return true;
    for (const FieldNode& child : node.children)
        if (find_path(child, id, path)) return true;
    path.pop_back();
    return false;
}

/// A part of the node's content, in its own frame, as it shows in its parent's frame.
Box part_in_parent(const FieldNode& node, Box part) {
    const KindInfo& kind = *node.kind;
    if (kind.role != Role::combine && kind.reach) part = part.grown(kind.reach(node.values));
    if (kind.image) part = kind.image({part, {}}, node.values).box;
    return to_parent(node, part);
}

/// `path` leads from the root to a node; the box is in that node's parent's frame.
Box in_world(std::span<const FieldNode* const> path, Box box) {
    for (std::size_t i = path.size() - 1; i-- > 0;) box = part_in_parent(*path[i], box);
    return box;
}

std::optional<Box> finite_part(std::vector<const FieldNode*>& path) {
    const FieldNode& node = *path.back();
    if (const Box box = in_world(path, node.extent.box); box.is_bounded()) return box;
    std::optional<Box> bounds;
    for (const FieldNode& child : node.children) {
        path.push_back(&child);
        if (const auto part = finite_part(path)) bounds = bounds ? bounds->united(*part) : *part;
        path.pop_back();
        if (node.kind->gather == Gather::first) break;
    }
    return bounds;
}

}  // namespace

float FieldNode::reach() const {
    if (!kind->reach) return 0.0f;
    if (kind->kind == NodeKind::union_) {
        // A fold f(a, b) of the smooth union rises with both and depends on differences otherwise. So what it has after
        // the others is at least the least child less s, if s = -f(-s before, 0): each adds less than the one before.
        float sum = 0.0f;
        for (std::size_t i = 1; i < std::max<std::size_t>(children.size(), 2); ++i)
            sum = -kind->combine(-sum, 0.0f, values);
        return sum;
    }
    const float count = static_cast<float>(std::max<std::size_t>(children.size(), 2) - 1);
    return kind->reach(values) * (kind->role == Role::combine ? count : 1.0f);
}

bool operator==(const FieldNode& a, const FieldNode& b) {
    const bool same_code = a.code == b.code || (a.code && b.code && a.code->text() == b.code->text());
    return same_code && a.kind == b.kind && a.values == b.values && a.translate == b.translate &&
           a.to_own == b.to_own && a.scale == b.scale && a.material == b.material && a.region == b.region &&
           a.extent.box == b.extent.box && a.guarded == b.guarded && a.definition == b.definition &&
           a.children == b.children;
}

Extent content_extent(const FieldNode& node) {
    if (node.children.empty()) return node.extent;
    Extent extent = node.children[0].extent;
    if (node.kind->gather == Gather::first) return extent;
    for (const FieldNode& child : std::span(node.children).subspan(1)) {
        const Box& box = child.extent.box;
        extent.box = node.kind->gather == Gather::all ? extent.box.common(box) : extent.box.united(box);
        both(extent, child.extent);
    }
    return extent;
}

std::optional<Box> world_bounds(const FieldTree& tree, Id id) {
    std::vector<const FieldNode*> path;
    if (!tree.root || !find_path(*tree.root, id, path)) return std::nullopt;
    return in_world(path, path.back()->extent.box);
}

std::optional<Box> finite_bounds(const FieldTree& tree, Id id) {
    std::vector<const FieldNode*> path;
    if (!tree.root || !find_path(*tree.root, id, path)) return std::nullopt;
    return finite_part(path);
}

FieldTree::FieldTree(const Scene& scene) {
    Definitions prepared(scene, definitions);
    if (!is_empty(scene.root, prepared.filled)) root = prepare(scene.root, 0, prepared);
}

void move(FieldNode& node, glm::vec3 translate, const glm::mat3& to_own) {
    node.translate = translate;
    node.to_own = to_own;
    node.extent.box = to_parent(node, node.region);
}

bool is_hard_union(const FieldNode& node) {
    const KindInfo& kind = *node.kind;
    return kind.role == Role::combine && kind.when_zero && kind.gather == Gather::any &&
           std::all_of(node.values.begin(), node.values.end(), [](glm::vec3 v) { return v == glm::vec3(0.0f); });
}

namespace {

void open(FieldNode node, std::vector<FieldNode>& united) {
    if (!is_hard_union(node)) {
        united.push_back(std::move(node));
        return;
    }
    for (FieldNode& child : node.children) {
        child.scale *= node.scale;
        // A vector times a matrix is the transposed matrix times the vector.
        move(child, node.translate + node.scale * (child.translate * node.to_own), child.to_own * node.to_own);
        open(std::move(child), united);
    }
}

/// Copies the definitions that the node shows to `tree`, each after those that it uses itself.
void take_definitions(FieldNode& node, const std::vector<FieldNode>& all, std::map<std::size_t, std::size_t>& taken,
                      FieldTree& tree) {
    for (FieldNode& child : node.children) take_definitions(child, all, taken, tree);
    if (node.kind->role != Role::instance) return;
    if (!taken.contains(node.definition)) {
        FieldNode definition = all[node.definition];
        take_definitions(definition, all, taken, tree);
        taken[node.definition] = tree.definitions.size();
        tree.definitions.push_back(std::move(definition));
    }
    node.definition = taken[node.definition];
}

}  // namespace

std::vector<FieldTree> united(FieldTree tree) {
    std::vector<FieldNode> nodes;
    if (tree.root) open(std::move(*tree.root), nodes);
    std::vector<FieldTree> trees;
    for (FieldNode& node : nodes) {
        FieldTree& one = trees.emplace_back();
        std::map<std::size_t, std::size_t> taken;
        take_definitions(node, tree.definitions, taken, one);
        one.root = std::move(node);
    }
    return trees;
}

const FieldNode* find(const FieldNode& node, Id id) {
    if (node.id == id) return &node;
    for (const FieldNode& child : node.children)
        if (const FieldNode* found = find(child, id)) return found;
    return nullptr;
}

}  // namespace farfield
