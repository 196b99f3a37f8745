// How fast custom code's distance changes, measured on the CPU.
#pragma once

#include "sdf/custom_code.h"

namespace farfield {

/// The largest |sdf(a) - sdf(b)| / |a - b| among sampled pairs of points in the box, some of them at places where it
/// was large already. An estimate from below, not a bound: what no pair met is not in it. Equal arguments give equal
/// results.
float estimate_lipschitz(const CustomCode& code, glm::vec3 low, glm::vec3 high, std::span<const glm::vec3> values,
                         int pairs = 20'000);

}  // namespace farfield
