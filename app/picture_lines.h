// Lines over the picture that follow from the field: the outline of what is to be seen of a node, and which points of
// the grid on the ground nothing hides. By sphere tracing on the CPU, for a thread of its own.
//
// The outline. Rays through a lattice of points, a few pixels apart, say where the node shows; between a point where it
// does and a neighbour where it does not the border is found by bisection to a fraction of a pixel, and each cell of
// the lattice joins the points of its border (marching squares). What is thinner than the lattice can be missed.
#pragma once

#include "app/picture_view.h"
#include "sdf/evaluate.h"

#include <functional>
#include <set>
#include <utility>
#include <vector>

namespace farfield {

using Segment = std::pair<glm::vec2, glm::vec2>;

/// The shapes of the picture that belong to a node: the primitives and instances below it; for a node of a definition
/// the instances that show that, directly or through others.
std::set<Id> shapes_of(const Scene& scene, Id node);

/// Around what is to be seen of the shapes `owners`, in the view's pixels. `bounds`: a box around them, where they have
/// one. `samples`: of the coarse lattice; about as many follow. `stop` is asked now and then; with true the answer is
/// empty.
std::vector<Segment> outline_of(const FieldEvaluator& field, const PictureView& view, const std::set<Id>& owners,
                                const std::optional<Box>& bounds, int samples, const std::function<bool()>& stop);

/// A square part of the ground, y = 0: lines in both directions, and points along them.
struct GroundGrid {
    static constexpr int lines = 31, points = 31;

    GroundGrid() = default;
    /// About what the camera looks at, in steps that fit the view.
    explicit GroundGrid(const Camera& camera);
    /// Point i of line k, along x (0) or z (1).
    glm::vec3 point(int direction, int k, int i) const;
    static std::size_t index(int direction, int k, int i) {
        return (static_cast<std::size_t>(direction) * lines + static_cast<std::size_t>(k)) * points +
               static_cast<std::size_t>(i);
    }
    static constexpr std::size_t count = std::size_t{2} * lines * points;

    float step = 1.0f;
    int x = 0, z = 0;  ///< of the first line of each direction, in steps
    friend bool operator==(const GroundGrid&, const GroundGrid&) = default;
};

/// Of each point of the grid, whether the camera sees it. Empty when stopped.
std::vector<bool> seen_points(const FieldEvaluator& field, const PictureView& view, const GroundGrid& grid,
                              const std::function<bool()>& stop);

}  // namespace farfield
