#include "renderer/sweep.h"

#include "renderer/context.h"
#include "renderer/flip.h"
#include "renderer/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace farfield {
namespace {

/// Readings of every method with the scene's own blur levels; the reference has none.
std::vector<SweepRun::Reading> own_readings(Varied varied, int blur_levels) {
    return {
        {varied, Method::paper, blur_levels}, {varied, Method::farfield, blur_levels}, {varied, Method::reference, 0}};
}

/// The part of the last frame that was ambient occlusion, 0..1.
double occlusion_share(const Statistics& statistics) {
    double all = 0.0, occlusion = 0.0;
    for (const PassTime& pass : statistics.passes) {
        all += pass.milliseconds;
        if (pass.name == "ambient occlusion") occlusion += pass.milliseconds;
    }
    return all > 0.0 ? occlusion / all : 0.0;
}

glm::ivec2 scaled(glm::ivec2 size, float scale) {
    return glm::max(glm::ivec2(glm::round(glm::vec2(size) * scale)), glm::ivec2(1));
}

}  // namespace

std::string measurement_key(const Scene& scene, glm::ivec2 size) {
    static const std::string shaders = shader_hash(true);
    const Settings& s = scene.settings;
    return sha256(fmt::format("{} {} {} {} {} {}", reference_key(scene, size), shaders, s.samples, s.blur_levels,
                              s.ao_radius, s.exposure));
}

std::string why_unmeasurable(const Reference& reference) {
    if (mean(reference.indirect()) > 0.0) return {};
    return "no indirect light is seen, so errors relative to its mean have no value";
}

Sweep::Sweep(Scene scene, SweepPlan plan) : scene_(std::move(scene)), plan_(std::move(plan)) {
    Settings& own = scene_.settings;
    own.blur_levels = blur_levels(own.blur_levels, plan_.size);
    std::ranges::sort(plan_.samples);
    frame_samples_ = own.samples;
    for (const int samples : plan_.samples) frame_samples_ = std::gcd(frame_samples_, samples);

    for (std::uint32_t seed = 1; seed <= static_cast<std::uint32_t>(plan_.seeds); ++seed) {
        SweepRun run{
            own.ao_radius, own.bounces, 1.0f, 1.0f, seed, own.bounces, own_readings(Varied::none, own.blur_levels)};
        for (const int levels : plan_.blur_levels) {
            if (levels == own.blur_levels) continue;
            run.readings.push_back({Varied::blur_levels, Method::paper, levels});
            run.readings.push_back({Varied::blur_levels, Method::farfield, levels});
        }
        runs_.push_back(run);
        for (const float factor : plan_.ao_factors) {
            if (factor == 1.0f) continue;
            run.readings = own_readings(Varied::ao_radius, own.blur_levels);
            run.readings.pop_back();  // the reference knows no AO radius
            run.ao_radius = own.ao_radius * factor;
            runs_.push_back(run);
        }
        run.ao_radius = own.ao_radius;
        for (const float scale : plan_.scales) {
            if (scale == 1.0f) continue;
            run.readings = own_readings(Varied::scale, own.blur_levels);
            run.scale = scale;
            runs_.push_back(run);
        }
        run.scale = 1.0f;
        for (const float step : plan_.minimum_steps) {
            if (step == 1.0f) continue;
            run.readings = own_readings(Varied::minimum_step, own.blur_levels);
            run.minimum_step = step;
            runs_.push_back(run);
        }
        run.minimum_step = 1.0f;
        for (const int bounces : plan_.bounces) {
            run.readings = own_readings(Varied::bounces, own.blur_levels);
            run.bounces = bounces;
            run.reference_bounces =
                own.bounces == 0 ? 0 : std::max(own.bounces, *std::ranges::max_element(plan_.bounces));
            if (bounces != own.bounces || run.reference_bounces != own.bounces) runs_.push_back(run);
        }
    }
}

std::vector<int> Sweep::reference_bounces() const {
    std::vector<int> bounces;
    for (const SweepRun& run : runs_)
        if (std::ranges::find(bounces, run.reference_bounces) == bounces.end())
            bounces.push_back(run.reference_bounces);
    return bounces;
}

