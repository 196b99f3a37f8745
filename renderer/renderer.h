// Scene and settings to picture, progressively: every frame adds samples to the accumulators until the scene, the
// camera or the light transport changes. Blur levels, exposure, view and method never discard what was accumulated;
// another AO radius discards the ambient occlusion and the split of far light alone, because its sum does not depend on
// it.
//
// Work comes in bounded steps, so that a caller can drop it as soon as an edit makes it stale.
#pragma once

#include "renderer/image.h"
#include "renderer/passes.h"
#include "renderer/reprojection.h"
#include "renderer/statistics.h"
#include "renderer/timers.h"
#include "renderer/views.h"
#include "sdf/field_tree.h"
#include "sdf/scene.h"

#include <chrono>
#include <functional>
#include <memory>
#include <optional>

namespace farfield {

inline constexpr int most_bounces = 8;  ///< that automatic bounces come to

struct FrameOptions {
    glm::ivec2 size{512, 512};
    View view = View::result;
    std::optional<Look> other = {};  ///< displayed beside the scene's own, to compare
    std::uint32_t seed = 0;
    Tier tier = Tier::specialised;  ///< live: no parameter edit needs a new program
    Id tuned = 0;                   ///< node with live parameters in the specialised tier
    int samples = 0;                ///< hemisphere rays per pixel and frame; 0: the scene's setting
    int first_frame = 0;            ///< the sequences of samples go on after so many frames that are elsewhere
    bool measure_bounces = false;   ///< what each adds; automatic bounces otherwise go on with what was measured last
    bool counting = false;          ///< count rays and evaluations; costs a little
    float minimum_step = 1.0f;      ///< of the tracer, times the usual: how far off hits may be
    int step_limit = 0;             ///< evaluations of the distance for each ray; 0: the tracer's own limit
    bool reprojection = false;      ///< keep the indirect light where the camera moves; see reprojection.h
    bool occlusion = false;         ///< trace ambient occlusion even where neither method nor view shows it
    std::size_t batch =
        Batch::capacity;  ///< pixels for each step, at most Batch::capacity; changes no bit of the picture
};

/// Everything that accumulated samples depend on, to compare. The size of the picture stands apart.
struct Transport {
    FieldTree geometry;
    std::string light;   ///< materials, lights, sky, seed, bounces: bytes
    std::string camera;  ///< relative to local_origin, which the light's records are relative to as well
    friend bool operator==(const Transport&, const Transport&) = default;
};
Transport transport(const Scene& scene, const FrameOptions& options);

/// Whether to estimate the noise again, after so many samples: the first few say little, and it falls slowly.
inline bool noise_due(int samples, int last_estimated_at) {
    return samples >= 16 && samples >= last_estimated_at + last_estimated_at / 4;
}

class Renderer {
public:
    /// Needs a current context, as does every call.
    Renderer();

    /// Takes over the scene and options, decides what stays valid and compiles where the structure is new. Throws
    /// ShaderError and goes on with the last good scene. True when accumulated samples were discarded.
    bool update(const Scene& scene, const FrameOptions& options);
    /// How many parts `update` with these would have to compile; at least one for a scene that it refuses.
    int missing_programs(const Scene& scene, Tier tier, Id tuned = 0) const {
        return programs_.missing(scene, tier, tuned);
    }
    bool needs_compile(const Scene& scene, Tier tier, Id tuned = 0) const {
        return missing_programs(scene, tier, tuned) > 0;
    }

    /// Compiles one kernel of those that `update` would have to compile, and changes nothing else; how many parts are
    /// not complete yet. Throws ShaderError.
    int compile_one(const Scene& scene, Tier tier, Id tuned = 0);

    /// Whether `update` with these would keep the accumulated samples, but for a change of size.
    bool keeps_samples(const Scene& scene, const FrameOptions& options) const;

    /// Whether an update has succeeded so far; nothing below may be called before.
    bool ready() const { return targets_.has_value(); }

    /// Drops all accumulated samples and what is left of the past; the next frame is the first again.
    void discard();

    /// Nothing was done for so long: that is no time of the current frame.
    void paused(std::chrono::steady_clock::duration time) { frame_start_ += time; }

    /// One bounded piece of the current frame. True when that finished the frame.
    bool step();
    /// Whether there is something to show: the whole picture has direct light and a sample of far light.
    bool displayable() const;
    void render_frame();

