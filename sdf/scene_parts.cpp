#include "sdf/scene_parts.h"

#include "sdf/codegen.h"

#include <algorithm>
#include <set>
#include <unordered_map>
#include <utility>

namespace farfield {
namespace {

/// Nodes of a part: at least so many before a new one may begin, on average so many more, and at most so many unless
/// they can not be split. A part of 32 takes 0.2 s to compile on llvmpipe, 0.09 s of that however few they are.
/// In a part of 19 an edit shows after 0.27 s, in one of 42 after 0.4 s (tests/edit_latency.py).
struct Sizes {
    std::uint64_t least, usual, most;
};
constexpr Sizes small_parts{8, 24, 36}, large_parts{32, 96, 192};

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
        : counts_(scene), sizes_(marches_by_distance(scene) ? large_parts : small_parts) {
        visit(scene.root);
    }

    std::unordered_map<Id, std::size_t> part_of;  ///< the topmost nodes of each part
    std::size_t parts = 0;

private:
    void visit(const Node& node) {
        if (node.hidden) return;
        const std::uint64_t count = counts_.of(node);
        if (count > sizes_.least && is_hard_union(node)) {
            for (const Node& child : node.children) visit(child);
            return;
        }
        if (parts == 0 || (size_ >= sizes_.least && may_begin(node.id, count, sizes_.usual)) ||
            size_ + count > sizes_.most) {
            ++parts;
            size_ = 0;
        }
        part_of[node.id] = parts - 1;
        size_ += count;
    }

    ExpandedCounts counts_;
    Sizes sizes_;
    std::uint64_t size_ = 0;  ///< of the last part
};

/// What each part has of `node` and below it, in the order of the parts.
using Pieces = std::vector<std::pair<std::size_t, Node>>;
Pieces pieces(const Node& node, const std::unordered_map<Id, std::size_t>& part_of) {
    if (const auto found = part_of.find(node.id); found != part_of.end()) return {{found->second, node}};
    const Node shell = without_children(node);
    Pieces all;
    for (const Node& child : node.children)
        for (auto& [part, below] : pieces(child, part_of)) {
            if (all.empty() || all.back().first != part) all.emplace_back(part, shell);
            all.back().second.children.push_back(std::move(below));
        }
    return all;
}

}  // namespace

std::vector<Scene> scene_parts(const Scene& scene) {
    if (expanded_node_count(scene) <= largest_whole_scene) return {scene};
    const Partition partition(scene);
    if (partition.parts <= 1) return {scene};
    const std::set<Id> filled = filled_definitions(scene);
    Scene rest = scene;
    rest.root = Node();
    std::vector<Scene> parts;
    for (auto& [number, root] : pieces(scene.root, partition.part_of)) {
        if (is_empty(root, filled)) continue;
        parts.push_back(rest);
        parts.back().root = std::move(root);
    }
    if (parts.empty()) return {scene};
    return parts;
}

}  // namespace farfield
