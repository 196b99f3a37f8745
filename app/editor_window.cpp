#include "app/editor_window.h"

#include "app/crash_trace.h"
#include "app/editor.h"
#include "app/measuring.h"
#include "app/window.h"
#include "renderer/context.h"
#include "sdf/scene_file.h"

#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace farfield {
namespace {

constexpr double slow_tick = 0.1;          // seconds between looks at the renderer while nothing happens
constexpr double quick_tick = 1.0 / 60.0;  // and while a hand moves something or pictures come fast
constexpr double shortest_frame = 1.0 / 60.0,
                 shortest_busy_frame = 1.0 / 30.0;  // the latter where pictures need the processor
constexpr double attention = 1.0;                   // after input: tooltips wait for the mouse to rest
constexpr std::size_t timed_frames = 256;           // whose times are remembered
constexpr int settling_frames = 3;                  // ImGui needs a frame or two to lay out what has just appeared

double seconds() {
    using namespace std::chrono;
    return duration<double>(steady_clock::now().time_since_epoch()).count();
}

Theme theme_for(const Window& window) {
    const Theme theme = make_theme(window.density());
    ImGui::GetIO().FontGlobalScale = 1.0f / window.pixels_per_unit().x;
    return theme;
}

class EditorWindow {
public:
    explicit EditorWindow(const EditorOptions& options)
        : window_({state_.size, state_.place, state_.maximised}, "Farfield"),
          render_(window_.make_shared_context()),
          editor_(state_, theme_for(window_), Report(options.report)) {
        if (!options.scene.empty()) editor_.open(options.scene, options.trust_code);
    }

    void run() {
        int redraws = settling_frames;
        double last_input = seconds();
        while (!editor_.quits()) {
            const bool moving = editor_.interacting();
            const bool lively = redraws > 0 || moving || editor_.picture().statistics.frames_per_second > 10.0;
            rest_until(last_frame_ + (moving && on_cpu_ ? shortest_busy_frame : shortest_frame));
            if (window_.wait(lively ? quick_tick : slow_tick)) redraws = settling_frames, last_input = seconds();
            const double start = seconds();
            const bool attentive = seconds() - last_input < attention || moving || ImGui::GetIO().WantTextInput;
            const bool first = editor_.picture().texture == 0;
            const bool pictured = editor_.show(render_.acquire());
            if (first && editor_.picture().texture != 0) {
                redraws = settling_frames;
                times_.clear();  // of the start
            }
            const Document& document = editor_.document();
            const bool measured = measuring_.refresh(document.scene(), document.revision());
            const bool refreshed = editor_.refresh(seconds());
            while (const auto written = render_.written()) editor_.exported(*written);
            const bool drawn = pictured || measured || refreshed || redraws > 0 || attentive;
            if (drawn) {
                last_frame_ = start;
                if (on_cpu_) render_.give_way(true);
                frame();
                if (on_cpu_) render_.give_way(false);
                times_.push_back(1e3 * (seconds() - start));
                if (times_.size() > timed_frames) times_.erase(times_.begin());
            }
            if (redraws > 0) --redraws;
            editor_.write_report(seconds());
        }
        editor_.end();
        remember_state();
    }

private:
    void frame() {
        window_.begin_frame(editor_.keyboard_changes_hands());
        EditorOutput output = editor_.frame({.now = seconds(),
                                             .size = glm::vec2(window_.size()),
                                             .pixels_per_unit = window_.pixels_per_unit(),
                                             .keys = window_.keys(),
                                             .fly = flight(),
                                             .dropped = window_.take_dropped_files(),
                                             .close = window_.take_close(),
                                             .frame_milliseconds = percentile_95()},
                                            measuring_.results());
        if (output.measure == MeasureWish::start)
            measuring_.start(window_.make_shared_context(), editor_.shown(), editor_.picture_size());
        if (output.measure == MeasureWish::stop) measuring_.stop();
        window_.set_title(output.title);
        window_.end_frame();
        if (output.request) render_.submit(*std::move(output.request));
        for (PictureWish& wish : output.pictures) render_.write(std::move(wish));
    }

    /// Keys that fly while the mouse holds the picture.
    glm::vec3 flight() const {
        const auto axis = [&](int forth, int back) {
            return (window_.is_down(forth) ? 1.0f : 0.0f) - (window_.is_down(back) ? 1.0f : 0.0f);
        };
        return {axis('D', 'A'), axis('E', 'Q'), axis('W', 'S')};
    }

    static void rest_until(double time) {
        const std::chrono::duration<double> left(time - seconds());
        if (left.count() > 0.0) std::this_thread::sleep_for(left);
    }

    double percentile_95() const {
        if (times_.empty()) return 0.0;
        std::vector<double> sorted = times_;
        const auto place = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() * 95 / 100);
        std::nth_element(sorted.begin(), place, sorted.end());
        return *place;
    }

    void remember_state() {
        const Window::Frame frame = window_.frame();
        state_.size = frame.size;
        state_.place = frame.place;
        state_.maximised = frame.maximised;
        state_.recent = load_editor_state(editor_state_file()).recent;  // others may have opened more
        save_editor_state(state_, editor_state_file());
    }

    EditorState state_ = load_editor_state(editor_state_file());
    // In order of life: the renderer's context goes before the window it shares with, and so do the editor's textures.
    Window window_;
    RenderThread render_;
    Editor editor_;
    Measuring measuring_;
    const bool on_cpu_ = renders_on_cpu();
    double last_frame_ = 0.0;
    std::vector<double> times_;  ///< milliseconds between two waits for input
};

}  // namespace

int run_editor(const EditorOptions& options) {
#ifndef __SANITIZE_ADDRESS__  // which tells more
    trace_crashes();
#endif
    std::optional<EditorWindow> window;
    try {
        window.emplace(options);
    } catch (const ContextError&) {
        // Without a window nobody sees what is wrong with the scene, and that is the easier thing to mend.
        if (!options.scene.empty()) load_scene(options.scene);
        throw;
    }
    window->run();
    return 0;
}

}  // namespace farfield
