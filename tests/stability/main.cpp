// The stability run: measures every case and writes the report. Exit status 1 where a bound is missed that is not known
// to be.
#include "tests/stability/report.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

namespace farfield::stability {
namespace {

std::vector<Case> all_cases(double soak_minutes) {
    std::vector<Case> all;
    for (const auto& cases : {field_cases(), precision_cases(), extreme_cases(), closed_form_cases(), light_cases(),
                              temporal_cases(), driver_cases(soak_minutes)})
        all.insert(all.end(), cases.begin(), cases.end());
    return all;
}

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

Outcome measure(const Case& c, Stage& stage) {
    Outcome outcome{&c, {}, 0.0};
    const double start = cpu_seconds();
    for (const Point& point : c.values) {
        Figures figures;
        try {
            figures = c.measure(stage, point);
        } catch (const std::exception& error) {
            figures = shared(NAN, error.what());
        }
        outcome.points.push_back({point, std::move(figures), c.bound(point)});
    }
    outcome.seconds = cpu_seconds() - start;
    return outcome;
}

int run(const std::vector<std::string>& only, bool quick, double soak_minutes, const std::filesystem::path& folder) {
    std::vector<Case> cases = all_cases(soak_minutes);
    std::erase_if(cases, [&](const Case& c) {
        const auto named = [&](const std::string& part) { return c.key.find(part) != std::string::npos; };
        return (quick && !c.quick) || (!only.empty() && std::ranges::none_of(only, named));
    });
    Stage stage;
    std::vector<Outcome> outcomes;
    int failed = 0;
    for (const Case& c : cases) {
        const Outcome& o = outcomes.emplace_back(measure(c, stage));
        if (!o.passed() && c.known.empty()) ++failed;
        fmt::print("{}\n", summary(o));
        for (const Measured& m : o.points)
            if (!m.figures.note.empty()) fmt::print("    {:g} {}: {}\n", m.point.value, m.point.label, m.figures.note);
        std::fflush(stdout);
    }
    if (!folder.empty()) {
        write_report(outcomes, stage.renderer().statistics().device, folder);
        fmt::print("The report is {}\n", (folder / "README.md").string());
    }
    return failed > 0 ? 1 : 0;
}

}  // namespace
}  // namespace farfield::stability

int main(int argc, char** argv) {
    CLI::App app{"Measures where the methods are known to fail"};
    std::vector<std::string> only;
    std::string folder;
    bool quick = false;
    double soak_minutes = 0.3;
    app.add_option("case", only, "Those whose name contains one of these; all by default");
    app.add_option("-o,--output", folder, "Write the report into this folder")->take_last();
    app.add_flag("--quick", quick, "Those that are part of the test suite");
    app.add_option("--minutes", soak_minutes, "Of random edits in the case soak")->check(CLI::Range(0.05, 10000.0));
    CLI11_PARSE(app, argc, argv);
    try {
        return farfield::stability::run(only, quick, soak_minutes, folder);
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
}
