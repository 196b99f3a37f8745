// What does not hang on a scene but on drivers and on time: the GLSL itself, the contexts, memory.
#include "app/window.h"
#include "renderer/gl.h"
#include "renderer/metrics.h"
#include "renderer/trace_program.h"
#include "sdf/history.h"
#include "sdf/scene_file.h"
#include "tests/stability/case.h"
#include "tests/test_support.h"

#include <fmt/format.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <malloc.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <fstream>

namespace farfield::stability {
namespace {

/// Of a kernel by the reference compiler of Khronos, strictly: errors, and one for each extension that it asks for.
std::string problems(const std::string& source) {
    static const bool initialised = glslang::InitializeProcess();
    if (!initialised) return "glslang does not start";
    if (source.find("#extension") != std::string::npos) return "asks for an extension";
    const char* text = source.c_str();
    glslang::TShader shader(gl::stage_of(source) == GL_COMPUTE_SHADER ? EShLangCompute : EShLangFragment);
    shader.setStrings(&text, 1);
    const bool parsed = shader.parse(GetDefaultResources(), 430, ECoreProfile, true, false, EShMsgDefault);
    glslang::TProgram program;
    program.addShader(&shader);
    if (parsed && program.link(EShMsgDefault)) return {};
    return std::string("refused: ") + shader.getInfoLog() + program.getInfoLog();
}

struct Check {
    int refused = 0;
    std::string first;
    void add(const std::string& source) {
        const std::string found = problems(source);
        if (found.empty()) return;
        if (refused++ == 0) first = found.substr(0, found.find('\n'));
    }
    void add(const Scene& scene) {
        for (const Tier tier : {Tier::live, Tier::specialised})
            for (const char* kernel : {"trace.glsl", "surface.glsl", "limit_plain.glsl"})
                for (const bool by_distance : {false, true})
                    add(scene_kernel_source(kernel, generate(scene, tier, 0, by_distance)));
    }
};

std::vector<Point> validated() {
    std::vector<Point> points{{-2.0, "the passes"}, {-1.0, "100 random scenes"}};
    for (const auto& file : bundled_scenes())
        points.emplace_back(static_cast<double>(points.size()) - 2.0, file.stem().string());
    return points;
}

Figures refused_kernels(const Point& point) {
    Check check;
    if (point.value == -2.0) {
        // A scene stands before its own kernels; all others are whole.
        for (const char* pass :
             {"camera.glsl",         "continuation.glsl",     "count.glsl",         "direct.glsl",
              "display.glsl",        "filter_blur.glsl",      "filter_mip.glsl",    "filter_start.glsl",
              "gather.glsl",         "gbuffer.glsl",          "hemisphere.glsl",    "light_rays.glsl",
              "limit_fma.glsl",      "next_light.glsl",       "occlusion.glsl",     "reproject.glsl",
              "synthesis.glsl",      "wavelet_coarsest.glsl", "wavelet_halve.glsl", "wavelet_links.glsl",
              "wavelet_refine.glsl", "wavelet_smooth.glsl",   "wavelet_start.glsl"})
            check.add(shader_source(pass));
        for (const char* more : {"#define more_follows 0\n", "#define more_follows 1\n"})
            check.add(shader_source("bounce.glsl", more));
        for (const char* detail : {"#define leaves_detail 0\n", "#define leaves_detail 1\n"})
            check.add(shader_source("wavelet_shrink.glsl", detail));
    } else if (point.value == -1.0) {
        for (unsigned seed = 0; seed < 100; ++seed) check.add(random_scene(seed, 30));
    } else {
        check.add(load_scene(bundled_scenes()[static_cast<std::size_t>(point.value)]));
    }
    return shared(check.refused, check.first);
}

std::vector<Point> scene_points() {
    std::vector<Point> points;
    for (const auto& file : bundled_scenes())
        points.emplace_back(static_cast<double>(points.size()), file.stem().string());
    return points;
}

/// RMSE / mean between EGL and OSMesa, or EGL and a context of the editor's window where there is a display.
Figures contexts_differ(Stage& stage, const Point& point) {
    const Scene scene = load_scene(bundled_scenes()[static_cast<std::size_t>(point.value)]);
    const auto rendered = [&](std::unique_ptr<Context> context) {
        return Stage(std::move(context)).render(scene, {.size = {48, 48}}, 2);
    };
    const Pictures egl = rendered(make_headless_context(ContextKind::egl));
    std::vector<Pictures> others{rendered(make_headless_context(ContextKind::osmesa))};
    std::string note;
    try {
        Window window(Window::Frame(), "Farfield");
        others.push_back(rendered(window.make_shared_context()));
    } catch (const ContextError& error) {
        note = fmt::format("no window: {}", error.what());
    }
    stage.make_current();
    Figures figures;
    for (const Method m : methods) {
        const std::size_t i = static_cast<std::size_t>(m);
        for (const Pictures& other : others)
            figures[m] = std::max(figures[m].value_or(0.0), measure(egl.result[i], other.result[i]).rmse_over_mean);
    }
    figures.note = note;
    return figures;
}

/// Of this process, resident, MB.
double memory() {
    malloc_trim(0);
    std::ifstream file("/proc/self/statm");
    double whole = 0.0, resident = 0.0;
    file >> whole >> resident;
    return resident * 4096.0 / 1e6;
}

/// Random edits, rendered after each, undone now and then: how much the memory grows from the first half to the
/// second, when the cache of programs has been filled.
Figures soak(Stage& stage, double minutes) {
    std::mt19937 random(1);
    constexpr std::size_t steps_kept = 200;
    constexpr int warm = 600;  // programs: the renderer keeps 512
    const auto now = [] { return std::chrono::steady_clock::now(); };
    const auto start = now();
    auto warmed = start;
    double early = 0.0;
    std::array<double, 4> late{};  // the most in each quarter of the time
    int edits = 0, refused = 0, invalid = 0;
    std::optional<History> history;
    Renderer& renderer = stage.renderer();
    const auto compiled = [&] {
        return renderer.statistics().structural_compiles + renderer.statistics().specialisations;
    };
    const int first = compiled();
    const auto passed = [&] { return std::chrono::duration<double>(now() - warmed).count() / (60.0 * minutes); };
    while (early == 0.0 || passed() < 1.0) {
        if (!history || history->size() > steps_kept)
            history.emplace(random_scene(static_cast<unsigned>(random() % 50), 6));
        try {
            if (random() % 8 == 0 && history->can_undo())
                history->undo();
            else
                history->apply(random_edit(history->scene(), random));
            const FrameOptions options{.size = {16, 16}, .tier = random() % 4 ? Tier::live : Tier::specialised};
            renderer.update(history->scene(), options);
            renderer.render_frame();
            invalid += count_invalid(renderer.read(View::result)) > 0;
        } catch (const EditError&) {
            ++refused;
        } catch (const ShaderError&) {
            ++refused;
        }
        ++edits;
        if (early > 0.0) {
            double& most = late[std::min(static_cast<std::size_t>(4.0 * passed()), std::size_t{3})];
            most = std::max(most, memory());
        } else if (compiled() - first >= warm) {
            early = memory(), warmed = now();
        }
    }
    // A leak goes on; caches that fill come to an end.
    const double growth = std::max(late[2], late[3]) / std::max(late[0], late[1]) - 1.0;
    return shared(invalid > 0 ? NAN : std::max(growth, 0.0),
                  fmt::format("{} edits, {} of them refused, {} programs compiled, {} pictures not finite; {:.0f} MB "
                              "after 600 programs, at most {:.0f}, {:.0f}, {:.0f} and {:.0f} MB in "
                              "the quarters of the time after it",
                              edits, refused, compiled() - first, invalid, early, late[0], late[1], late[2], late[3]));
}

}  // namespace

std::vector<Case> driver_cases(double soak_minutes) {
    return {{"glsl-strict", "drivers: code that only some compilers take", "scene", validated(),
             "kernels that glslang refuses as strict core 4.3 without extensions",
             [](Stage&, const Point& p) { return refused_kernels(p); }, at_most(0.0)},
            {"contexts", "drivers: EGL, OSMesa and window", "scene", scene_points(),
             "RMSE / mean between EGL and the others", contexts_differ, at_most(1e-3)},
            {"soak",
             "hours of edits: memory",
             "minutes of random edits",
             {soak_minutes},
             "growth of memory, second half of the time over the first",
             [](Stage& s, const Point& p) { return soak(s, p.value); },
             at_most(0.1)}};
}

}  // namespace farfield::stability
