#include "ui/measure_panel.h"

#include "renderer/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace farfield {
namespace {

/// Names of the front's points, from the fastest to the most accurate.
constexpr std::array<const char*, 4> presets{"Draft", "Interactive", "Balanced", "Final"};

struct MethodInfo {
    const char* label;
    ImU32 color;
};

/// The colours of `farfield chart`, for a dark ground.
MethodInfo method_info(Method method) {
    switch (method) {
        case Method::paper:
            return {"paper", IM_COL32(226, 110, 50, 255)};
        case Method::farfield:
            return {"farfield", IM_COL32(82, 156, 232, 255)};
        default:
            return {"reference (no filter)", IM_COL32(170, 176, 186, 255)};
    }
}

std::string seconds_text(double s) {
    if (s >= 1.0) return fmt::format("{:.3g} s", s);
    return s >= 1e-3 ? fmt::format("{:.3g} ms", 1e3 * s) : fmt::format("{:.3g} µs", 1e6 * s);
}

/// One axis with a logarithmic scale, from the first to the last decade that holds a value, at most a few.
struct LogAxis {
    double low = 0.0, high = 1.0;  ///< base-10 logarithms
    float from = 0.0f, to = 1.0f;  ///< where those are on the screen

    void hold(double least, double most) {
        low = std::log10(least) - 0.12, high = std::log10(most) + 0.12;
        if (high - low < 0.6) low -= 0.3, high += 0.3;
    }
    float at(double value) const {
        const double x = (std::log10(std::max(value, 1e-12)) - low) / (high - low);
        return from + static_cast<float>(glm::clamp(x, 0.0, 1.0)) * (to - from);
    }
    /// Calls mark(value, labelled) for 1, 2 and 5 of each decade.
    template <class Mark>
    void ticks(Mark mark) const {
        for (int decade = static_cast<int>(std::floor(low)); decade <= static_cast<int>(std::ceil(high)); ++decade)
            for (const double digit : {1.0, 2.0, 5.0}) {
                const double value = digit * std::pow(10.0, decade), log = std::log10(value);
                if (log >= low && log <= high) mark(value, digit == 1.0 || high - low < 2.5);
            }
    }
};

bool can_be_drawn(const ChartPoint& p) {
    return std::isfinite(p.seconds) && std::isfinite(p.error) && p.seconds > 0.0 && p.error > 0.0;
}

float most_samples(const Scene& scene) {
    for (const Parameter& parameter : parameters(scene, {ObjectType::settings, 0}))
        if (parameter.key == std::string_view("samples")) return parameter.maximum;
    return 1.0f;
}

/// The settings of a point, for the first picture as far as so many rays fit into a frame.
Edits settings_of(const Scene& scene, const ChartPoint& point) {
    const ObjectRef settings{ObjectType::settings, 0};
    const Setting& s = point.setting;
    Edits edits;
    const auto set = [&](const char* key, float v) {
        if (value(scene, settings, key).x != v) edits.push_back(SetValue{settings, key, {v, 0.0f, 0.0f}});
    };
    set("method", static_cast<float>(s.method));
    set("samples", std::min(static_cast<float>(s.samples), most_samples(scene)));
    set("bounces", static_cast<float>(s.bounces));
    if (s.method == Method::reference) return edits;
    set("blur_levels", static_cast<float>(s.blur_levels));
    set("ao_radius", s.ao_radius);
    return edits;
}

std::string description(const ChartPoint& p) {
    const Setting& s = p.setting;
    std::string text = fmt::format("{}, {} samples", method_info(s.method).label, s.samples);
    if (s.method != Method::reference)
        text += fmt::format(", {} blur {}, AO radius {:.3g} m", s.blur_levels, s.blur_levels == 1 ? "level" : "levels",
                            s.ao_radius);
    return text + fmt::format("\nerror {}, bias {}{}, FLIP {:.3f}\n{} for a picture", percent_text(p.error),
                              p.bias > 0.0 ? "+" : "", percent_text(p.bias), p.flip, seconds_text(p.seconds));
}

/// The front without the few unfiltered samples that it often begins with: fast, and nothing to look at.
std::span<const ChartPoint> useful(std::span<const ChartPoint> front) {
    const auto raw = [](const ChartPoint& p) { return p.setting.method == Method::reference; };
    while (front.size() > 1 && raw(front.front())) front = front.subspan(1);
    return front;
}

/// The point of the front nearest to this fraction of the way from its fastest to its slowest, in the logarithm.
const ChartPoint* preset_point(std::span<const ChartPoint> front, float fraction) {
    const double first = std::log(front.front().seconds), last = std::log(front.back().seconds);
    const double wanted = first + fraction * (last - first);
    return &*std::min_element(front.begin(), front.end(), [&](const ChartPoint& a, const ChartPoint& b) {
        return std::abs(std::log(a.seconds) - wanted) < std::abs(std::log(b.seconds) - wanted);
    });
}

bool is_current(const Scene& scene, const ChartPoint& p) { return settings_of(scene, p).empty(); }

void centred_text(ImDrawList& draw, ImVec2 at, float width, ImU32 color, const std::string& text) {
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    draw.AddText({at.x + 0.5f * (width - size.x), at.y}, color, text.c_str());
}

void dashed_line(ImDrawList& draw, float x0, float x1, float y, float dash, ImU32 color) {
    for (float x = x0; x < x1; x += 2.0f * dash) draw.AddLine({x, y}, {std::min(x + dash, x1), y}, color);
}

/// The plot; the point that was clicked.
const ChartPoint* plot(Ui& ui, const Scene& scene, const MeasureResults& results, ImVec2 size) {
    const Theme& theme = ui.theme;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::InvisibleButton("plot", size);
    ui.report.item("measure", "plot");
    const bool hovered = ImGui::IsItemHovered(), clicked = ImGui::IsItemClicked();
    ImGui::PushFont(theme.small_font);
    const float line = ImGui::GetFontSize();
    const ImVec2 low{corner.x + theme.px(54.0f), corner.y + line + theme.px(6.0f)};
    const ImVec2 high{corner.x + size.x - theme.px(8.0f), corner.y + size.y - 2.0f * line - theme.px(10.0f)};
    draw.AddRectFilled(low, high, IM_COL32(18, 20, 24, 255));

    double least_time = 1e30, most_time = 0.0, least_error = 1e30, most_error = 0.0;
    for (const ChartPoint& p : results.points) {
        if (!can_be_drawn(p)) continue;
        least_time = std::min(least_time, p.seconds), most_time = std::max(most_time, p.seconds);
        least_error = std::min(least_error, p.error), most_error = std::max(most_error, p.error);
    }
    LogAxis x, y;
    x.hold(least_time, most_time), y.hold(least_error, most_error);
    x.from = low.x, x.to = high.x, y.from = high.y, y.to = low.y;
    const ImU32 grid = IM_COL32(44, 48, 56, 255);
    x.ticks([&](double v, bool labelled) {
        draw.AddLine({x.at(v), low.y}, {x.at(v), high.y}, grid);
        if (labelled) centred_text(draw, {x.at(v), high.y + theme.px(3.0f)}, 0.0f, theme.dim, seconds_text(v));
    });
    y.ticks([&](double v, bool labelled) {
        draw.AddLine({low.x, y.at(v)}, {high.x, y.at(v)}, grid);
        const std::string text = percent_text(v);
        if (labelled)
            draw.AddText({low.x - theme.px(5.0f) - ImGui::CalcTextSize(text.c_str()).x, y.at(v) - 0.5f * line},
                         theme.dim, text.c_str());
    });
    draw.AddText({corner.x, corner.y}, theme.dim, "Error of indirect light (RMSE / mean)");
    centred_text(draw, {low.x, high.y + line + theme.px(5.0f)}, high.x - low.x, theme.dim,
                 fmt::format("{} time for a picture of {} x {} pixels", results.device_time ? "GPU" : "CPU",
                             results.size.x, results.size.y));

    const ChartPoint* under = nullptr;
    float nearest = theme.px(12.0f);
    const ImVec2 mouse = ImGui::GetMousePos();
    for (const ChartPoint& p : results.points) {
        if (!can_be_drawn(p)) continue;
        const float away = std::hypot(x.at(p.seconds) - mouse.x, y.at(p.error) - mouse.y);
        if (hovered && away < nearest) nearest = away, under = &p;
    }
    if (const double noise = results.points.empty() ? 0.0 : results.points[0].noise; noise > 0.0) {
        dashed_line(draw, low.x, high.x, y.at(noise), theme.px(5.0f), theme.dim);
        draw.AddText({low.x + theme.px(4.0f), y.at(noise) - line - theme.px(1.0f)}, theme.dim, "reference's own noise");
    }
    for (std::size_t i = 1; i < results.front.size(); ++i)
        draw.AddLine({x.at(results.front[i - 1].seconds), y.at(results.front[i - 1].error)},
                     {x.at(results.front[i].seconds), y.at(results.front[i].error)}, IM_COL32(255, 255, 255, 70),
                     theme.px(4.0f));
    for (const Method method : {Method::paper, Method::farfield, Method::reference}) {
        const ChartPoint* last = nullptr;
        for (const ChartPoint& p : results.points) {
            if (p.setting.method != method || p.varied != Varied::none || !can_be_drawn(p)) continue;
            if (last)
                draw.AddLine({x.at(last->seconds), y.at(last->error)}, {x.at(p.seconds), y.at(p.error)},
                             method_info(method).color, theme.px(1.5f));
            last = &p;
        }
    }
    int index = 0;
    for (const ChartPoint& p : results.points) {
        if (!can_be_drawn(p)) continue;
        const ImVec2 at{x.at(p.seconds), y.at(p.error)};
        const float radius = theme.px(p.varied == Varied::none ? 4.0f : 2.5f) + (&p == under ? theme.px(2.0f) : 0.0f);
        draw.AddCircleFilled(at, radius, method_info(p.setting.method).color);
        if (is_current(scene, p)) draw.AddCircle(at, radius + theme.px(3.0f), theme.text, 0, theme.px(1.5f));
        if (p.varied == Varied::none)
            ui.report.rectangle("measure", fmt::format("point/{}", index++), {at.x - radius, at.y - radius},
                                {at.x + radius, at.y + radius});
    }
    float left = high.x;
    for (const Method method : {Method::reference, Method::farfield, Method::paper}) {
        const MethodInfo info = method_info(method);
        left -= ImGui::CalcTextSize(info.label).x + theme.px(8.0f);
        draw.AddText({left, corner.y}, theme.text, info.label);
        left -= theme.px(8.0f);
        draw.AddCircleFilled({left, corner.y + 0.5f * line}, theme.px(4.0f), info.color);
        left -= theme.px(8.0f);
    }
    ImGui::PopFont();
    if (under) ImGui::SetTooltip("%s\nClick to use these settings", description(*under).c_str());
    return clicked ? under : nullptr;
}

void introduction(const Ui& ui) {
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextUnformatted(
        "Which settings are worth their time for this view? Farfield renders a small picture of it with every method "
        "and several numbers of samples, blur levels and AO radii, and compares each with a reference.");
    ImGui::PushStyleColor(ImGuiCol_Text, ui.theme.dim);
    ImGui::TextUnformatted(
        "The picture rests meanwhile. References are kept: the same view is measured sooner the next time.");
    ImGui::PopStyleColor();
    ImGui::PopTextWrapPos();
}

}  // namespace

