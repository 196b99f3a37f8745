// The passes, one class each with its shader files, and what they work on. Objects by lifetime: Targets live as long as
// the resolution, the batch buffers as long as the renderer; a pass owns its kernels and nothing else.
#pragma once

#include "renderer/gl.h"
#include "renderer/trace_program.h"
#include "sdf/scene.h"

#include <functional>
#include <vector>

namespace farfield {

/// Far and near light as one level of the wavelet has them, and the share of a pixel's variance that is left.
struct WaveletLevel {
    gl::Texture far, near, gain;
};

/// Accumulators of one resolution; sums over frames, see shaders/common.glsl.
struct Targets {
    explicit Targets(glm::ivec2 size);
    void clear();            ///< everything: scene, camera or light transport changed
    void clear_ao_radius();  ///< what depends on the AO radius
    void bind() const;
    std::size_t bytes() const;  ///< of buffers and textures
    std::size_t pixels() const { return static_cast<std::size_t>(size.x) * size.y; }

    glm::ivec2 size;
    gl::Buffer surfaces{"surfaces"}, direct{"direct"}, geometry{"geometry"}, reflectance{"reflectance"},
        far_light{"far light"}, indirect{"indirect"}, occlusion{"occlusion"}, split_far{"split far"},
        split_near{"split near"}, squares{"squares"};
    gl::Texture mips, blurred;         ///< of the paper's filter
    std::vector<WaveletLevel> levels;  ///< the first is unfiltered
    WaveletLevel half_level;           ///< between two: filtered in one direction
    gl::Texture guide, links[2][2];    ///< links to the right and below, of the odd and the even levels
    gl::Texture estimates[2];
    /// What the half level is no longer needed for has its textures: the wavelet's details, then the picture.
    gl::Texture& detail(std::size_t i) { return i == 0 ? half_level.far : half_level.near; }
    gl::Texture& view() { return half_level.near; }
};

/// Buffers for as many rays as one dispatch may have: bounded, so that memory does not grow with the picture and work
/// can be dropped soon after an edit.
struct Batch {
    static constexpr std::size_t capacity = 1 << 17;
    Batch();
    void bind() const;
    std::size_t bytes() const { return rays.bytes() + hits.bytes() + vertices.bytes() + paths.bytes(); }
    gl::Buffer rays{"rays"}, hits{"hits"}, vertices{"vertices"}, paths{"paths"};
};

/// What rays are traced for.
enum class RayKind { camera, shadow, bounce, bounce_shadow, occlusion };
inline constexpr const char* ray_kind_names[] = {"camera", "shadow", "bounce", "shadow of a bounce", "occlusion"};
/// Of what they meet, normal and material are wanted; else only whether they meet anything.
constexpr bool needs_surfaces(RayKind kind) { return kind == RayKind::camera || kind == RayKind::bounce; }

struct Work;
/// Is told of rays before they are traced. May trace them itself, but not change them.
using RayObserver = std::function<void(const Work& work, RayKind kind)>;

/// A run of pixels, at most Batch::capacity, and what all passes need to work on it.
struct Work {
    const TracePrograms& tracer;
    const Targets& targets;
    const Batch& batch;
    std::size_t first_pixel;
    std::size_t count;
    int light_count;
    bool counting;
    const RayObserver& observer;  ///< or none
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
    /// Mean irradiance / pi after each bounce, on work.count paths that start all over the picture; accumulates
    /// nothing.
    std::vector<double> measure(const Work& work, int bounces) const;

private:
    /// Traces the rays of the batch, adds what the paths meet, and lights it.
    void follow(const Work& work, bool first) const;
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
    /// One level of the wavelet more than `blur_levels` (0 stays 0): so wide is the paper's filter, see METHOD.md.
    /// Leaves irradiance / pi in targets.estimates[0] and the coarsest far light in targets.levels.back(). Asks `stop`,
    /// if there is one, between levels; false when it said so and nothing is there to be shown.
    bool run(Targets& targets, int blur_levels, const std::function<bool()>& stop) const;

private:
    void make_textures(Targets& targets, std::size_t levels) const;
    /// Half a level: along rows (direction 0) or columns (1).
    void smooth(Targets& targets, std::size_t level, std::size_t direction, const WaveletLevel& source,
                const WaveletLevel& target) const;
    void shrink(Targets& targets, std::size_t level) const;
    gl::Program start_ = load_program("wavelet_start.glsl"), links_ = load_program("wavelet_links.glsl"),
                smooth_ = load_program("wavelet_smooth.glsl"), coarsest_ = load_program("wavelet_coarsest.glsl"),
                shrink_ = load_program("wavelet_shrink.glsl");
};

/// Accumulators and filtered light to targets.view(), linear.
class SynthesisPass {
public:
    /// `estimate` is used by Method::farfield only.
    void run(Targets& targets, const gl::Texture& filtered, const gl::Texture* estimate, int view, Method method,
             int frames) const;

private:
    gl::Program program_ = load_program("synthesis.glsl");
};

/// targets.view() to an RGBA8 texture of the same size.
class DisplayPass {
public:
    void run(Targets& targets, const gl::Texture& output, int view, float exposure) const;

private:
    gl::Program program_ = load_program("display.glsl");
};

}  // namespace farfield
