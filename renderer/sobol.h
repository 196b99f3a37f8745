#pragma once

#include <glm/vec2.hpp>

namespace farfield {

/// Pairs of coordinates that `sobol` knows.
constexpr int sobol_pairs = 10;

/// What they are for.
namespace sobol_pair {
constexpr int camera = 1;  ///< place in the pixel
/// Direction of a bounce's rays; bounce 0 leaves the camera's surface.
constexpr int of_bounce(int bounce) { return bounce == 0 ? 0 : bounce + 1; }
}  // namespace sobol_pair

/// Coordinates 2 `pair` and 2 `pair` + 1 of point `index` of Sobol's sequence (1967), in units of 2^-32, with the
/// direction numbers of Joe and Kuo, "Constructing Sobol sequences with better two-dimensional projections", 2008. Any
/// 2^k points from a multiple of 2^k on are spread evenly over all the dimensions together.
glm::uvec2 sobol(unsigned index, int pair);

/// Owen's scrambling (1995), which keeps that, of the five highest digits: each is flipped or not, as those above it
/// say. `flips` has a bit for each way these can be: bit 1 for the first digit, 2 and 3 for the second, ..., 16 to 31
/// for the fifth.
unsigned scrambled(unsigned coordinate, unsigned flips);

}  // namespace farfield
