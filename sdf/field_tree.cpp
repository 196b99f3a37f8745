#include "sdf/field_tree.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace farfield {
namespace {

Box level_box(const FieldNode& node, float level);

/// What the children fill together, at this level of theirs, in the node's own frame.
Box content_box(const FieldNode& node, float level) {
    const KindInfo& kind = *node.kind;
    const float count = static_cast<float>(std::max<std::size_t>(node.children.size(), 2) - 1);
    if (kind.reach) level += kind.reach(node.values) * (kind.role == Role::combine ? count : 1.0f);
    Box box = level_box(node.children[0], level);
    if (kind.gather == Gather::first) return box;
    for (std::size_t i = 1; i < node.children.size(); ++i) {
        const Box next = level_box(node.children[i], level);
        box = kind.gather == Gather::all ? box.common(next) : box.united(next);
    }
    return box;
}

/// Symmetric where all children are.
Extent content_extent(const FieldNode& node, float level) {
    Extent extent{content_box(node, level), {true, true, true}};
    for (const FieldNode& child : node.children)
        for (std::size_t axis = 0; axis < 3; ++axis)
            extent.symmetric[axis] = extent.symmetric[axis] && child.extent.symmetric[axis];
    return extent;
}

/// Bounds of the points where the node's field is at most `level`, in its own frame.
Extent own_extent(const FieldNode& node, float level) {
    const KindInfo& kind = *node.kind;
    if (kind.role == Role::primitive) {
        Extent extent = kind.extent(node.values);
        extent.box = extent.box.grown(level);
        return extent;
    }
    if (!kind.image) return content_extent(node, level);
    // Of confined content the distance to its bounds counts outside of them.
    Extent extent = kind.image(content_extent(node, kind.confined ? 0.0f : level), node.values);
    if (kind.secondary && kind.role == Role::domain) extent.box = extent.box.grown(level);
    return extent;
}

/// A box's coordinates are rounded a few times on their way up; this is a hundred times that. Sides without end do not
/// count: a half-space ends where it does.
Box with_margin(const Box& box) {
    const auto size = [](float v) { return std::abs(v) < 0.5f * unbounded ? std::abs(v) : 0.0f; };
    glm::vec3 margin;
    for (int axis = 0; axis < 3; ++axis) margin[axis] = 1e-5f * std::max(size(box.low[axis]), size(box.high[axis]));
    return Box{box.low - margin, box.high + margin}.valid();
}

Box to_parent(const FieldNode& node, const Box& box) {
    return with_margin(box.transformed(glm::transpose(node.to_own), node.scale, node.translate));
}

Box level_box(const FieldNode& node, float level) {
    return level == 0.0f ? node.extent.box : to_parent(node, own_extent(node, level / node.scale).box);
}

FieldNode prepare(const Scene& scene, const Node& node, std::uint32_t inherited) {
    const KindInfo& kind = info(node.kind);
    const Transform& t = node.transform;
    FieldNode part{node.id,     node.name,
                   &kind,       {},
                   t.translate, glm::transpose(rotation_matrix(t)),
                   t.scale,     material_index(scene, node.material, inherited),
                   {},          {},
                   {}};
    for (const Node& child : node.children)
        if (!is_empty(child)) part.children.push_back(prepare(scene, child, part.material));

    for (std::size_t i = 0; i < kind.parameters.size(); ++i)
        part.values.push_back(to_code_units(kind.parameters[i], node.values[i]));
    if (kind.derive) {
        part.values.resize(kind.parameters.size() + kind.derived.size());
        kind.derive(content_extent(part, 0.0f), part.values, std::span(part.values).subspan(kind.parameters.size()));
    }

    const Extent own = own_extent(part, 0.0f);
    part.region = with_margin(own.box);
    part.extent.box = to_parent(part, own.box);
    for (int axis = 0; axis < 3; ++axis)
        part.extent.symmetric[axis] =
            own.symmetric[axis] && t.translate[axis] == 0.0f && part.to_own == glm::mat3(1.0f);
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

Extent content_extent(const FieldNode& node) {
    return node.kind->role == Role::primitive ? own_extent(node, 0.0f) : content_extent(node, 0.0f);
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
    if (!is_empty(scene.root)) root = prepare(scene, scene.root, 0);
}

const FieldNode* find(const FieldNode& node, Id id) {
    if (node.id == id) return &node;
    for (const FieldNode& child : node.children)
        if (const FieldNode* found = find(child, id)) return found;
    return nullptr;
}

}  // namespace farfield
