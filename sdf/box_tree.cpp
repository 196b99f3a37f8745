#include "sdf/box_tree.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <random>

namespace farfield {
namespace {

constexpr int bins = 16;
constexpr std::uint64_t turns_of_a_leaf = 4;

float area(const Box& box) {
    const glm::vec3 s = box.size();
    return s.x * s.y + s.y * s.z + s.z * s.x;
}

struct Inner {
    Box bounds;
    int axis = 0;
    int low = -1, high = -1;  ///< children; of a leaf -1
    std::int32_t box = -1;
    std::int32_t nodes = 1;  ///< with those below
};

class Builder {
public:
    explicit Builder(std::span<const Box> boxes) : boxes_(boxes), order_(boxes.size()) {
        std::iota(order_.begin(), order_.end(), 0);
        root_ = build(order_);
    }

    BoxTree tree() const {
        BoxTree tree;
        tree.size = inner_.size();
        tree.nodes.reserve(8 * tree.size);
        for (int octant = 0; octant < 8; ++octant) write(root_, octant, tree, tree.nodes.size());
        return tree;
    }

private:
    Box bounds(std::span<const std::int32_t> part) const {
        Box all = boxes_[static_cast<std::size_t>(part[0])];
        for (const std::int32_t i : part) all = all.united(boxes_[static_cast<std::size_t>(i)]);
        return all;
    }
    glm::vec3 centre(std::int32_t i) const { return boxes_[static_cast<std::size_t>(i)].centre(); }

    struct Split {
        int axis = -1;
        float at = 0.0f;
        float cost = std::numeric_limits<float>::max();
    };
    /// Where the sum of area times number of both sides is least.
    Split best_split(std::span<const std::int32_t> part) const {
        glm::vec3 low = centre(part[0]), high = low;
        for (const std::int32_t i : part) low = glm::min(low, centre(i)), high = glm::max(high, centre(i));
        Split best;
        for (int axis = 0; axis < 3; ++axis) {
            const float width = (high[axis] - low[axis]) / bins;
            if (!(width > 0.0f)) continue;
            struct Bin {
                Box bounds;
                int count = 0;
                void add(const Box& box, int n) {
                    bounds = count == 0 ? box : bounds.united(box);
                    count += n;
                }
            };
            std::array<Bin, bins> all;
            for (const std::int32_t i : part) {
                const int bin = std::clamp(static_cast<int>((centre(i)[axis] - low[axis]) / width), 0, bins - 1);
                all[static_cast<std::size_t>(bin)].add(boxes_[static_cast<std::size_t>(i)], 1);
            }
            std::array<float, bins> above{};
            Bin rest;
            for (std::size_t b = bins - 1; b > 0; --b) {
                if (all[b].count > 0) rest.add(all[b].bounds, all[b].count);
                above[b] = rest.count > 0 ? area(rest.bounds) * static_cast<float>(rest.count) : 0.0f;
            }
            Bin below;
            for (std::size_t b = 0; b + 1 < bins; ++b) {
                if (all[b].count > 0) below.add(all[b].bounds, all[b].count);
                if (below.count == 0 || below.count == static_cast<int>(part.size())) continue;
                const float cost = area(below.bounds) * static_cast<float>(below.count) + above[b + 1];
                if (cost < best.cost) best = {axis, low[axis] + width * static_cast<float>(b + 1), cost};
            }
        }
        return best;
    }

    int build(std::span<std::int32_t> part) {
        const int index = static_cast<int>(inner_.size());
        inner_.push_back({bounds(part)});
        if (part.size() == 1) {
            inner_.back().box = part[0];
            return index;
        }
        const Split split = best_split(part);
        auto middle = part.begin();
        if (split.axis >= 0)
            middle = std::partition(part.begin(), part.end(),
                                    [&](std::int32_t i) { return centre(i)[split.axis] < split.at; });
        // Of boxes at one place any half will do.
        if (middle == part.begin() || middle == part.end())
            middle = part.begin() + static_cast<std::ptrdiff_t>(part.size() / 2);
        const auto count = static_cast<std::size_t>(middle - part.begin());
        const int low = build(part.first(count)), high = build(part.subspan(count));
        Inner& node = inner_[static_cast<std::size_t>(index)];
        node.axis = std::max(split.axis, 0), node.low = low, node.high = high;
        node.nodes += inner_[static_cast<std::size_t>(low)].nodes + inner_[static_cast<std::size_t>(high)].nodes;
        return index;
    }

    void write(int index, int octant, BoxTree& tree, std::size_t begin) const {
        const Inner& node = inner_[static_cast<std::size_t>(index)];
        const auto at = static_cast<std::int32_t>(tree.nodes.size() - begin);
        tree.nodes.push_back({node.bounds.low, at + node.nodes, node.bounds.high, node.box});
        if (node.box >= 0) return;
        const bool backwards = (octant >> node.axis & 1) != 0;
        write(backwards ? node.high : node.low, octant, tree, begin);
        write(backwards ? node.low : node.high, octant, tree, begin);
    }

    std::span<const Box> boxes_;
    std::vector<std::int32_t> order_;
    std::vector<Inner> inner_;
    int root_ = 0;
};

/// What the whole line through two points visits.
std::uint64_t walk(const BoxTree& tree, glm::vec3 a, glm::vec3 b) {
    glm::vec3 direction = b - a;
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(direction[axis]) < 1e-20f) direction[axis] = 1e-20f;
    std::uint64_t visits = 0;
    for (std::size_t at = 0; at < tree.size; ++visits) {
        const BoxTree::Node& node = tree.nodes[at];
        const glm::vec3 to_low = (node.low - a) / direction, to_high = (node.high - a) / direction;
        const glm::vec3 enter = glm::min(to_low, to_high), leave = glm::max(to_low, to_high);
        const bool meets = std::max({enter.x, enter.y, enter.z}) <= std::min({leave.x, leave.y, leave.z});
        if (meets && node.box >= 0) visits += turns_of_a_leaf;
        at = meets ? at + 1 : static_cast<std::size_t>(node.next);
    }
    return visits;
}

}  // namespace

BoxTree make_box_tree(std::span<const Box> boxes) {
    BoxTree tree = Builder(boxes).tree();
    // Lines through two of the boxes meet more of them than most others.
    std::mt19937 random(1);
    for (int i = 0; i < 128; ++i) {
        const auto any = [&] { return boxes[random() % boxes.size()].centre(); };
        const glm::vec3 a = any(), b = any();
        tree.longest_walk = std::max(tree.longest_walk, walk(tree, a, b));
    }
    return tree;
}

}  // namespace farfield
