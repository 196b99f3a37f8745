// From measurements of many seeds to points and curves of a chart.
#pragma once

#include "renderer/measurement.h"

#include <optional>
#include <vector>

namespace farfield {

double median(std::vector<double> values);  ///< 0 for none

/// RMSE / mean less what the reference's own noise adds: both are independent, so squares subtract. 0 where the error
/// cannot be told from that noise.
double true_error(const Measurement& measurement);

/// In order of first occurrence.
std::vector<ChartPoint> chart_points(const std::vector<Measurement>& measurements);

/// Of the scenes' own settings (Varied::none): geometric means of seconds, error, relative MSE and noise, plain means
/// of bias and FLIP, for what every scene has; their medians over the seeds. Blur levels and the like are the scenes'
/// own.
std::vector<ChartPoint> mean_points(const std::vector<std::vector<Measurement>>& scenes);

/// Points that no other beats in both time and error, by time.
std::vector<ChartPoint> pareto_front(std::vector<ChartPoint> points);

/// The own settings of a method, by samples: a curve.
std::vector<ChartPoint> curve(const std::vector<ChartPoint>& points, Method method);
/// Error that a curve has at a time, linear in the logarithms; none outside of it: a faster picture does not exist, and
/// a better one was not measured.
std::optional<double> error_at(const std::vector<ChartPoint>& curve, double seconds);
/// The least time with at most that error; none when the curve does not get there.
std::optional<double> seconds_for(const std::vector<ChartPoint>& curve, double error);

}  // namespace farfield
