#include "app/commands.h"

#include "app/headless.h"
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
#include <cmath>

namespace farfield {

bool render_frames(Renderer& renderer, int frames, Progress& progress, const std::function<bool()>& enough) {
    for (int i = 0; i < frames; ++i) {
        do {
            if (Progress::interrupted()) {
                fmt::print(stderr, "\ninterrupted: nothing was written\n");
                return false;
            }
        } while (!renderer.step());
        progress.advance();
        if (enough && enough()) break;
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

namespace {

/// As many frames as options and settings want; false when the user interrupts.
bool accumulate(Renderer& renderer, const RenderOptions& options, float percent) {
    constexpr int usual = 16, most = 1'000'000;
    const bool has_target = percent > 0.0f || options.seconds > 0.0f;
    const int frames = options.frames.value_or(has_target ? most : usual);
    Progress progress("rendering", frames);
    if (!has_target) return render_frames(renderer, frames, progress);
    const auto start = std::chrono::steady_clock::now();
    double noise = 0.0;
    int estimated_at = 0;  // samples
    const auto enough = [&] {
        const int samples = renderer.statistics().samples;
        // The share of the way that is done; noise falls with the root of the samples.
        double share = 0.0;
        if (percent > 0.0f && noise_due(samples, estimated_at)) {
            noise = *renderer.noise();
            estimated_at = samples;
            if (100.0 * noise <= percent) return true;
        }
        if (estimated_at > 0) share = std::pow(0.01 * percent / noise, 2) * samples / estimated_at;
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        if (options.seconds > 0.0f) share = std::max(share, seconds / options.seconds);
        if (share > 0.0)
            progress.expect(static_cast<int>(std::min<double>(frames, std::ceil(progress.done() / share))));
        return options.seconds > 0.0f && seconds >= options.seconds;
    };
    if (!render_frames(renderer, frames, progress, enough)) return false;
    const int samples = renderer.statistics().samples;
    if (estimated_at != samples) noise = *renderer.noise();
    fmt::print(stderr, "error of indirect light about {} after {} samples in {} frames\n", percent_text(noise), samples,
               progress.done());
    return true;
}

}  // namespace

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
    if (!accumulate(renderer, options, headless.scene.settings.noise)) return 1;
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

}  // namespace farfield
