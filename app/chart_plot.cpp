#include "app/chart_plot.h"

#include "app/gnuplot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace farfield {
namespace {

struct Marker {
    Varied varied;
    const char* label;
    int point_type;  ///< of gnuplot
};
constexpr Marker markers[] = {{Varied::blur_levels, "other blur levels", 1},
                              {Varied::ao_radius, "other AO radii", 2},
                              {Varied::scale, "smaller picture", 8},
                              {Varied::minimum_step, "longer minimum step", 4}};

/// 1, 2 and 5 times every power of ten within the range.
std::string tics(double low, double high) {
    std::string text;
    for (int e = static_cast<int>(std::floor(std::log10(low))); std::pow(10.0, e) <= high; ++e)
        for (const double m : {1.0, 2.0, 5.0})
            if (const double v = m * std::pow(10.0, e); v >= low && v <= high)
                text += fmt::format("{}\"{:g}\" {:g}", text.empty() ? "" : ", ", v, v);
    return text;
}

/// The smallest and largest of the positive values, apart in any case.
struct Range {
    double low = 1e30, high = 0.0;
    void add(double v) {
        if (!(v > 0.0)) return;
        low = std::min(low, v);
        high = std::max(high, v);
    }
    Range widened(double below, double above) const {
        return high > 0.0 ? Range{low * below, high * above} : Range{0.1, 1.0};
    }
};

/// Data blocks and the arguments of one plot command.
class Panel {
public:
    Panel(const ChartPanel& panel, std::size_t index) : panel_(panel), index_(index) {
        for (const ChartPoint& p : panel.points) {
            seconds_.add(p.seconds);
            if (p.varied == Varied::none) noise_ = std::max(noise_, p.noise);
        }
        if (noise_ > 0.0)
            plots_.push_back(
                fmt::format("{:g} with lines lc rgb \"#a0a0a0\" dt 2 lw 1 title \"noise of the reference\"", noise_));
        add("front", pareto_front(panel.points), "1:2 with steps lc rgb \"#f2d27a\" lw 4", "Pareto front");
        for (const Marker& marker : markers) {
            for (const MethodStyle& style : method_styles)
                add(fmt::format("{}_{}", varied_keys[static_cast<int>(marker.varied)], style.name),
                    some(marker.varied, style.method),
                    fmt::format("1:2 with points pt {} ps 0.7 lc rgb \"{}\"", marker.point_type, style.colour), "");
        }
        for (const MethodStyle& style : method_styles) {
            const std::vector<ChartPoint> line = curve(panel.points, style.method);
            add(std::string("spread_") + style.name, line,
                fmt::format("1:2:3:4 with yerrorbars lc rgb \"{}\" lw 1.5 pt 7 ps 0.1", style.colour), "");
            add(style.name, line, fmt::format("1:2 with linespoints lc rgb \"{}\" lw 2 pt 7 ps 0.8", style.colour),
                style.method == Method::farfield ? "farfield, with samples per pixel" : style.name);
            if (style.method == Method::farfield)
                add("samples", line,
                    fmt::format("1:2:5 with labels offset 0.8,0.9 font \",8\" tc rgb \"{}\"", style.colour), "");
        }
    }

    const std::string& data() const { return data_; }

    bool has(Varied varied) const {
        return std::ranges::any_of(panel_.points, [&](const ChartPoint& p) { return p.varied == varied; });
    }

    /// One entry of the legend for all methods and panels.
    void explain(const Marker& marker) {
        plots_.push_back(fmt::format("NaN with points pt {} ps 0.7 lc rgb \"#404040\" title {}", marker.point_type,
                                     quoted(marker.label)));
    }

    std::string plot() const {
        const Range x = seconds_.widened(0.6, 1.9);
        return fmt::format(
            "set title {} noenhanced font \",12\" offset 0,-0.6\nset xrange [{:g}:{:g}]\nset xtics ({})\n{}\nplot {}\n",
            quoted(panel_.title), x.low, x.high, tics(x.low, x.high),
            index_ == 0 ? "set key bottom left opaque samplen 2 font \",9\" Left reverse" : "unset key",
            fmt::join(plots_, ", \\\n  "));
    }

private:
    std::vector<ChartPoint> some(Varied varied, Method method) const {
        std::vector<ChartPoint> found;
        for (const ChartPoint& p : panel_.points)
            if (p.varied == varied && p.setting.method == method) found.push_back(p);
        return found;
    }

