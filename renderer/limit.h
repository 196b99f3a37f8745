// How near the tracer comes to what the device could do, measured in one frame: multiply-adds, evaluations of the scene
// in a plain loop and within the tracer, evaluations of a ray against those of an oracle that starts where the ray
// ends. It needs one: to see that something is there, or nothing. What a ray is cast at (sdf/cast_writer.h) is part of
// its first evaluation.
#pragma once

#include "renderer/renderer.h"

#include <cstdint>
#include <vector>

namespace farfield {

/// Of all rays of a kind in one frame.
struct RayLimit {
    RayKind kind = RayKind::camera;
    std::uint64_t rays = 0;  ///< of some reach: a surface that faces away from a light has none to it
    std::uint64_t evaluations = 0;
    std::uint64_t oracle_evaluations = 0;  ///< rays that come near anything
    std::uint64_t lane_evaluations = 0;    ///< that lanes had time for, which run in step
    std::uint64_t exhausted = 0;           ///< rays stopped by the step limit
    double march_seconds = 0.0;            ///< of the tracer's march kernel
    double plain_seconds = 0.0;            ///< of as many evaluations in a plain loop, at the same rays
};

struct Limit {
    int lanes = 0;               ///< that run in step
    double multiply_adds = 0.0;  ///< a second, the most that was measured
    bool device_time = false;    ///< seconds are the device's by timer queries; else CPU time of all threads
    std::vector<RayLimit> rays;  ///< of the kinds that there were
};

/// Renders one frame of what the renderer shows, each ray several times. The renderer has to be updated, and to have
/// rendered a frame before, because drivers compile at first use.
Limit measure_limit(Renderer& renderer);

}  // namespace farfield
