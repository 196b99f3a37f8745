// The pictures and tables of `farfield chart`.
#pragma once

#include "renderer/sweep_statistics.h"

#include <filesystem>
#include <string>
#include <vector>

namespace farfield {

struct ChartScene {
    std::string name;
    std::vector<Measurement> measurements;
};

/// chart.gp, a gnuplot script with the data in it: a panel for the scenes' geometric mean where there are several, and
/// one for each scene. Log error against log time; median over the seeds with the smallest and largest, Pareto front,
/// the reference's own noise.
std::string chart_script(const std::vector<ChartScene>& scenes, const std::string& title);

/// tables.md: equal samples, equal time, equal error, and what each setting does.
std::string chart_tables(const std::vector<ChartScene>& scenes, const std::string& title);

/// Runs gnuplot on chart.gp of the folder, which makes chart.svg and chart.png. Throws std::runtime_error, which says
/// so where gnuplot is not installed.
void plot_chart(const std::filesystem::path& folder);

}  // namespace farfield
