// The passes, one class each with its shader files, and what they work on. Objects by lifetime: Targets live as long as
// the resolution, the batch buffers as long as the renderer; a pass owns its kernels and nothing else.
#pragma once

#include "renderer/gl.h"
#include "renderer/trace_program.h"
#include "renderer/wavelet.h"
#include "sdf/scene.h"

#include <functional>
#include <optional>
#include <vector>

namespace farfield {

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
    gl::Texture mips, blurred;  ///< of the paper's filter
    WaveletRasters wavelet;
    gl::Raster& view() { return wavelet.scratch.near; }
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

/// Of far light: the accumulators are read and written once for so many samples. Shaders know it, too.
constexpr std::size_t most_samples_together = 16;

/// What rays are traced for.
enum class RayKind { camera, shadow, bounce, bounce_shadow, occlusion };
inline constexpr const char* ray_kind_names[] = {"camera", "shadow", "bounce", "shadow of a bounce", "occlusion"};
/// Of what they meet, normal and material are wanted; else only whether they meet anything.
constexpr bool needs_surfaces(RayKind kind) { return kind == RayKind::camera || kind == RayKind::bounce; }

struct Work;
/// Is told of rays before they are traced. May trace them itself, but not change them.
using RayObserver = std::function<void(const Work& work, RayKind kind)>;

/// A run of pixels with one or more samples each, at most Batch::capacity rays, and what all passes need to work on it.
struct Work {
    const TracePrograms& tracer;
    const Targets& targets;
    const Batch& batch;
    std::size_t first_pixel;
    std::size_t pixels;
    std::size_t samples;  ///< of far light; the rays of one sample of all pixels stand together
    int light_count;
    bool guided;  ///< rays are sent to emitters
    bool counting;
    const RayObserver& observer;  ///< or none
    std::size_t rays() const { return pixels * samples; }
};

/// Camera rays and the G-buffer; work.samples is 1.
class CameraPass {
public:
    void run(const Work& work) const;

private:
    gl::Program rays_ = load_program("camera.glsl"), gbuffer_ = load_program("gbuffer.glsl");
};

/// Phong with hard shadows from every light; work.samples is 1.
class DirectPass {
public:
    void run(const Work& work) const;

private:
    gl::Program rays_ = load_program("light_rays.glsl"), shade_ = load_program("direct.glsl");
};

/// Hemisphere rays of every pixel, followed over the bounces (after the fourth by Russian roulette), each vertex lit by
/// every light; accumulated whole and split by the near weight of `near_radius`, metres.
class FarLightPass {
public:
    /// Samples from `sample_index` on, so many as the work has.
    void run(const Work& work, unsigned sample_index, int bounces, float near_radius) const;
    /// Mean irradiance / pi after each bounce, on work.rays() paths that start all over the picture; accumulates
    /// nothing.
    std::vector<double> measure(const Work& work, int bounces) const;

private:
    /// Traces the rays of the batch, adds what the paths meet, and the shadow rays from there. What the last of those
    /// bring is still to be added.
    void follow(const Work& work, bool first, bool last) const;
    /// Adds that and leaves the rays of the next bounce. Random numbers are of stream `first_stream` + `bounce`.
    void go_on(const Work& work, unsigned sample_index, int bounce, unsigned first_stream, bool roulette) const;
    /// How rays leave surfaces, with and without emitters to send them to.
    struct Leaving {
        explicit Leaving(const char* constants)
            : hemisphere(load_program("hemisphere.glsl", constants)),
              continuation(load_program("continuation.glsl", constants)) {}
        gl::Program hemisphere, continuation;
    };
    const Leaving& leaving(const Work& work) const;
    Leaving unguided_{"#define guided 0\n"};
    mutable std::optional<Leaving> guided_;  ///< made for the first scene with an emitter
    gl::Program bounce_ = load_program("bounce.glsl", "#define more_follows 1\n"),
                last_bounce_ = load_program("bounce.glsl", "#define more_follows 0\n"),
                next_light_ = load_program("next_light.glsl"), gather_ = load_program("gather.glsl");
};

/// One short ray per pixel within the AO radius; work.samples is 1.
class OcclusionPass {
public:
    void run(const Work& work, unsigned sample_index, float radius) const;

private:
    gl::Program hemisphere_ = load_program("hemisphere.glsl", "#define guided 0\n"),
                gather_ = load_program("occlusion.glsl");
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

/// Accumulators and filtered light to targets.view(), linear.
class SynthesisPass {
public:
    /// Method::paper takes `blurred`, Method::farfield `filtered` (for the views that show it) and `estimate`; others
    /// may be null.
    void run(Targets& targets, const gl::Texture* blurred, const gl::Raster* filtered, const gl::Raster* estimate,
             int view, Method method, int frames) const;

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
