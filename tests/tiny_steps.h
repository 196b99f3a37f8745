// A march in steps of 1e-4 m that looks at nothing but the field's sign, to hold the tracer against.
#pragma once

#include "renderer/records.h"
#include "sdf/codegen.h"

#include <vector>

namespace farfield {

/// As in shaders/common.glsl.
struct RayRecord {
    glm::vec3 origin;
    float reach;
    glm::vec3 direction;
    float footprint;
};
static_assert(sizeof(RayRecord) == ray_bytes);
struct HitRecord {
    float distance;
    std::uint32_t normal, material, steps;
};
static_assert(sizeof(HitRecord) == hit_bytes);

inline constexpr float smallest_step = 1e-4f;
/// The tracer's tolerance, for each metre: about 1e-4 m at these distances.
inline constexpr float fine_footprint = 2e-5f;

/// `width` x `width` rays of a camera that looks at the box from a corner.
std::vector<RayRecord> camera_rays(const Box& box, int width = 64);

/// What the tracer finds for each ray; needs a current context.
std::vector<HitRecord> traced(const Scene& scene, Tier tier, const std::vector<RayRecord>& rays);

/// The first change of sign in steps of 1e-4 m, made finer by bisection; -1 where there is none.
std::vector<float> marched(const Scene& scene, const std::vector<RayRecord>& rays);

}  // namespace farfield
