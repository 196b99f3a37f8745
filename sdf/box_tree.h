// A bounding volume hierarchy over boxes, for rays that ask which of them they meet. Walked without a stack: the nodes
// stand in the order of a walk, and each tells where to go on when a ray misses it (Smits, "Efficiency Issues for Ray
// Tracing", 1998). Eight walks, one for each octant of directions, come to what is nearer first (Torres et al., "Ray
// Casting Using a Roped BVH with CUDA", 2009, has six).
#pragma once

#include "sdf/box.h"

#include <cstdint>
#include <span>
#include <vector>

namespace farfield {

struct BoxTree {
    /// As kernels read it: two vec4.
    struct Node {
        glm::vec3 low;
        std::int32_t next;  ///< in its walk, where what is below the node has been passed
        glm::vec3 high;
        std::int32_t box;  ///< a leaf's; -1: the node's content follows
    };
    std::size_t size = 0;     ///< nodes of each walk
    std::vector<Node> nodes;  ///< 8 x size; directions with negative x have bit 1 of their walk's number, y 2, z 4
    std::uint64_t longest_walk = 0;  ///< about what a ray visits at most; each box it meets counts as four nodes more
};

/// `boxes` must be bounded, at least one. Split by the surface area heuristic (Wald, "On fast Construction of SAH-based
/// Bounding Volume Hierarchies", 2007): 16 bins along each axis.
BoxTree make_box_tree(std::span<const Box> boxes);

}  // namespace farfield