    /// The current view in 8 bits, into a texture of the picture's size, and the other look into `other`, where there
    /// is one. `stop` is asked now and then; false when it said so, and neither is to be shown.
    bool display(const gl::Texture& output, const gl::Texture& other = {}, const std::function<bool()>& stop = {});
    std::vector<unsigned char> display_pixels();  ///< RGB, row 0 at the top
    Image read(View view);                        ///< linear

    /// RMSE / mean of indirect light, estimated; see METHOD.md for how well. Of `farfield` as it is filtered, else that
    /// of the accumulated samples by their second moments. 0 where there is no light, infinite with less than two
    /// samples; nothing where `stop`, which is asked now and then, said so. Filters the picture once more and reads 40
    /// bytes for each pixel from the device.
    std::optional<double> noise(const std::function<bool()>& stop = {});

    /// Is told of all rays from now on; see passes.h.
    void observe(RayObserver observer) { observer_ = std::move(observer); }
    /// What it holds of the device's memory: for the picture, and whatever the picture, in bytes.
    std::size_t picture_bytes() const { return targets_->bytes(); }
    std::size_t fixed_bytes() const { return batch_.bytes(); }

    const Statistics& statistics() const { return statistics_; }
    glm::ivec2 size() const { return options_.size; }

private:
    void note_compiles();
    void restart();
    void keep_past();
    void begin_frame();
    void finish_frame();
    Look own_look(View view) const {
        return {view, scene_.settings.method, blur_levels(scene_.settings.blur_levels, options_.size)};
    }
    /// Makes `estimate_` or, of the paper's method, `blurred_`; false when `stop` said so.
    bool filter(const Look& look, const std::function<bool()>& stop = {});
    void synthesise(const Look& look);
    Work next_work() const;
    int bounces() const { return scene_.settings.bounces > 0 ? scene_.settings.bounces : automatic_bounces_; }
    void measure_bounces();
    /// Of far light in one piece of work.
    std::size_t samples_together() const;
    /// With those: one for each, and three more at first, because one ray alone answers black or white: a first picture
    /// without speckle for a few percent of its time.
    unsigned occlusion_rays() const {
        const auto shows = [](const Look& look) {
            return look.method == Method::paper || look.view == View::occlusion;
        };
        const bool shown = shows(own_look(options_.view)) || (options_.other && shows(*options_.other));
        if (!shown && !options_.occlusion) return 0;
        return static_cast<unsigned>(samples_together()) + (occlusion_samples_ == 0 ? 3 : 0);
    }

    TracePrograms programs_;
    CameraPass camera_pass_;
    DirectPass direct_pass_;
    FarLightPass far_light_pass_;
    OcclusionPass occlusion_pass_;
    FilterPass filter_pass_;
    WaveletPass wavelet_pass_;
    SynthesisPass synthesis_pass_;
    DisplayPass display_pass_;
    Reprojection past_;
    RayObserver observer_;
    Batch batch_;
    gl::Buffer frame_{"frame"}, materials_{"materials"}, lights_{"lights"}, emitters_{"emitters"},
        counters_{"counters"};
    std::optional<Targets> targets_;
    Timers timers_;

    Scene scene_;
    FrameOptions options_;
    Transport transport_;
    gl::Raster* estimate_ = nullptr;        ///< of farfield, as filtered last since the last discard
    const gl::Texture* blurred_ = nullptr;  ///< of the paper's filter
    float estimate_unit_ = 0.0f;            ///< samples that a w of 1 in it stands for
    std::uint32_t moves_ = 0;  ///< of the camera since anything else changed: each picture takes other samples

    // The frame being rendered: batch after batch the camera and direct light, then sample after sample the far light.
    bool in_frame_ = false;
    std::size_t batch_size_ = 0;
    std::size_t first_pixel_ = 0;  ///< of the next batch
    int sample_ = -1;              ///< of this frame; -1: camera and direct light
    int frame_samples_ = 0;
    int completed_cameras_ = 0;  ///< frames whose camera pass is in the accumulators
    unsigned far_samples_ = 0;   ///< of every pixel since the last discard
    unsigned occlusion_samples_ = 0;
    int emitter_count_ = 0;
    int automatic_bounces_ = 0;  ///< enough by the last measurement; 0: none yet
    bool bounces_measured_ = false;
    std::chrono::steady_clock::time_point frame_start_;
    Statistics statistics_;
};

}  // namespace farfield
