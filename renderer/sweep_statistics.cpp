#include "renderer/sweep_statistics.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace farfield {
namespace {

double interpolated(double x, double x0, double x1, double y0, double y1) {
    return std::exp(std::lerp(std::log(y0), std::log(y1), std::log(x / x0) / std::log(x1 / x0)));
}

}  // namespace

double median(std::vector<double> values) {
    if (values.empty()) return 0.0;
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

double true_error(const Measurement& m) {
    return std::sqrt(
        std::max(m.rmse_over_mean * m.rmse_over_mean - m.noise_rmse_over_mean * m.noise_rmse_over_mean, 0.0));
}

std::vector<ChartPoint> chart_points(const std::vector<Measurement>& measurements) {
    std::vector<ChartPoint> points;
    std::vector<std::vector<const Measurement*>> groups;
    for (const Measurement& m : measurements) {
        std::size_t i = 0;
        while (i < points.size() && !(points[i].varied == m.varied && points[i].setting == m.setting)) ++i;
        if (i == points.size()) {
            points.push_back({m.varied, m.setting});
            groups.emplace_back();
        }
        groups[i].push_back(&m);
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto median_of = [&](auto value) {
            std::vector<double> values;
            for (const Measurement* m : groups[i]) values.push_back(value(*m));
            return median(values);
        };
        ChartPoint& p = points[i];
        p.seeds = static_cast<int>(groups[i].size());
        p.seconds = median_of([](const Measurement& m) { return m.seconds; });
        p.error = median_of(true_error);
        p.relative_mse =
            median_of([](const Measurement& m) { return std::max(m.relative_mse - m.noise_relative_mse, 0.0); });
        p.bias = median_of([](const Measurement& m) { return m.bias; });
        p.flip = median_of([](const Measurement& m) { return m.flip; });
        p.noise = median_of([](const Measurement& m) { return m.noise_rmse_over_mean; });
        p.low = p.high = p.error;
        for (const Measurement* m : groups[i]) {
            p.low = std::min(p.low, true_error(*m));
            p.high = std::max(p.high, true_error(*m));
        }
    }
    return points;
}

std::vector<ChartPoint> mean_points(const std::vector<std::vector<Measurement>>& scenes) {
    std::map<std::tuple<Method, int, std::uint32_t>, std::vector<const Measurement*>> groups;
    for (const std::vector<Measurement>& scene : scenes)
        for (const Measurement& m : scene)
            if (m.varied == Varied::none) groups[{m.setting.method, m.setting.samples, m.seed}].push_back(&m);
    std::vector<Measurement> means;
    for (const auto& [key, group] : groups) {
        if (group.size() != scenes.size()) continue;
        const double n = static_cast<double>(group.size());
        Measurement mean;
        mean.setting.method = std::get<Method>(key);
        mean.setting.samples = std::get<int>(key);
        mean.seed = std::get<std::uint32_t>(key);
        double seconds = 0.0, error = 0.0, relative_mse = 0.0;
        for (const Measurement* m : group) {
            seconds += std::log(m->seconds) / n;
            error += std::log(true_error(*m)) / n;  // -inf, so a mean of 0, where it is 0
            relative_mse += std::log(std::max(m->relative_mse - m->noise_relative_mse, 0.0)) / n;
            mean.bias += m->bias / n;
            mean.flip += m->flip / n;
        }
        mean.seconds = std::exp(seconds);
        mean.rmse_over_mean = std::exp(error);
        mean.relative_mse = std::exp(relative_mse);
        means.push_back(mean);
    }
    std::vector<ChartPoint> points = chart_points(means);
    double noise = 0.0;
    for (const std::vector<Measurement>& scene : scenes)
        noise +=
            std::log(scene.empty() ? 0.0 : scene.front().noise_rmse_over_mean) / static_cast<double>(scenes.size());
    for (ChartPoint& p : points) p.noise = std::exp(noise);
    return points;
}

std::vector<ChartPoint> pareto_front(std::vector<ChartPoint> points) {
    std::sort(points.begin(), points.end(), [](const ChartPoint& a, const ChartPoint& b) {
        return std::pair(a.seconds, a.error) < std::pair(b.seconds, b.error);
    });
    std::vector<ChartPoint> front;
    for (const ChartPoint& p : points)
        if (front.empty() || p.error < front.back().error) front.push_back(p);
    return front;
}

std::vector<ChartPoint> curve(const std::vector<ChartPoint>& points, Method method) {
    std::vector<ChartPoint> found;
    for (const ChartPoint& p : points)
        if (p.varied == Varied::none && p.setting.method == method) found.push_back(p);
    std::sort(found.begin(), found.end(),
              [](const ChartPoint& a, const ChartPoint& b) { return a.setting.samples < b.setting.samples; });
    return found;
}

std::optional<double> error_at(const std::vector<ChartPoint>& curve, double seconds) {
    for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
        const ChartPoint &a = curve[i], &b = curve[i + 1];
        if (a.seconds <= seconds && seconds <= b.seconds && a.seconds < b.seconds && a.error > 0.0 && b.error > 0.0)
            return interpolated(seconds, a.seconds, b.seconds, a.error, b.error);
    }
    return std::nullopt;
}

std::optional<double> seconds_for(const std::vector<ChartPoint>& curve, double error) {
    if (curve.empty()) return std::nullopt;
    if (curve.front().error <= error) return curve.front().seconds;
    for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
        const ChartPoint &a = curve[i], &b = curve[i + 1];
        if (a.error > error && b.error <= error)
            return b.error > 0.0 ? interpolated(error, a.error, b.error, a.seconds, b.seconds) : b.seconds;
    }
    return std::nullopt;
}

}  // namespace farfield
