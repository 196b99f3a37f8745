#include "app/chart_tables.h"

#include <fmt/format.h>

#include <algorithm>

namespace farfield {
namespace {

std::string cell(double error) { return error > 0.0 ? fmt::format("{:.3f}", error) : "below the noise"; }

std::string header(const std::string& first, const std::vector<std::string>& columns) {
    std::string text = "| " + first + " |", rule = "|---|";
    for (const std::string& column : columns) text += " " + column + " |", rule += "---|";
    return text + "\n" + rule + "\n";
}

std::string equal_samples(const std::vector<ChartPanel>& all) {
    std::vector<std::string> columns{"method"};
    const std::vector<ChartPoint> counts = curve(all.front().points, Method::farfield);
    for (const ChartPoint& p : counts) columns.push_back(fmt::format("{} samples", p.setting.samples));
    std::string text =
        "## Equal samples\n\nRMSE / mean of indirect light (mean bias; FLIP of the picture), by samples per "
        "pixel.\n\n" +
        header("scene", columns);
    for (const ChartPanel& panel : all)
        for (const MethodStyle& style : method_styles) {
            text += fmt::format("| {} | {} |", panel.title, style.name);
            for (const ChartPoint& p : curve(panel.points, style.method))
                text += fmt::format(" {} ({:+.1f} %; {:.3f}) |", cell(p.error), 100.0 * p.bias, p.flip);
            text += "\n";
        }
    return text;
}

std::string equal_time(const std::vector<ChartPanel>& all) {
    std::string text =
        "\n## Equal time\n\nRMSE / mean after the time that `farfield` takes for so many samples; interpolated between "
        "numbers of samples, linear in logarithms. A dash: the method has no picture that soon, or was not measured "
        "that "
        "long.\n\n" +
        header("scene", {"samples of farfield", "seconds", "farfield", "paper", "reference", "farfield / paper"});
    for (const ChartPanel& panel : all) {
        const auto paper = curve(panel.points, Method::paper), reference = curve(panel.points, Method::reference);
        for (const ChartPoint& p : curve(panel.points, Method::farfield)) {
            const auto other = error_at(paper, p.seconds), raw = error_at(reference, p.seconds);
            const auto shown = [](const std::optional<double>& v) { return v ? cell(*v) : std::string("-"); };
            text += fmt::format("| {} | {} | {:.3g} | {} | {} | {} | {} |\n", panel.title, p.setting.samples, p.seconds,
                                cell(p.error), shown(other), shown(raw),
                                other ? fmt::format("{:.2f}", p.error / *other) : "-");
        }
    }
    return text;
}

std::string equal_error(const std::vector<ChartPanel>& all) {
    constexpr double errors[] = {0.5, 0.3, 0.2, 0.1, 0.05};
    std::vector<std::string> columns{"method"};
    for (const double error : errors) columns.push_back(fmt::format("{}", error));
    std::string text = "\n## Equal error\n\nSeconds until RMSE / mean is at most so much; a dash: not reached.\n\n" +
                       header("scene", columns);
    for (const ChartPanel& panel : all)
        for (const MethodStyle& style : method_styles) {
            text += fmt::format("| {} | {} |", panel.title, style.name);
            for (const double error : errors) {
                const auto seconds = seconds_for(curve(panel.points, style.method), error);
                text += seconds ? fmt::format(" {:.3g} |", *seconds) : " - |";
            }
            text += "\n";
        }
    return text;
}

std::string value_of(const ChartPoint& p) {
    switch (p.varied) {
        case Varied::none:
            return "own";
        case Varied::blur_levels:
            return fmt::format("blur levels {}", p.setting.blur_levels);
        case Varied::ao_radius:
            return fmt::format("AO radius {:g} m", p.setting.ao_radius);
        case Varied::bounces:
            return fmt::format("bounces {}", p.setting.bounces);
        case Varied::scale:
            return fmt::format("scale {:g}", p.setting.scale);
        case Varied::minimum_step:
            return fmt::format("minimum step x {:g}", p.setting.minimum_step);
    }
    return "";
}

std::string each_setting(const ChartScene& scene) {
    std::string text = fmt::format(
        "\n## Settings of {}\n\nRMSE / mean (mean bias) and seconds, one setting varied. Other numbers of bounces are "
        "measured against a reference with the most of them.\n\n",
        scene.name);
    const std::vector<ChartPoint> points = chart_points(scene.measurements);
    std::vector<std::string> columns{"method"}, done;
    for (const ChartPoint& p : curve(points, Method::farfield))
        columns.push_back(fmt::format("{} samples", p.setting.samples));
    text += header("setting", columns);
    for (const ChartPoint& row : points) {
        const auto style = std::ranges::find(method_styles, row.setting.method, &MethodStyle::method);
        const std::string name = fmt::format("| {} | {} |", value_of(row), style->name);
        if (std::find(done.begin(), done.end(), name) != done.end()) continue;
        done.push_back(name);
        text += name;
        for (const ChartPoint& p : points)
            if (p.setting.method == row.setting.method && p.varied == row.varied && value_of(p) == value_of(row))
                text += fmt::format(" {} ({:+.1f} %), {:.3g} s |", cell(p.error), 100.0 * p.bias, p.seconds);
        text += "\n";
    }
    return text;
}

}  // namespace

std::string chart_tables(const std::vector<ChartScene>& scenes, const std::string& title) {
    const std::vector<ChartPanel> all = chart_panels(scenes);
    std::string text = fmt::format(
                           "# {}\n\nMedians over the seeds; the reference's own noise is subtracted. Made by "
                           "`farfield chart` from chart.csv.\n\n",
                           title) +
                       equal_samples(all) + equal_time(all) + equal_error(all);
    for (const ChartScene& scene : scenes) text += each_setting(scene);
    return text;
}

}  // namespace farfield
