#include "app/bench.h"

#include "app/headless.h"
#include "renderer/limit.h"
#include "renderer/sweep_statistics.h"
#include "sdf/atomic_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sys/resource.h>

#include <chrono>

namespace farfield {
namespace {

using Json = nlohmann::ordered_json;

double share(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

Json frame_times(Renderer& renderer, const BenchOptions& options) {
    const gl::Texture picture("display", GL_RGBA8, options.size);
    std::vector<double> cpu, wall, filter;
    Json passes = Json::object();
    for (int i = -1; i < options.frames; ++i) {
        const double cpu_start = process_cpu_seconds();
        const auto wall_start = std::chrono::steady_clock::now();
        renderer.render_frame();
        const double cpu_traced = process_cpu_seconds();
        renderer.display(picture);
        glFinish();
        if (i < 0) continue;  // drivers compile at first use
        cpu.push_back(1e3 * (process_cpu_seconds() - cpu_start));
        filter.push_back(1e3 * (process_cpu_seconds() - cpu_traced));
        wall.push_back(
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - wall_start).count());
        for (const PassTime& pass : renderer.statistics().passes) passes[pass.name] = pass.milliseconds;
    }
    return {{"frame_ms", median(wall)},
            {"frame_cpu_ms", median(cpu)},
            {"filter_and_display_cpu_ms", median(filter)},
            {"passes_ms", passes}};
}

Json evaluations(const Statistics& s) {
    return {{"rays", s.rays}, {"evaluations", s.evaluations}, {"stopped_by_the_step_limit", s.exhausted_rays}};
}

Json limit(Renderer& renderer) {
    const Limit limit = measure_limit(renderer);
    Json kinds = Json::array();
    for (const RayLimit& r : limit.rays) {
        const auto n = [](std::uint64_t v) { return static_cast<double>(v); };
        kinds.push_back({{"kind", ray_kind_names[static_cast<std::size_t>(r.kind)]},
                         {"rays", r.rays},
                         {"evaluations_per_ray", share(n(r.evaluations), n(r.rays))},
                         {"over_oracle", share(n(r.evaluations), n(r.oracle_evaluations))},
                         {"stopped_by_the_step_limit", r.exhausted},
                         {"tracer_evaluations_per_second", share(n(r.evaluations), r.march_seconds)},
                         {"plain_evaluations_per_second", share(n(r.evaluations), r.plain_seconds)},
                         {"tracer_over_plain", share(r.plain_seconds, r.march_seconds)},
                         {"lane_occupancy", share(n(r.evaluations), n(r.lane_evaluations))}});
    }
    return {{"clock", limit.device_time ? "device" : "CPU"},
            {"multiply_adds_per_second", limit.multiply_adds},
            {"lanes_in_step", limit.lanes},
            {"rays", kinds}};
}

Json memory(const Renderer& renderer, glm::ivec2 size) {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const double picture = static_cast<double>(renderer.picture_bytes()) / 1e6;
    return {{"process_peak_mb", static_cast<double>(usage.ru_maxrss) * 1024e-6},
            {"device_fixed_mb", static_cast<double>(renderer.fixed_bytes()) / 1e6},
            {"device_mb_per_megapixel", picture / (1e-6 * size.x * size.y)}};
}

double number(const Json& json, const char* key) { return json.at(key).get<double>(); }

void print_program(const std::string& name, const Json& program, const BenchOptions& options) {
    fmt::print("\n{} program: compiled in {:.0f} ms, process CPU time {:.0f} ms\n", name, number(program, "compile_ms"),
               number(program, "compile_cpu_ms"));
    const Json &times = program.at("times"), &rays = program.at("rays");
    fmt::print("  frame              {:8.1f} ms   {:.2f} frames/s, process CPU time {:.1f} ms (medians of {})\n",
               number(times, "frame_ms"), 1e3 / number(times, "frame_ms"), number(times, "frame_cpu_ms"),
               options.frames);
    for (const auto& [pass, milliseconds] : times.at("passes_ms").items())
        fmt::print("  {:<18} {:8.1f} ms\n", pass, milliseconds.get<double>());
    fmt::print("  filter and display {:8.1f} ms of process CPU time\n", number(times, "filter_and_display_cpu_ms"));
    fmt::print("  rays               {:8}      {:.1f} evaluations per ray, {} stopped by the step limit\n",
               rays.at("rays").get<std::uint64_t>(), share(number(rays, "evaluations"), number(rays, "rays")),
               rays.at("stopped_by_the_step_limit").get<std::uint64_t>());
}

void print_limit(const Json& limit) {
    fmt::print(
        "\nlimit, by {} time: {:.1f} billion multiply-adds a second, {} lanes in step. An oracle that starts where a "
        "ray\n"
        "ends needs one evaluation; the plain loop does nothing but evaluate.\n\n"
        "  {:<18} {:>9} {:>8} {:>9} {:>10} {:>10} {:>8} {:>6} {:>6}\n"
        "  {:<18} {:>9} {:>8} {:>9} {:>10} {:>10} {:>8} {:>6} {:>6}\n",
        limit.at("clock").get<std::string>(), 1e-9 * number(limit, "multiply_adds_per_second"),
        limit.at("lanes_in_step").get<int>(), "rays", "", "evals", "x oracle", "M evals/s", "M evals/s", "tracer",
        "lanes", "out of", "", "", "per ray", "", "tracer", "plain loop", "/ plain", "busy", "steps");
    for (const Json& r : limit.at("rays"))
        fmt::print("  {:<18} {:>9} {:>8.1f} {:>9.1f} {:>10.1f} {:>10.1f} {:>8.2f} {:>4.0f} % {:>6}\n",
                   r.at("kind").get<std::string>(), r.at("rays").get<std::uint64_t>(), number(r, "evaluations_per_ray"),
                   number(r, "over_oracle"), 1e-6 * number(r, "tracer_evaluations_per_second"),
                   1e-6 * number(r, "plain_evaluations_per_second"), number(r, "tracer_over_plain"),
                   100.0 * number(r, "lane_occupancy"), r.at("stopped_by_the_step_limit").get<std::uint64_t>());
}

}  // namespace

int run_bench(const BenchOptions& options) {
    if (!options.json.empty()) check_output(options.json, {".json"});
    Headless headless(load_trusted_scene(options.scene, options.trust_code), options.overrides, options.context);
    const Scene& scene = headless.scene;
    Renderer& renderer = *headless.renderer;
    FrameOptions frame;
    frame.size = options.size;
    const std::string bounces =
        scene.settings.bounces > 0 ? fmt::format("{} bounces", scene.settings.bounces) : "automatic bounces";
    Json report = {{"scene", options.scene.string()},
                   {"nodes", count_nodes(scene)},
                   {"device", renderer.statistics().device},
                   {"context", headless.context->name()},
                   {"size", {options.size.x, options.size.y}},
                   {"samples", scene.settings.samples},
                   {"bounces", bounces}};
    fmt::print("scene     {}, {} nodes\ndevice    {} ({})\npicture   {} x {}, {} samples per frame, {}\n",
               options.scene.string(), count_nodes(scene), renderer.statistics().device, headless.context->name(),
               options.size.x, options.size.y, scene.settings.samples, bounces);

    for (const Tier tier : {Tier::specialised, Tier::live}) {
        if (tier == Tier::live && !options.live) break;
        const char* name = tier == Tier::live ? "live" : "specialised";
        frame.tier = tier;
        frame.counting = false;
        const double compile_start = process_cpu_seconds();
        renderer.update(scene, frame);
        Json program = {{"compile_ms", renderer.statistics().compile_milliseconds},
                        {"compile_cpu_ms", 1e3 * (process_cpu_seconds() - compile_start)}};
        program["times"] = frame_times(renderer, options);
        frame.counting = true;
        renderer.update(scene, frame);
        renderer.render_frame();
        program["rays"] = evaluations(renderer.statistics());
        print_program(name, program, options);
        if (options.limit) {
            program["limit"] = limit(renderer);
            print_limit(program["limit"]);
        }
        report[name] = std::move(program);
    }
    report["memory"] = memory(renderer, options.size);
    const Json& used = report["memory"];
    fmt::print("\nmemory    {:.0f} MB of the process at most; on the device {:.0f} MB, and {:.0f} MB per megapixel\n",
               number(used, "process_peak_mb"), number(used, "device_fixed_mb"),
               number(used, "device_mb_per_megapixel"));
    if (!options.json.empty()) write_atomically(options.json, report.dump(2) + "\n");
    return 0;
}

}  // namespace farfield
