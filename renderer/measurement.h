// What settings cost and how far their picture is from the reference, as it was measured (see sweep.h).
#pragma once

#include "sdf/scene.h"

#include <cstdint>

namespace farfield {

/// What a measurement's settings differ in from the scene's own; method and samples aside.
enum class Varied { none, blur_levels, ao_radius, bounces, scale, minimum_step };
inline constexpr const char* varied_keys[] = {"none", "blur_levels", "ao_radius", "bounces", "scale", "minimum_step"};

struct Setting {
    Method method = Method::farfield;
    int samples = 0;  ///< per pixel of what was rendered
    int blur_levels = 0;
    float ao_radius = 0.0f;  ///< metres
    int bounces = 0;
    float scale = 1.0f;
    float minimum_step = 1.0f;
    friend bool operator==(const Setting&, const Setting&) = default;
};

struct Measurement {
    Varied varied = Varied::none;
    Setting setting;
    int frame_samples = 0;  ///< per pixel and frame
    std::uint32_t seed = 0;
    int reference_bounces = 0;
    int reference_samples = 0;
    double seconds = 0.0;
    bool device_time = false;  ///< by timer queries, not CPU time
    double rmse_over_mean = 0.0;
    double relative_mse = 0.0;
    double bias = 0.0;  ///< relative to the reference's mean, signed
    double flip = 0.0;
    double noise_rmse_over_mean = 0.0;  ///< of the reference
    double noise_relative_mse = 0.0;
};

/// The same settings over all seeds.
struct ChartPoint {
    Varied varied = Varied::none;
    Setting setting;
    int seeds = 0;
    double seconds = 0.0;          ///< median over the seeds, as all below
    double error = 0.0;            ///< RMSE / mean, see true_error of sweep_statistics.h
    double low = 0.0, high = 0.0;  ///< smallest and largest error of a seed
    double relative_mse = 0.0, bias = 0.0, flip = 0.0;
    double noise = 0.0;  ///< of the reference, RMSE / mean
};

}  // namespace farfield
