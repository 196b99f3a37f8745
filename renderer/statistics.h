// What the renderer reports about its work; plain data, safe to copy between threads.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace farfield {

struct PassTime {
    std::string name;
    double milliseconds = 0.0;  ///< of the last frame
};

struct Statistics {
    std::vector<PassTime> passes;
    double frame_milliseconds = 0.0;  ///< wall time of the last frame, all passes
    double frames_per_second = 0.0;   ///< smoothed
    int frames = 0;                   ///< accumulated since the last reset
    int samples = 0;                  ///< hemisphere rays per pixel accumulated since the last reset
    std::optional<double> noise;      ///< see Renderer::noise; where the caller had it estimated
    int structural_compiles = 0;      ///< programs made for a structure not met before; a parameter edit never adds one
    int specialisations = 0;          ///< further programs for known structures, made once the hand rested
    double compile_milliseconds = 0.0;  ///< of the last program, or of all parts made at once
    double edit_milliseconds = 0.0;     ///< from the latest change of the scene to its first picture
    bool specialised = false;           ///< the picture comes from the program with literals
    int bounces = 0;                    ///< of far light: the setting, or what auto has come to
    std::vector<float> bounce_shares;   ///< what each bounce adds to the mean of those before; empty: not measured
    std::uint64_t rays = 0;             ///< traced in the last frame, where they are counted (FrameOptions)
    std::uint64_t evaluations = 0;      ///< of the distance by these rays' marches
    std::uint64_t exhausted_rays = 0;   ///< of these, stopped by the step limit
    std::string device;                 ///< what OpenGL calls the renderer
};

/// "3 bounces; bounce 4 adds 0.3 %", the latter where it was measured; empty before the first picture.
std::string bounces_text(const Statistics& statistics);
/// "3.1 %" of 0.031; "unknown" where it is not finite.
std::string percent_text(double part);

}  // namespace farfield
