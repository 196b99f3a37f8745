#include "app/measuring.h"

#include "renderer/reference_store.h"
#include "renderer/renderer.h"
#include "renderer/sweep_statistics.h"
#include "sdf/scene_file.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <utility>

namespace farfield {
namespace {

/// About as many pixels as let a room be measured within a minute on two cores, and as noise is averaged over.
constexpr double pixels = 128.0 * 96.0;

SweepPlan plan_for(glm::ivec2 view) {
    const double scale = std::sqrt(pixels / std::max(1.0, static_cast<double>(view.x) * view.y));
    SweepPlan plan;
    plan.size = glm::max(glm::ivec2(glm::round(glm::vec2(view) * static_cast<float>(std::min(scale, 1.0)))), 16);
    plan.samples = {4, 16, 64};  // what a frame can have
    plan.seeds = 3;
    plan.reference_samples = 1024;
    plan.ao_factors = {0.5f, 2.0f};
    plan.bounces = {};
    plan.minimum_steps = {};
    plan.scales = {};
    return plan;
}

/// All that a measurement depends on but what it varies itself.
std::string view_text(Scene scene) {
    const int bounces = scene.settings.bounces;
    scene.settings = {};
    scene.settings.bounces = bounces;
    return to_text(scene);
}

}  // namespace

void Measuring::start(std::unique_ptr<Context> context, std::shared_ptr<const Scene> scene, glm::ivec2 size) {
    stop();
    results_ = {};
    measurements_.clear();
    part_ = 0.0;
    doing_ = problem_ = "";
    news_ = done_ = stop_ = false;
    const SweepPlan plan = plan_for(size);
    results_.size = plan.size;
    results_.running = true;
    view_ = view_text(*scene);
    context_ = std::move(context);
    thread_ = std::thread([this, plan, scene = *scene] { run(scene, plan); });
}

void Measuring::stop() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    results_.running = false;
}

bool Measuring::refresh(const Scene& scene, std::uint64_t revision) {
    const bool was_running = results_.running, was_stale = results_.stale;
    if (revision != revision_ && !view_.empty()) {
        results_.stale = view_text(scene) != view_;
        if (results_.stale) stop();
    }
    revision_ = revision;
    bool news = false;
    {
        const std::lock_guard lock(mutex_);
        news = std::exchange(news_, false);
        if (news) {
            results_.points = chart_points(measurements_);
            results_.front = pareto_front(results_.points);
            results_.device_time = !measurements_.empty() && measurements_[0].device_time;
            results_.progress = static_cast<float>(part_);
            results_.doing = doing_;
            results_.problem = problem_;
        }
        if (done_) results_.running = false;
    }
    if (!results_.running && thread_.joinable()) thread_.join();
    return news || results_.running != was_running || results_.stale != was_stale;
}

void Measuring::tell(double part, std::string doing) {
    const std::lock_guard lock(mutex_);
    part_ = part;
    doing_ = std::move(doing);
    news_ = true;
}

void Measuring::run(const Scene& scene, const SweepPlan& plan) {
    std::string problem;
    try {
        context_->make_current();
        measure(scene, plan);
    } catch (const std::exception& failure) {
        problem = failure.what();
    }
    context_->release();
    const std::lock_guard lock(mutex_);
    problem_ = problem;
    news_ = done_ = true;
}

void Measuring::measure(const Scene& scene, const SweepPlan& plan) {
    const ReferenceStore store(ReferenceStore::user_folder());
    Renderer renderer;
    Sweep sweep(scene, plan);
    const std::string key = reference_key(scene, plan.size);
    std::string ignored;
    Reference reference = store.load(key, plan.size, ignored);

    const int to_extend = frames_to_extend(reference, plan.reference_samples);
    const double all = to_extend + static_cast<double>(sweep.runs().size()) * sweep.frames();
    int done = 0;
    const auto reference_frame = [&] {
        ++done;
        tell(done / all,
             fmt::format("reference, {} samples: {:.0f} %", plan.reference_samples, 100.0 * done / to_extend));
        return !stop_;
    };
    const auto keep = [&] {
        try {
            store.save(key, reference);
        } catch (const ImageError&) {  // it is made again the next time
        }
    };
    if (to_extend > 0 && !extend(reference, renderer, scene, plan.size, plan.reference_samples, reference_frame, keep))
        return;
    if (const std::string why = why_unmeasurable(reference); !why.empty()) throw std::invalid_argument(why);
    for (const SweepRun& run : sweep.runs()) {
        const std::string doing = fmt::format("AO radius {:.3g} m, seed {} of {}", run.ao_radius, run.seed, plan.seeds);
        const auto frame = [&] {
            tell(++done / all, doing);
            return !stop_;
        };
        const auto emit = [&](const Measurement& m) {
            const std::lock_guard lock(mutex_);
            measurements_.push_back(m);
            news_ = true;
        };
        if (!sweep.measure(renderer, run, reference, frame, emit)) return;
    }
}

}  // namespace farfield
