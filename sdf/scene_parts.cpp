#include "sdf/scene_parts.h"

#include <algorithm>
#include <set>

namespace farfield {
namespace {

/// Nodes of a part: at least so many before a new one may begin, on average so many more, and at most so many unless
/// they can not be split. A part of 32 takes 0.2 s to compile on llvmpipe, 0.09 s of that however few they are.
struct Sizes {
    std::uint64_t least, usual, most;
};
constexpr Sizes small_parts{8, 24, 48}, large_parts{32, 96, 192};
constexpr std::uint64_t few_nodes = 1500;

/// Whether a new part may begin here: decided by the id, so that what is inserted or removed elsewhere changes nothing.
/// The more nodes the more likely.
bool may_begin(Id id, std::uint64_t count, std::uint64_t usual) { return (id * 2654435769u >> 16) % usual < count; }

bool is_hard_union(const Node& node) {
    const KindInfo& kind = info(node.kind);
    return kind.role == Role::combine && kind.when_zero && kind.gather == Gather::any &&
           std::all_of(node.values.begin(), node.values.end(), [](glm::vec3 v) { return v == glm::vec3(0.0f); });
}

class Partition {
public:
    explicit Partition(const Scene& scene)
        : counts_(scene), sizes_(counts_.of(scene.root) > few_nodes ? large_parts : small_parts) {
        visit(scene.root);
    }

    std::vector<std::set<Id>> parts;  ///< the topmost nodes of each

private:
    void visit(const Node& node) {
        if (node.hidden) return;
        const std::uint64_t count = counts_.of(node);
        if (count > sizes_.least && is_hard_union(node)) {
            for (const Node& child : node.children) visit(child);
            return;
        }
        if (parts.empty() || (size_ >= sizes_.least && may_begin(node.id, count, sizes_.usual)) ||
            size_ + count > sizes_.most) {
            parts.emplace_back();
            size_ = 0;
        }
        parts.back().insert(node.id);
        size_ += count;
    }

    ExpandedCounts counts_;
    Sizes sizes_;
    std::uint64_t size_ = 0;  ///< of the last part
};

/// Whether anything of `node` is left when only the subtrees of `kept` are.
bool keep_only(Node& copy, const Node& node, const std::set<Id>& kept) {
    if (kept.contains(node.id)) {
        copy = node;
        return true;
    }
    copy.id = node.id, copy.kind = node.kind, copy.name = node.name, copy.values = node.values;
    copy.transform = node.transform, copy.material = node.material;
    for (const Node& child : node.children)
        if (Node below; keep_only(below, child, kept)) copy.children.push_back(std::move(below));
    return !copy.children.empty();
}

}  // namespace

std::vector<Scene> scene_parts(const Scene& scene) {
    if (expanded_node_count(scene) <= largest_whole_scene) return {scene};
    const Partition partition(scene);
    if (partition.parts.size() <= 1) return {scene};
    const std::set<Id> filled = filled_definitions(scene);
    Scene rest = scene;
    rest.root = Node();
    std::vector<Scene> parts;
    for (const std::set<Id>& kept : partition.parts) {
        Scene part = rest;
        keep_only(part.root, scene.root, kept);
        if (!is_empty(part.root, filled)) parts.push_back(std::move(part));
    }
    if (parts.empty()) return {scene};
    return parts;
}

}  // namespace farfield
