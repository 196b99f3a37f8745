// Speed against accuracy: what settings cost and how far their pictures are from the reference. No files, no command
// line; whoever measures gives a renderer and takes the measurements one by one.
//
// Design: all combinations would be too many, so one setting is varied at a time around the scene's own, and method and
// samples in full beside it. Methods and blur levels are views of the same accumulated samples (see METHOD.md), so one
// run (seed, AO radius, bounces, scale, minimum step) accumulates once, stops at each number of samples and reads off
// all of them.
//
// Time of a measurement: tracing that many samples, as it adds up over the frames, plus making one picture of them
// (filter, synthesis, display). The reference is charged without ambient occlusion, which it does not use. Where the
// CPU renders it is the CPU time of the process, else the device's by timer queries. Compiling is not part of it.
//
// Error: of the light that indirect light adds (albedo x irradiance / pi = result - direct light), against the
// reference; FLIP of the whole picture as displayed. Nothing is subtracted for the reference's own noise, which stands
// beside each measurement.
#pragma once

#include "renderer/measurement.h"
#include "renderer/reference.h"

#include <functional>
#include <string>
#include <vector>

namespace farfield {

struct SweepPlan {
    glm::ivec2 size{256, 256};                 ///< pixels
    std::vector<int> samples{4, 16, 64, 256};  ///< per pixel; ascending
    int seeds = 10;                            ///< 1, 2, ...
    int reference_samples = 16384;             ///< per pixel, at least
    // Beside the scene's own:
    std::vector<int> blur_levels{0, 1, 2, 4, 5};
    std::vector<float> ao_factors{0.25f, 0.5f, 2.0f, 4.0f};  ///< times the scene's own AO radius
    std::vector<int> bounces{1, 2,
                             4};  ///< against a reference with as many as the largest of these and the scene's own
    std::vector<float> minimum_steps{4.0f, 16.0f, 64.0f};  ///< times the usual; see FrameOptions
    std::vector<float> scales{0.5f, 0.25f};                ///< of width and height, magnified for comparison
};

/// One accumulation and what is read off it at each number of samples.
struct SweepRun {
    struct Reading {
        Varied varied;
        Method method;
        int blur_levels;
    };
    float ao_radius = 0.0f;
    int bounces = 0;
    float scale = 1.0f;
    float minimum_step = 1.0f;
    std::uint32_t seed = 0;
    int reference_bounces = 0;
    std::vector<Reading> readings;
};

/// SHA-256 of all that measurements of a scene depend on beside what they say themselves, 64 hexadecimal digits.
std::string measurement_key(const Scene& scene, glm::ivec2 size);

/// Why errors against a finished reference have no value; empty where they have one.
std::string why_unmeasurable(const Reference& reference);

class Sweep {
public:
    Sweep(Scene scene, SweepPlan plan);

    const std::vector<SweepRun>& runs() const { return runs_; }
    /// Numbers of bounces that references are needed for.
    std::vector<int> reference_bounces() const;
    /// The scene with so many bounces.
    Scene scene(int bounces) const;
    /// What `measure` will say, all but the results.
    std::vector<Measurement> expected(const SweepRun& run) const;
    /// Frames that `measure` renders for a run.
    int frames() const { return plan_.samples.back() / frame_samples_; }

    /// Measures a run, by samples. `frame_done` is called after each frame; returns false when it did. Needs a current
    /// context.
    bool measure(Renderer& renderer, const SweepRun& run, const Reference& reference,
                 const std::function<bool()>& frame_done, const std::function<void(const Measurement&)>& emit);

private:
    Scene scene_;
    SweepPlan plan_;
    int frame_samples_;  ///< the largest number that divides the scene's own and all of the plan's
    std::vector<SweepRun> runs_;
    glm::ivec2 warm_{0};  ///< size that the renderer's programs have been used with
};

}  // namespace farfield
