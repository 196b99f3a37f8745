// The picture of `farfield chart`, drawn by gnuplot.
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

struct ChartPanel {
    std::string title;
    std::vector<ChartPoint> points;
};
/// The scenes' geometric mean where there are several, then each scene.
std::vector<ChartPanel> chart_panels(const std::vector<ChartScene>& scenes);

/// The methods in the order to draw them, and how: told apart by people who see no red or green (Okabe and Ito 2008).
struct MethodStyle {
    Method method;
    const char* name;
    const char* colour;
};
inline constexpr MethodStyle method_styles[] = {{Method::paper, "paper", "#d55e00"},
                                                {Method::reference, "reference", "#808080"},
                                                {Method::farfield, "farfield", "#0072b2"}};

/// chart.gp, a gnuplot script with the data in it. Log error against log time: medians over the seeds with the smallest
/// and largest, Pareto front, other settings, the reference's own noise.
std::string chart_script(const std::vector<ChartScene>& scenes, const std::string& title);

/// Runs gnuplot on chart.gp of the folder, which makes chart.svg and chart.png. Throws std::runtime_error, which says
/// so where gnuplot is not installed.
void plot_chart(const std::filesystem::path& folder);

}  // namespace farfield