Scene Sweep::scene(int bounces) const {
    Scene scene = scene_;
    scene.settings.bounces = bounces;
    return scene;
}

std::vector<Measurement> Sweep::expected(const SweepRun& run) const {
    std::vector<Measurement> all;
    for (const int samples : plan_.samples)
        for (const SweepRun::Reading& reading : run.readings) {
            Measurement m;
            m.varied = reading.varied;
            m.setting = {reading.method, samples,   reading.blur_levels, run.ao_radius,
                         run.bounces,    run.scale, run.minimum_step};
            m.frame_samples = frame_samples_;
            m.seed = run.seed;
            m.reference_bounces = run.reference_bounces;
            m.reference_samples = plan_.reference_samples;
            all.push_back(m);
        }
    return all;
}

bool Sweep::measure(Renderer& renderer, const SweepRun& run, const Reference& reference,
                    const std::function<bool()>& frame_done, const std::function<void(const Measurement&)>& emit) {
    Scene scene = this->scene(run.bounces);
    scene.settings.ao_radius = run.ao_radius;
    FrameOptions options;
    options.size = scaled(plan_.size, run.scale);
    options.seed = run.seed;
    options.samples = frame_samples_;
    options.minimum_step = run.minimum_step;
    options.occlusion = true;
    const Image truth = reference.indirect(), shown = exposed(reference.result(), scene.settings.exposure);
    const double truth_mean = mean(truth);
    const gl::Texture display("display", GL_RGBA8, options.size);
    const bool on_cpu = renders_on_cpu();
    Stopwatch stopwatch(on_cpu);
    const auto show = [&](const Setting& setting) {
        scene.settings.method = setting.method;
        scene.settings.blur_levels = setting.blur_levels;
        renderer.update(scene, options);
        return stopwatch.seconds([&] { renderer.display(display); });
    };
    const std::vector<Measurement> expected = this->expected(run);
    renderer.update(scene, options);
    renderer.discard();
    if (warm_ != options.size) {  // compilers and allocators do their work before the clock runs
        renderer.render_frame();
        for (const Measurement& m : expected)
            if (m.setting.samples == plan_.samples[0]) show(m.setting);
        renderer.discard();
        warm_ = options.size;
    }
    double tracing = 0.0, tracing_without_occlusion = 0.0;
    std::size_t next = 0;
    while (next < expected.size()) {
        double seconds = 0.0;
        if (on_cpu) {
            seconds = stopwatch.seconds([&] { renderer.render_frame(); });
        } else {
            renderer.render_frame();
            for (const PassTime& pass : renderer.statistics().passes) seconds += 1e-3 * pass.milliseconds;
        }
        tracing += seconds;
        tracing_without_occlusion += seconds * (1.0 - occlusion_share(renderer.statistics()));
        if (!frame_done()) return false;
        for (; next < expected.size() && expected[next].setting.samples == renderer.statistics().samples; ++next) {
            Measurement m = expected[next];
            const bool no_occlusion = m.setting.method != Method::paper;
            m.seconds = (no_occlusion ? tracing_without_occlusion : tracing) + show(m.setting);
            m.device_time = !on_cpu;
            const Image result = renderer.read(View::result);
            const Image indirect = difference(result, renderer.read(View::direct));
            const Metrics metrics = farfield::measure(resized(indirect, plan_.size), truth);
            m.rmse_over_mean = metrics.rmse_over_mean;
            m.relative_mse = metrics.relative_mse;
            m.bias = metrics.bias;
            m.flip = flip(exposed(resized(result, plan_.size), scene.settings.exposure), shown);
            m.reference_samples = reference.samples();
            m.noise_rmse_over_mean = truth_mean > 0.0 ? std::sqrt(reference.noise_mse()) / truth_mean : 0.0;
            m.noise_relative_mse = reference.noise_relative_mse();
            emit(m);
        }
    }
    return true;
}

}  // namespace farfield
