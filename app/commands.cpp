#include "app/commands.h"

#include "app/progress.h"
#include "renderer/picture_file.h"
#include "renderer/renderer.h"
#include "sdf/code_trust.h"
#include "sdf/codegen.h"
#include "sdf/fields.h"
#include "sdf/scene_file.h"
#include "sdf/scene_schema.h"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <numeric>

namespace farfield {
namespace {

/// A scene with the settings of the command line, and a renderer in a context of its own.
struct Headless {
    Headless(Scene of, const Overrides& overrides, ContextKind kind) : scene(std::move(of)) {
        overrides.apply(scene.settings);
        context = make_headless_context(kind);
        context->make_current();
        renderer.emplace();
    }
    Scene scene;
    std::unique_ptr<Context> context;
    std::optional<Renderer> renderer;  ///< goes before its context
};

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

}  // namespace

bool render_frames(Renderer& renderer, int frames, Progress& progress) {
    for (int i = 0; i < frames; ++i) {
        do {
            if (Progress::interrupted()) {
                fmt::print(stderr, "\ninterrupted: nothing was written\n");
                return false;
            }
        } while (!renderer.step());
        progress.advance();
    }
    return true;
}

void check_output(const std::filesystem::path& file, std::initializer_list<std::string_view> extensions) {
    if (std::none_of(extensions.begin(), extensions.end(), [&](auto e) { return extension_of(file) == e; }))
        throw std::invalid_argument(fmt::format("--output: \"{}\" given, expected a name that ends in {}",
                                                file.string(), fmt::join(extensions, " or ")));
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    if (!std::filesystem::is_directory(folder))
        throw ImageError(fmt::format("{}: cannot be written: there is no folder {}", file.string(), folder.string()));
}

std::string option_name(std::string_view key) {
    std::string option = fmt::format("--{}", key);
    std::replace(option.begin(), option.end(), '_', '-');
    return option;
}

void Overrides::apply(Settings& settings) const {
    for (const auto& [key, text] : values) {
        for (const Field<Settings>& field : fields<Settings>()) {
            if (key != field.parameter.key) continue;
            glm::vec3 value{0.0f};
            bool read = false;
            if (field.parameter.type == ParameterType::choice) {
                for (std::size_t i = 0; i < field.parameter.choices.size(); ++i)
                    if (text == field.parameter.choices[i]) value.x = static_cast<float>(i), read = true;
            } else {
                const char* start = text.data() + (text.starts_with('+') && !text.starts_with("+-") ? 1 : 0);
                const char* stop = text.data() + text.size();
                const auto [end, error] = std::from_chars(start, stop, value.x);
                read = error == std::errc() && end == stop && why_refused(field.parameter, value).empty() &&
                       !field.parameter.is_word(value.x);
                if (field.parameter.word && text == field.parameter.word)
                    value.x = field.parameter.lowest(), read = true;
            }
            if (!read)
                throw std::invalid_argument(
                    fmt::format("{}: \"{}\" given, expected {}", option_name(key), text, expectation(field.parameter)));
            field.set(settings, value);
        }
    }
}

Scene load_trusted_scene(const std::filesystem::path& file, bool trust_code) {
    Scene scene = load_scene(file);
    if (trust_code) return scene;
    const std::vector<UnknownCode> unknown = unknown_code(scene, CodeTrust(CodeTrust::user_file()));
    if (unknown.empty()) return scene;
    const std::size_t more = unknown.size() - 1;
    throw SceneFileError(
        file.string(), 0, unknown.front().path,
        fmt::format("holds custom code from elsewhere{}, which is not run unasked: read it, then open the file in the "
                    "editor or give --trust-code",
                    more == 0   ? ""
                    : more == 1 ? " (and one other node)"
                                : fmt::format(" (and {} other nodes)", more)));
}

int run_render(const RenderOptions& options) {
    for (const std::filesystem::path& file : options.outputs) check_output(file, {".exr", ".png"});
    Headless headless(load_trusted_scene(options.scene, options.trust_code), options.overrides, options.context);
    Renderer& renderer = *headless.renderer;
    FrameOptions frame;
    frame.size = options.size;
    frame.view = options.view;
    frame.seed = options.seed;
    frame.measure_bounces = true;
    renderer.update(headless.scene, frame);
    Progress progress("rendering", options.frames);
    if (!render_frames(renderer, options.frames, progress)) return 1;
    for (const std::filesystem::path& file : options.outputs)
        write_picture(read_picture(renderer, options.view, is_linear(file)), file);
    if (headless.scene.settings.bounces == 0 || isatty(STDERR_FILENO))
        fmt::print(stderr, "{}\n", bounces_text(renderer.statistics()));
    return 0;
}

int run_glsl(const GlslOptions& options) {
    fmt::print("{}", generate(load_trusted_scene(options.scene, options.trust_code),
                              options.live ? Tier::live : Tier::specialised)
                         .text);
    return 0;
}

int run_schema() {
    fmt::print("{}", scene_schema());
    return 0;
}

int run_bench(const BenchOptions& options) {
    Headless headless(load_trusted_scene(options.scene, options.trust_code), options.overrides, options.context);
    const Scene& scene = headless.scene;
    Renderer& renderer = *headless.renderer;
    FrameOptions frame;
    frame.size = options.size;
    fmt::print("scene     {}, {} nodes\ndevice    {} ({})\npicture   {} x {}, {} samples per frame, {}\n",
               options.scene.string(), count_nodes(scene), renderer.statistics().device, headless.context->name(),
               options.size.x, options.size.y, scene.settings.samples,
               scene.settings.bounces > 0 ? fmt::format("{} bounces", scene.settings.bounces) : "automatic bounces");

    for (const Tier tier : {Tier::specialised, Tier::live}) {
        if (tier == Tier::live && !options.live) break;
        const char* name = tier == Tier::live ? "live" : "specialised";
        frame.tier = tier;
        frame.counting = false;
        const double compile_start = process_cpu_seconds();
        renderer.update(scene, frame);
        fmt::print("\n{} program: compiled in {:.0f} ms, process CPU time {:.0f} ms\n", name,
                   renderer.statistics().compile_milliseconds, 1e3 * (process_cpu_seconds() - compile_start));
        const gl::Texture picture("display", GL_RGBA8, options.size);
        std::vector<double> cpu, wall, filter;
        std::vector<PassTime> passes;
        for (int i = -1; i < options.frames; ++i) {
            const double cpu_start = process_cpu_seconds();
            const auto wall_start = std::chrono::steady_clock::now();
            renderer.render_frame();
            const double cpu_traced = process_cpu_seconds();
            renderer.display(picture);
            glFinish();
            if (i < 0) continue;  // drivers compile at first use
            cpu.push_back(process_cpu_seconds() - cpu_start);
            filter.push_back(process_cpu_seconds() - cpu_traced);
            wall.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start).count());
            passes = renderer.statistics().passes;
        }
        fmt::print("  frame              {:8.1f} ms   {:.2f} frames/s, process CPU time {:.1f} ms (medians of {})\n",
                   1e3 * median(wall), 1.0 / median(wall), 1e3 * median(cpu), options.frames);
        for (const PassTime& pass : passes) fmt::print("  {:<18} {:8.1f} ms\n", pass.name, pass.milliseconds);
        fmt::print("  filter and display {:8.1f} ms of process CPU time\n", 1e3 * median(filter));
        frame.counting = true;
        renderer.update(scene, frame);
        renderer.render_frame();
        const Statistics& s = renderer.statistics();
        fmt::print("  rays               {:8}      {:.1f} evaluations per ray, {} stopped by the step limit\n", s.rays,
                   static_cast<double>(s.evaluations) / static_cast<double>(std::max<std::uint64_t>(s.rays, 1)),
                   s.exhausted_rays);
    }
    return 0;
}

}  // namespace farfield