Edits measure_panel(Ui& ui, const Scene& scene, const MeasureResults& results, MeasureWish& wish) {
    Edits edits;
    if (!ui.show_measure) return edits;
    const Theme& theme = ui.theme;
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const ImVec2 size{theme.px(560.0f), theme.px(430.0f)};
    ImGui::SetNextWindowSize(size, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowPos({0.5f * (screen.x - size.x), 0.5f * (screen.y - size.y)}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSizeConstraints({theme.px(420.0f), theme.px(300.0f)}, screen);
    if (ImGui::Begin("Speed and accuracy", &ui.show_measure,
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoCollapse)) {
        const char* label = results.running ? "Stop" : results.points.empty() ? "Measure" : "Measure again";
        if (ImGui::Button(label)) wish = results.running ? MeasureWish::stop : MeasureWish::start;
        ui.report.item("measure", "run");
        ImGui::SameLine();
        if (results.running) {
            ImGui::PushStyleColor(ImGuiCol_PlotHistogram, IM_COL32(150, 103, 50, 255));
            ImGui::ProgressBar(results.progress, {-FLT_MIN, 0.0f}, results.doing.c_str());
            ImGui::PopStyleColor();
        } else {
            ImGui::AlignTextToFramePadding();
            ImGui::PushStyleColor(ImGuiCol_Text, results.problem.empty() ? theme.dim : theme.error);
            const std::string note = !results.problem.empty() ? results.problem
                                     : results.points.empty() ? ""
                                     : results.stale          ? "Measured before the view was changed"
                                                              : "Click a point to use its settings";
            ImGui::TextWrapped("%s", note.c_str());
            ImGui::PopStyleColor();
        }
        const float buttons = ImGui::GetFrameHeightWithSpacing();
        const ImVec2 room = ImGui::GetContentRegionAvail();
        if (std::none_of(results.points.begin(), results.points.end(), can_be_drawn)) {
            introduction(ui);
        } else if (const ChartPoint* chosen =
                       plot(ui, scene, results, {room.x, std::max(room.y - buttons, theme.px(120.0f))})) {
            edits = settings_of(scene, *chosen);
        }
        if (!results.running && !results.front.empty()) {
            const float gap = ImGui::GetStyle().ItemSpacing.x;
            const float width = (room.x - gap * (presets.size() - 1)) / presets.size();
            for (std::size_t i = 0; i < presets.size(); ++i) {
                if (i > 0) ImGui::SameLine();
                const ChartPoint* point =
                    preset_point(useful(results.front), static_cast<float>(i) / (presets.size() - 1));
                const bool current = is_current(scene, *point);
                if (current) ImGui::PushStyleColor(ImGuiCol_Text, theme.accent);
                if (ImGui::Button(presets[i], {width, 0.0f})) edits = settings_of(scene, *point);
                if (current) ImGui::PopStyleColor();
                ui.report.item("measure", presets[i]);
                tooltip(ui, description(*point));
            }
        }
    }
    ImGui::End();
    return edits;
}

}  // namespace farfield
