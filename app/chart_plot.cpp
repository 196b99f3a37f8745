#include "app/chart_plot.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace farfield {
namespace {

struct Style {
    Method method;
    const char* name;
    const char* colour;
};
// Told apart by people who see no red or green (Okabe and Ito 2008).
constexpr Style styles[] = {{Method::paper, "paper", "#d55e00"},
                            {Method::reference, "reference", "#808080"},
                            {Method::farfield, "farfield", "#0072b2"}};

struct Marker {
    Varied varied;
    const char* label;
    int point_type;
};
constexpr Marker markers[] = {{Varied::blur_levels, "other blur levels", 1},
                              {Varied::ao_radius, "other AO radii", 2},
                              {Varied::scale, "smaller picture", 8},
                              {Varied::minimum_step, "longer minimum step", 4}};

struct Panel {
    std::string title;
    std::vector<ChartPoint> points;
};

std::vector<Panel> panels(const std::vector<ChartScene>& scenes) {
    std::vector<Panel> all;
    std::vector<std::vector<Measurement>> measurements;
    for (const ChartScene& scene : scenes) {
        measurements.push_back(scene.measurements);
        all.push_back({scene.name, chart_points(scene.measurements)});
        // With other bounces the reference is another one.
        std::erase_if(all.back().points, [](const ChartPoint& p) { return p.varied == Varied::bounces; });
    }
    if (scenes.size() > 1)
        all.insert(all.begin(), {fmt::format("geometric mean of {} scenes", scenes.size()), mean_points(measurements)});
    return all;
}

/// 1, 2 and 5 times every power of ten within the range.
std::string tics(double low, double high) {
    std::string text;
    for (int e = static_cast<int>(std::floor(std::log10(low))); std::pow(10.0, e) <= high; ++e)
        for (const double m : {1.0, 2.0, 5.0})
            if (const double v = m * std::pow(10.0, e); v >= low && v <= high)
                text += fmt::format("{}\"{:g}\" {:g}", text.empty() ? "" : ", ", v, v);
    return text;
}

/// A data block `name` with a line for each point that a logarithmic axis can show; the file's missing value for none.
std::string block(const std::string& name, const std::vector<ChartPoint>& points) {
    std::string text = fmt::format("${} << END\n", name);
    for (const ChartPoint& p : points)
        if (p.error > 0.0)
            text += fmt::format("{:g} {:g} {:g} {:g} {}\n", p.seconds, p.error, std::max(p.low, 0.1 * p.error), p.high,
                                p.setting.samples);
    if (text.ends_with("END\n")) text += "NaN NaN NaN NaN 0\n";
    return text + "END\n";
}

}  // namespace

std::string chart_script(const std::vector<ChartScene>& scenes, const std::string& title) {
    const std::vector<Panel> all = panels(scenes);
    const int columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(all.size()))));
    const int rows = (static_cast<int>(all.size()) + columns - 1) / columns;
    double low = 1e30, high = 0.0;
    bool device_time = false;
    for (const ChartScene& scene : scenes)
        for (const Measurement& m : scene.measurements) device_time = device_time || m.device_time;
    for (const Panel& panel : all)
        for (const ChartPoint& p : panel.points) {
            for (const double e : {p.error, p.noise})
                if (e > 0.0) low = std::min(low, e);
            high = std::max(high, p.high);
        }
    if (!(low < high)) low = 0.5 * high, high = 2.0 * std::max(high, 1e-6);
    low *= 0.8, high *= 1.25;

    std::string script = fmt::format(
        "# {}\n# Run with gnuplot in this folder: makes chart.svg and chart.png.\nset encoding utf8\n", title);
    for (std::size_t i = 0; i < all.size(); ++i) {
        for (const Style& style : styles)
            script += block(fmt::format("{}{}", style.name, i), curve(all[i].points, style.method));
        for (const Marker& marker : markers)
            for (const Style& style : styles) {
                std::vector<ChartPoint> some;
                for (const ChartPoint& p : all[i].points)
                    if (p.varied == marker.varied && p.setting.method == style.method) some.push_back(p);
                script +=
                    block(fmt::format("{}_{}{}", varied_keys[static_cast<int>(marker.varied)], style.name, i), some);
            }
        script += block(fmt::format("front{}", i), pareto_front(all[i].points));
    }
    script += fmt::format(
        "do for [type in \"svg png\"] {{\n"
        "if (type eq \"svg\") {{ set terminal svg size {0},{1} font \"Inter,13\" background \"white\" dynamic; }}\n"
        "else {{ set terminal pngcairo size {0},{1} font \"Inter,10\" background \"white\"; }}\n"
        "set output \"chart.\".type\n"
        "set multiplot layout {2},{3} title \"{4}\" font \",14\"\n"
        "set logscale xy\nset grid xtics ytics lc rgb \"#e4e4e4\" lt 1 lw 1\nset border 3 lc rgb \"#606060\"\n"
        "set tics nomirror scale 0.5\nset yrange [{5:g}:{6:g}]\nset ytics ({7})\nset bars 0.4\n"
        "set lmargin 9\nset rmargin 3\nset ylabel \"RMSE / mean of indirect light\" offset 1\n"
        "set xlabel \"{8} for one picture, s\" offset 0,0.4\nset format x \"%g\"\nset xtics autofreq\n",
        560 * columns, 430 * rows + 40, rows, columns, title, low, high, tics(low, high),
        device_time ? "GPU time" : "CPU time");
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Panel& panel = all[i];
        double first = 1e30, last = 0.0, noise = 0.0;
        for (const ChartPoint& p : panel.points) {
            first = std::min(first, p.seconds);
            last = std::max(last, p.seconds);
            if (p.varied == Varied::none) noise = std::max(noise, p.noise);
        }
        if (!(first < last)) first = 0.5 * std::max(last, 1e-6), last = 2.0 * std::max(last, 1e-6);
        first *= 0.6, last *= 1.9;
        script += fmt::format(
            "set title \"{}\" font \",12\" offset 0,-0.6\nset xrange [{:g}:{:g}]\nset xtics ({})\n{}\nplot \\\n",
            panel.title, first, last, tics(first, last),
            i == 0 ? "set key bottom left opaque samplen 2 spacing 1.0 font \",9\" Left reverse" : "unset key");
        if (noise > 0.0)
            script += fmt::format(
                "  {:g} with lines lc rgb \"#a0a0a0\" dt 2 lw 1 title \"noise of the reference itself\", \\\n", noise);
        script +=
            fmt::format("  $front{} using 1:2 with steps lc rgb \"#f2d27a\" lw 4 title \"Pareto front\", \\\n", i);
        for (const Marker& marker : markers)
            for (const Style& style : styles)
                script += fmt::format(
                    "  ${}_{}{} using 1:2 with points pt {} ps 0.6 lc rgb \"{}\" {}, \\\n",
                    varied_keys[static_cast<int>(marker.varied)], style.name, i, marker.point_type, style.colour,
                    style.method == Method::farfield ? fmt::format("title \"{}\"", marker.label) : "notitle");
        for (const Style& style : styles)
            script += fmt::format(
                "  ${0}{1} using 1:2:3:4 with yerrorbars lc rgb \"{2}\" pt 7 ps 0.1 notitle, \\\n"
                "  ${0}{1} using 1:2 with linespoints lc rgb \"{2}\" lw 2 pt 7 ps 0.8 title \"{0}\", \\\n",
                style.name, i, style.colour);
        script += fmt::format(
            "  $farfield{0} using 1:2:5 with labels offset 0.6,0.9 font \",8\" tc rgb \"#0072b2\" notitle\n", i);
    }
    return script + "unset multiplot\nunset output\n}\n";
}

