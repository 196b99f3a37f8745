// The passes, one class each with its shader files, and what they work on. Objects by lifetime: Targets live as long as
// the resolution, the batch buffers as long as the renderer; a pass owns its kernels and nothing else.
#pragma once

#include "renderer/gl.h"
#include "renderer/trace_program.h"
#include "sdf/scene.h"

#include <vector>

namespace farfield {

/// Accumulators of one resolution; sums over frames, see shaders/common.glsl.
struct Targets {
    explicit Targets(glm::ivec2 size);
    void clear();            ///< everything: scene, camera or light transport changed
    void clear_ao_radius();  ///< what depends on the AO radius
    void bind() const;
    std::size_t pixels() const { return static_cast<std::size_t>(size.x) * size.y; }

    glm::ivec2 size;
    gl::Buffer surfaces{"surfaces"}, direct{"direct"}, geometry{"geometry"}, reflectance{"reflectance"},
        far_light{"far light"}, indirect{"indirect"}, occlusion{"occlusion"}, split_far{"split far"},
        split_near{"split near"}, squares{"squares"};
    gl::Texture mips, blurred, view;
    std::vector<gl::Texture> far_levels, near_levels, gain_levels,
        link_levels;  ///< of the wavelet; the first level is unfiltered
    gl::Texture guide, detail, estimates[2];
};

/// Buffers for as many rays as one dispatch may have: bounded, so that memory does not grow with the picture and work
/// can be dropped soon after an edit.
struct Batch {
    static constexpr std::size_t capacity = 1 << 17;
    Batch();
    void bind() const;
    gl::Buffer rays{"rays"}, hits{"hits"}, vertices{"vertices"}, paths{"paths"};
};

/// A run of pixels, at most Batch::capacity, and what all passes need to work on it.
struct Work {
    const TracePrograms& tracer;
    const Targets& targets;
    const Batch& batch;
    std::size_t first_pixel;
    std::size_t count;
    int light_count;
    bool counting;
};

/// How far rays look, metres.
inline constexpr float far_reach = 1e4f;

/// Camera rays and the G-buffer.
class CameraPass {
public:
    void run(const Work& work) const;

private:
    gl::Program rays_ = load_program("camera.glsl"), gbuffer_ = load_program("gbuffer.glsl");
};

/// Phong with hard shadows from every light.
class DirectPass {
public:
    void run(const Work& work) const;

private:
    gl::Program rays_ = load_program("light_rays.glsl"), shade_ = load_program("direct.glsl");
};

/// One hemisphere ray per pixel, followed over the bounces (after the fourth by Russian roulette), each vertex lit by
/// every light; accumulated whole and split by the near weight of `near_radius`, metres.
class FarLightPass {
public:
    void run(const Work& work, unsigned sample_index, int bounces, float near_radius) const;

private:
    gl::Program hemisphere_ = load_program("hemisphere.glsl"), bounce_ = load_program("bounce.glsl"),
                light_rays_ = load_program("light_rays.glsl"), light_ = load_program("bounce_light.glsl"),
                roulette_ = load_program("roulette.glsl"), gather_ = load_program("gather.glsl");
};

/// One short ray per pixel within the AO radius.
class OcclusionPass {
public:
    void run(const Work& work, unsigned sample_index, float radius) const;

private:
    gl::Program hemisphere_ = load_program("hemisphere.glsl"), gather_ = load_program("occlusion.glsl");
};

/// The paper's filter: a mip chain of the far light, then a blur of one level.
class FilterPass {
public:
    /// Fills targets.blurred (or level 0 of targets.mips for 0) from the accumulated far light; returns that texture.
    const gl::Texture& run(Targets& targets, int blur_levels) const;

private:
    gl::Program start_ = load_program("filter_start.glsl"), mip_ = load_program("filter_mip.glsl"),
                blur_ = load_program("filter_blur.glsl");
};

/// The consistent near/far estimate: à-trous wavelet and James-Stein shrinkage from coarse to fine; see METHOD.md.
class WaveletPass {
public:
    /// Returns irradiance / pi, and leaves the coarsest far light in targets.far_levels.back().
    const gl::Texture& run(Targets& targets, int blur_levels) const;

private:
    gl::Program start_ = load_program("wavelet_start.glsl"), links_ = load_program("wavelet_links.glsl"),
                smooth_ = load_program("wavelet_smooth.glsl"), detail_ = load_program("wavelet_detail.glsl"),
                shrink_ = load_program("wavelet_shrink.glsl");
};

/// Accumulators and filtered light to targets.view, linear.
class SynthesisPass {
public:
    /// `estimate` is used by Method::farfield only.
    void run(const Targets& targets, const gl::Texture& filtered, const gl::Texture& estimate, int view, Method method,
             int frames) const;

private:
    gl::Program program_ = load_program("synthesis.glsl");
};

/// targets.view to an RGBA8 texture of the same size.
class DisplayPass {
public:
    void run(const Targets& targets, const gl::Texture& output, int view, float exposure) const;

private:
    gl::Program program_ = load_program("display.glsl");
};

}  // namespace farfield