    /// A data block with those points that a logarithmic axis can show, and how to plot it.
    void add(const std::string& name, const std::vector<ChartPoint>& points, const std::string& style,
             const std::string& label) {
        std::string lines;
        for (const ChartPoint& p : points)
            if (p.error > 0.0)
                lines += fmt::format("{:g} {:g} {:g} {:g} {}\n", p.seconds, p.error, std::max(p.low, 0.1 * p.error),
                                     p.high, p.setting.samples);
        if (lines.empty()) return;
        data_ += fmt::format("${}{} << END\n{}END\n", name, index_, lines);
        plots_.push_back(fmt::format("${}{} using {} {}", name, index_, style,
                                     label.empty() ? "notitle" : "title " + quoted(label)));
    }

    const ChartPanel& panel_;
    std::size_t index_;
    Range seconds_;
    double noise_ = 0.0;
    std::string data_;
    std::vector<std::string> plots_;
};

}  // namespace

std::vector<ChartPanel> chart_panels(const std::vector<ChartScene>& scenes) {
    std::vector<ChartPanel> panels;
    std::vector<std::vector<Measurement>> measurements;
    for (const ChartScene& scene : scenes) {
        measurements.push_back(scene.measurements);
        panels.push_back({scene.name, chart_points(scene.measurements)});
        // With other bounces the reference is another one.
        std::erase_if(panels.back().points, [](const ChartPoint& p) { return p.varied == Varied::bounces; });
    }
    if (scenes.size() > 1)
        panels.insert(panels.begin(),
                      {fmt::format("geometric mean of {} scenes", scenes.size()), mean_points(measurements)});
    return panels;
}

std::string chart_script(const std::vector<ChartScene>& scenes, const std::string& title) {
    const std::vector<ChartPanel> all = chart_panels(scenes);
    const int columns = all.size() == 1 ? 1 : all.size() <= 8 ? 2 : 3;  // to be read at the width of a page
    const int rows = (static_cast<int>(all.size()) + columns - 1) / columns;
    const bool device_time = std::ranges::any_of(
        scenes, [](const ChartScene& s) { return !s.measurements.empty() && s.measurements[0].device_time; });
    Range errors;
    for (const ChartPanel& panel : all)
        for (const ChartPoint& p : panel.points)
            for (const double v : {p.error, p.high, p.noise}) errors.add(v);
    errors = errors.widened(0.8, 1.25);

    std::vector<Panel> panels;
    std::string script = fmt::format(
        "# {}\n# Run by gnuplot in this folder it makes chart.svg and chart.png.\nset encoding utf8\n", title);
    for (const ChartPanel& panel : all) script += panels.emplace_back(panel, panels.size()).data();
    script += fmt::format(
        "do for [type in \"svg png\"] {{\n"
        "if (type eq \"svg\") {{ set terminal svg size {0},{1} font \"Inter,13\" background \"white\" dynamic }}\n"
        "else {{ set terminal pngcairo size {0},{1} font \"Inter,10\" background \"white\" }}\n"
        "set output \"chart.\".type\nset multiplot layout {2},{3} title {4} noenhanced font \",14\"\n"
        "set logscale xy\nset grid xtics ytics lc rgb \"#e4e4e4\" lt 1 lw 1\nset border 3 lc rgb \"#606060\"\n"
        "set tics nomirror scale 0.5\nset yrange [{5:g}:{6:g}]\nset ytics ({7})\nset bars 0.4\n"
        "set lmargin 9\nset rmargin 3\nset ylabel \"RMSE / mean of indirect light\" offset 1\n"
        "set xlabel \"{8} time for one picture, seconds\" offset 0,0.4\n",
        560 * columns, 430 * rows + 40, rows, columns, quoted(title), errors.low, errors.high,
        tics(errors.low, errors.high), device_time ? "GPU" : "CPU");
    for (const Marker& marker : markers)
        if (std::ranges::any_of(panels, [&](const Panel& panel) { return panel.has(marker.varied); }))
            panels.front().explain(marker);
    for (const Panel& panel : panels) script += panel.plot();
    return script + "unset multiplot\nunset output\n}\n";
}

void plot_chart(const std::filesystem::path& folder) { run_gnuplot(folder, "chart.gp"); }

}  // namespace farfield