namespace {

std::string cell(double error) { return error > 0.0 ? fmt::format("{:.3f}", error) : "below the noise"; }

std::string header(const std::string& first, const std::vector<std::string>& columns) {
    std::string text = "| " + first + " |", rule = "|---|";
    for (const std::string& column : columns) text += " " + column + " |", rule += "---|";
    return text + "\n" + rule + "\n";
}

std::string equal_samples(const std::vector<Panel>& all) {
    std::vector<std::string> columns{"method"};
    const std::vector<ChartPoint> counts = curve(all.front().points, Method::farfield);
    for (const ChartPoint& p : counts) columns.push_back(fmt::format("{} samples", p.setting.samples));
    std::string text =
        "## Equal samples\n\nRMSE / mean of indirect light (mean bias; FLIP of the picture), by samples per "
        "pixel.\n\n" +
        header("scene", columns);
    for (const Panel& panel : all)
        for (const Style& style : styles) {
            text += fmt::format("| {} | {} |", panel.title, style.name);
            for (const ChartPoint& p : curve(panel.points, style.method))
                text += fmt::format(" {} ({:+.1f} %; {:.3f}) |", cell(p.error), 100.0 * p.bias, p.flip);
            text += "\n";
        }
    return text;
}

std::string equal_time(const std::vector<Panel>& all) {
    std::string text =
        "\n## Equal time\n\nRMSE / mean after the time that `farfield` takes for so many samples; interpolated between "
        "numbers of samples, linear in logarithms. A dash: the method has no picture that soon, or was not measured "
        "that "
        "long.\n\n" +
        header("scene", {"samples of farfield", "seconds", "farfield", "paper", "reference", "farfield / paper"});
    for (const Panel& panel : all) {
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

std::string equal_error(const std::vector<Panel>& all) {
    constexpr double errors[] = {0.5, 0.3, 0.2, 0.1, 0.05};
    std::vector<std::string> columns{"method"};
    for (const double error : errors) columns.push_back(fmt::format("{}", error));
    std::string text = "\n## Equal error\n\nSeconds until RMSE / mean is at most so much; a dash: not reached.\n\n" +
                       header("scene", columns);
    for (const Panel& panel : all)
        for (const Style& style : styles) {
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
        const std::string name = fmt::format("| {} | {} |", value_of(row),
                                             styles[0].method == row.setting.method   ? "paper"
                                             : styles[1].method == row.setting.method ? "reference"
                                                                                      : "farfield");
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
    const std::vector<Panel> all = panels(scenes);
    std::string text = fmt::format(
                           "# {}\n\nMedians over the seeds; the reference's own noise is subtracted. Made by "
                           "`farfield chart` from chart.csv.\n\n",
                           title) +
                       equal_samples(all) + equal_time(all) + equal_error(all);
    for (const ChartScene& scene : scenes) text += each_setting(scene);
    return text;
}

void plot_chart(const std::filesystem::path& folder) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    std::string program = "gnuplot", script = "chart.gp";
    char* arguments[] = {program.data(), script.data(), nullptr};
    pid_t process = 0;
    const int error = posix_spawnp(&process, program.c_str(), &actions, nullptr, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    int status = 0;
    if (error == 0 && waitpid(process, &status, 0) == process && WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
    if (error == ENOENT || (error == 0 && WIFEXITED(status) && WEXITSTATUS(status) == 127))
        throw std::runtime_error(fmt::format(
            "gnuplot, which draws the chart, is not installed (apt-get install gnuplot-nox); {} has the numbers, and "
            "\"gnuplot chart.gp\" there draws them later",
            folder.string()));
    throw std::runtime_error(fmt::format("gnuplot failed on {}", (folder / "chart.gp").string()));
}

}  // namespace farfield
