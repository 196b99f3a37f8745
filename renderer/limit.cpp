#include "renderer/limit.h"

#include "renderer/context.h"
#include "renderer/records.h"

#include <algorithm>
#include <charconv>
#include <numeric>
#include <string_view>

namespace farfield {
namespace {

constexpr int plain_evaluations = 32;

/// llvmpipe says how wide its vectors are; other devices run 32 lanes or more in step.
int lanes_in_step(std::string_view device) {
    const std::size_t end = device.find(" bits");
    if (!renders_on_cpu() || end == std::string_view::npos) return 32;
    const std::size_t begin = device.find_last_of(' ', end - 1) + 1;
    int bits = 0;
    std::from_chars(device.data() + begin, device.data() + end, bits);
    return std::max(bits / 32, 1);
}

double multiply_adds_per_second(Stopwatch& watch) {
    constexpr std::size_t invocations = 1 << 16;
    constexpr int turns = 2000;
    const gl::Program program = load_program("limit_fma.glsl");
    program.set("ray_count", static_cast<unsigned>(invocations));
    program.set("turns", turns);
    double shortest = 0.0;
    for (int i = 0; i < 4; ++i) {  // the first compiles
        const double seconds = watch.seconds([&] { program.run(invocations); });
        if (i == 1 || (i > 1 && seconds < shortest)) shortest = seconds;
    }
    return 32.0 * turns * invocations / shortest;
}

/// Evaluations that lanes have time for when rays with so many steps are shared out as in march.glsl.
std::uint64_t lane_slots(const std::vector<std::uint32_t>& steps, std::size_t lanes, std::size_t rays_each,
                         std::size_t claiming_evaluations, int pause) {
    std::uint64_t slots = 0;
    std::vector<std::uint32_t> left(lanes, 0);
    for (std::size_t next = 0; next < steps.size();) {
        const std::size_t end = std::min(next + lanes * rays_each, steps.size());
        std::size_t evaluations = 0;
        for (std::uint32_t longest = 1; longest > 0; evaluations += longest) {
            for (std::uint32_t& l : left)
                while (l == 0 && next < (evaluations < claiming_evaluations ? steps.size() : end)) l = steps[next++];
            longest = std::min(*std::max_element(left.begin(), left.end()), static_cast<std::uint32_t>(pause));
            for (std::uint32_t& l : left) l -= std::min(l, longest);
            slots += longest * lanes;
        }
    }
    return slots;
}

class Census {
public:
    explicit Census(const std::string& device) : watch_(renders_on_cpu()) {
        limit_.device_time = !renders_on_cpu();
        limit_.lanes = lanes_in_step(device);
        limit_.multiply_adds = multiply_adds_per_second(watch_);
        counters_.resize(sizeof(CounterRecord));
    }
    const Limit& limit() const { return limit_; }

    void trace(const Work& work, RayKind kind) {
        const TracePrograms& tracer = work.tracer;
        if (plain_.empty()) prepare(tracer);
        auto found =
            std::find_if(limit_.rays.begin(), limit_.rays.end(), [&](const auto& r) { return r.kind == kind; });
        if (found == limit_.rays.end()) found = limit_.rays.insert(found, RayLimit{.kind = kind});
        const auto march = [&](std::size_t part) { tracer.march(part, work.rays(), !needs_surfaces(kind)); };
        counters_.bind_storage(binding::counters);
        CounterRecord counters;
        counters_.upload(&counters, sizeof counters);
        for (std::size_t part = 0; part < tracer.parts(); ++part) march(part);
        tracer.count(work.rays());
        counters_.read(&counters, sizeof counters);
        found->rays += counters.rays;
        found->exhausted += counters.exhausted_rays;

        std::uint64_t evaluations = 0;
        double plain_seconds = 0.0;
        std::vector<std::uint32_t> before(work.rays(), 0);
        for (std::size_t part = 0; part < tracer.parts(); ++part) {
            found->march_seconds += watch_.seconds([&] { march(part); });
            const std::vector<std::uint32_t> after = steps(work);
            std::vector<std::uint32_t> own(work.rays());
            for (std::size_t i = 0; i < work.rays(); ++i) evaluations += own[i] = after[i] - before[i];
            found->lane_evaluations +=
                lane_slots(own, static_cast<std::size_t>(limit_.lanes), tracer.rays_each(part, work.rays()),
                           tracer.claiming_evaluations(part), tracer.pause());
            before = after;
            const auto near = std::count_if(own.begin(), own.end(), [](auto s) { return s > 0; });
            const auto all = std::accumulate(own.begin(), own.end(), std::int64_t{0});
            plain_[part].set("march_evaluations", near > 0 ? static_cast<int>((all + near / 2) / near) : 1);
        }
        for (std::size_t part = 0; part < tracer.parts(); ++part)
            plain_seconds += watch_.seconds([&] { tracer.run(plain_[part], part, work.rays()); });
        found->evaluations += evaluations;
        found->oracle_evaluations +=
            static_cast<std::uint64_t>(std::count_if(before.begin(), before.end(), [](auto s) { return s > 0; }));
        found->plain_seconds += plain_seconds * static_cast<double>(evaluations) /
                                static_cast<double>(work.rays() * tracer.parts() * plain_evaluations);
    }

private:
    void prepare(const TracePrograms& tracer) {
        plain_ = tracer.make_kernels("limit_plain.glsl");
        for (std::size_t part = 0; part < tracer.parts(); ++part) {
            plain_[part].set("evaluations", plain_evaluations);
            tracer.run(plain_[part], part, 1);  // drivers compile at first use
        }
    }

    /// Of the batch's rays so far.
    static std::vector<std::uint32_t> steps(const Work& work) {
        struct HitRecord {
            float distance;
            std::uint32_t normal, material, steps;
        };
        static_assert(sizeof(HitRecord) == hit_bytes);
        std::vector<HitRecord> hits(work.rays());
        work.batch.hits.read(hits.data(), hits.size() * hit_bytes);
        std::vector<std::uint32_t> result;
        for (const HitRecord& hit : hits) result.push_back(hit.steps & 0x7fffu);
        return result;
    }

    Limit limit_;
    Stopwatch watch_;
    std::vector<gl::Program> plain_;  ///< for each part
    gl::Buffer counters_{"counters of the census"};
};

}  // namespace

Limit measure_limit(Renderer& renderer) {
    Census census(renderer.statistics().device);
    renderer.observe([&](const Work& work, RayKind kind) { census.trace(work, kind); });
    renderer.render_frame();
    renderer.observe({});
    return census.limit();
}

}  // namespace farfield
