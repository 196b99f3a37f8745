#include "app/chart.h"

#include "app/chart_plot.h"
#include "app/chart_table.h"
#include "app/chart_tables.h"
#include "app/commands.h"
#include "app/progress.h"
#include "renderer/reference_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>

namespace farfield {
namespace {

namespace fs = std::filesystem;

/// The work on one scene.
class SceneChart {
public:
    SceneChart(std::string name, const Scene& scene, const SweepPlan& plan) : plan_(plan), sweep_(scene, plan) {
        line_.scene = std::move(name);
        line_.hash = measurement_key(scene, plan.size).substr(0, 12);
        line_.size = plan.size;
    }

    const std::string& name() const { return line_.scene; }

    /// False when the user interrupts.
    bool measure(Renderer& renderer, const ReferenceStore& store, ChartTable& table) {
        line_.device = renderer.statistics().device;
        std::vector<SweepRun> missing;
        for (const SweepRun& run : sweep_.runs())
            if (std::ranges::any_of(sweep_.expected(run), [&](const Measurement& m) { return !table.find(line(m)); }))
                missing.push_back(run);
        std::map<int, Reference> references;  // by bounces
        for (const SweepRun& run : missing)
            if (!references.contains(run.reference_bounces) &&
                !make_reference(renderer, store, run.reference_bounces, references[run.reference_bounces]))
                return false;
        const double frames = static_cast<double>(missing.size()) * sweep_.frames();
        Progress progress(name() + ": measuring, frame", static_cast<int>(std::min(frames, 2e9)));
        const auto frame_done = [&] {
            progress.advance();
            return !Progress::interrupted();
        };
        for (const SweepRun& run : missing)
            if (!sweep_.measure(renderer, run, references.at(run.reference_bounces), frame_done,
                                [&](const Measurement& m) {
                                    if (!table.find(line(m))) table.add(line(m));
                                }))
                return false;
        return true;
    }

    /// What the table has of this scene with these settings.
    ChartScene found(const ChartTable& table) const {
        ChartScene scene{name(), {}};
        for (const SweepRun& run : sweep_.runs())
            for (const Measurement& m : sweep_.expected(run))
                if (const ChartLine* found = table.find(line(m))) scene.measurements.push_back(found->measurement);
        return scene;
    }

private:
    ChartLine line(const Measurement& measurement) const {
        ChartLine line = line_;
        line.measurement = measurement;
        return line;
    }

    /// From the store, and as many samples more as are missing. False when the user interrupts; then the store has what
    /// was finished.
    bool make_reference(Renderer& renderer, const ReferenceStore& store, int bounces, Reference& reference) {
        const Scene scene = sweep_.scene(bounces);
        const std::string key = reference_key(scene, plan_.size);
        std::string problem;
        reference = store.load(key, plan_.size, problem);
        if (!problem.empty()) fmt::print(stderr, "{}\n", problem);
        Progress progress(fmt::format("{}: reference, frame", name()),
                          frames_to_extend(reference, plan_.reference_samples));
        const bool done = extend(
            reference, renderer, scene, plan_.size, plan_.reference_samples,
            [&] {
                progress.advance();
                return !Progress::interrupted();
            },
            [&] { store.save(key, reference); });
        if (const std::string why = why_unmeasurable(reference); done && !why.empty())
            throw std::invalid_argument(fmt::format("{}: {}", name(), why));
        return done;
    }

    SweepPlan plan_;
    Sweep sweep_;
    ChartLine line_;  ///< what all lines of the scene have in common
};

void write_file(const fs::path& file, const std::string& text) {
    std::ofstream out(file, std::ios::binary);
    out << text;
    if (!out.flush()) throw ImageError(fmt::format("{}: cannot be written", file.string()));
}

}  // namespace

int run_chart(const ChartOptions& options) {
    std::vector<SceneChart> charts;
    for (const fs::path& file : options.scenes) {
        const std::string name = file.stem().string();
        if (std::ranges::any_of(charts, [&](const SceneChart& c) { return c.name() == name; }))
            throw std::invalid_argument(fmt::format("{}: another scene is called \"{}\" too", file.string(), name));
        charts.emplace_back(name, load_trusted_scene(file, options.trust_code), options.plan);
    }
    std::error_code error;
    fs::create_directories(options.output, error);
    if (error) throw ImageError(fmt::format("{}: cannot be made: {}", options.output.string(), error.message()));
    const fs::path csv = options.output / "chart.csv";
    ChartTable table(csv);
    for (const std::string& problem : table.problems()) fmt::print(stderr, "{}\n", problem);

    const ReferenceStore store(options.references.empty() ? ReferenceStore::user_folder() : options.references);
    const std::unique_ptr<Context> context = make_headless_context(options.context);
    context->make_current();
    std::string device;
    {
        Renderer renderer;
        device = renderer.statistics().device;
        for (SceneChart& chart : charts)
            if (!chart.measure(renderer, store, table)) {
                fmt::print(stderr, "\ninterrupted: {} has what was measured; the same command goes on from there\n",
                           csv.string());
                return 1;
            }
    }
    context->release();

    std::vector<ChartScene> scenes;
    for (const SceneChart& chart : charts) scenes.push_back(chart.found(table));
    const SweepPlan& plan = options.plan;
    const std::string title =
        fmt::format("Speed against accuracy: {} x {} pixels, {} {}, references of {} samples per pixel", plan.size.x,
                    plan.size.y, plan.seeds, plan.seeds == 1 ? "seed" : "seeds", plan.reference_samples);
    write_file(options.output / "tables.md", chart_tables(scenes, title) + fmt::format("\nMeasured on {}.\n", device));
    write_file(options.output / "chart.gp", chart_script(scenes, title));
    plot_chart(options.output);
    return 0;
}

}  // namespace farfield
