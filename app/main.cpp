// The command line: `farfield [SCENE]` opens the editor, the subcommands work without a window.
#include "app/bench.h"
#include "app/chart.h"
#include "app/chart_table.h"
#include "app/check.h"
#include "app/commands.h"
#include "app/compare.h"
#include "app/contact_sheet.h"
#include "app/editor_window.h"
#include "renderer/gl.h"
#include "renderer/image.h"
#include "sdf/fields.h"
#include "sdf/scene_file.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <iostream>

namespace farfield {
namespace {

[[noreturn]] void refuse(const std::string& option, const std::string& found, const std::string& expected) {
    throw CLI::ValidationError(option, fmt::format("\"{}\" given, expected {}", found, expected));
}

/// All of the text as a number, with a sign or without.
template <class T>
bool read_number(std::string_view text, T& value) {
    if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

/// "768x512" to a size; throws CLI::ValidationError.
glm::ivec2 parse_size(std::string_view text) {
    constexpr int longest = 16384;
    // One for each pixel of an 8K screen: 6 GB of accumulators, and no buffer beyond what 31 bits can address.
    constexpr std::int64_t most = 8192 * 4096;
    glm::ivec2 size{0};
    const std::size_t cross = text.find('x');
    const bool read = cross != std::string_view::npos && read_number(text.substr(0, cross), size.x) &&
                      read_number(text.substr(cross + 1), size.y);
    if (!read || size.x < 1 || size.y < 1 || size.x > longest || size.y > longest)
        refuse("--size", std::string(text), fmt::format("WIDTHxHEIGHT, each between 1 and {}", longest));
    if (static_cast<std::int64_t>(size.x) * size.y > most)
        refuse("--size", std::string(text), fmt::format("at most {} pixels, as 8192x4096", most));
    return size;
}

/// An option for a whole number.
template <class T, class To>
void add_whole(CLI::App& command, const std::string& option, To& to, T low, T high, const std::string& help) {
    const auto read = [=, &to](const std::string& text) {
        T value = 0;
        if (!read_number(text, value) || value < low || value > high)
            refuse(option, text, fmt::format("a whole number between {} and {}", low, high));
        to = value;
    };
    command.add_option_function<std::string>(option, read, help)->type_name("NUMBER");
}

/// An option for a real number.
void add_number(CLI::App& command, const std::string& option, float& to, float low, float high,
                const std::string& help) {
    const auto read = [=, &to](const std::string& text) {
        float value = 0.0f;
        if (!read_number(text, value) || !(value >= low && value <= high))
            refuse(option, text, fmt::format("a number between {} and {}", low, high));
        to = value;
    };
    command.add_option_function<std::string>(option, read, help)->type_name("NUMBER");
}

/// An option for whole numbers with commas between them; sorted, each once.
void add_whole_list(CLI::App& command, const std::string& option, std::vector<int>& to, int low, int high,
                    const std::string& help) {
    const auto read = [=, &to](const std::string& text) {
        std::vector<int> values;
        for (const std::string& item : CLI::detail::split(text, ',')) {
            int value = 0;
            if (!read_number(item, value) || value < low || value > high)
                refuse(option, text,
                       fmt::format("whole numbers between {} and {} with commas between them", low, high));
            values.push_back(value);
        }
        std::sort(values.begin(), values.end());
        values.erase(std::unique(values.begin(), values.end()), values.end());
        to = values;
    };
    command.add_option_function<std::string>(option, read, help)->type_name("N,N,...");
}

constexpr std::pair<const char*, ContextKind> contexts[] = {
    {"auto", ContextKind::automatic}, {"egl", ContextKind::egl}, {"osmesa", ContextKind::osmesa}};

/// Options of every command that renders.
void add_device(CLI::App& command, const char* pixels, glm::ivec2& size, ContextKind& context) {
    command
        .add_option_function<std::string>(
            "--size", [&](const std::string& text) { size = parse_size(text); },
            fmt::format("{}, default {}x{}", pixels, size.x, size.y))
        ->type_name("WxH");
    command
        .add_option_function<std::string>(
            "--context",
            [&](const std::string& text) {
                for (const auto& [name, kind] : contexts)
                    if (text == name) return void(context = kind);
                refuse("--context", text, "auto, egl or osmesa");
            },
            "Where OpenGL comes from, default auto")
        ->type_name("auto|egl|osmesa");
}

/// The same for commands that render a scene. One option for each setting comes from the settings table.
void add_common(CLI::App& command, glm::ivec2& size, ContextKind& context, Overrides& overrides) {
    add_device(command, "Pixels", size, context);
    for (const Field<Settings>& field : fields<Settings>()) {
        const Parameter& p = field.parameter;
        command
            .add_option_function<std::string>(
                option_name(p.key),
                [&overrides, key = p.key](const std::string& text) { overrides.values.emplace_back(key, text); },
                fmt::format("{} (default: the scene's)", p.tip))
            ->type_name(!p.choices.empty() ? fmt::format("{}", fmt::join(p.choices, "|"))
                        : p.word           ? fmt::format("NUMBER|{}", p.word)
                                           : "NUMBER");
    }
}

/// Leaves of the plan what is named.
void choose_varied(SweepPlan& plan, const std::string& text) {
    std::vector<std::string> names = CLI::detail::split(text, ',');
    if (text == "none") names.clear();
    const std::string known = fmt::format("{}", fmt::join(varied_keys + 1, std::end(varied_keys), ", "));
    for (const std::string& name : names)
        if (std::find(varied_keys + 1, std::end(varied_keys), name) == std::end(varied_keys))
            refuse("--vary", text, fmt::format("none, or some of {} with commas between them", known));
    const auto drop_unless = [&](const char* name, auto& values) {
        if (std::find(names.begin(), names.end(), name) == names.end()) values.clear();
    };
    drop_unless("blur_levels", plan.blur_levels);
    drop_unless("ao_radius", plan.ao_factors);
    drop_unless("bounces", plan.bounces);
    drop_unless("scale", plan.scales);
    drop_unless("minimum_step", plan.minimum_steps);
}

void add_trust(CLI::App& command, bool& trust) {
    command.add_flag("--trust-code", trust, "Run custom code in the scene that is not known here");
}

/// "--size: 1 required WxH missing", as CLI11 has it, in the words of the other messages.
std::string nothing_given(std::string message) {
    constexpr std::string_view required = "1 required ", missing = " missing";
    if (const std::size_t at = message.find(required); at != std::string::npos && message.ends_with(missing)) {
        message.resize(message.size() - missing.size());
        message.replace(at, required.size(), "nothing given, expected ");
    }
    return message;
}

/// To stderr, which may be full as well: that is no reason to fail in another way.
template <class... Arguments>
void complain(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    std::fputs(fmt::format(format, std::forward<Arguments>(arguments)...).c_str(), stderr);
}

/// Whether stdout took everything: a full disk shows when the buffer is emptied, not before.
void check_written() {
    if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return;
    throw std::runtime_error(fmt::format("the output cannot be written: {}", std::strerror(errno)));
}

std::string command_names(CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
    return fmt::format("{}", fmt::join(names, ", "));
}

int run_command_line(int argc, char** argv) {
    CLI::App app{"Farfield: an editor for signed-distance-field scenes with indirect light"};
    app.footer(
        "Without a command the editor opens, on SCENE if given. Scene files are described in scenes/README.md.\n"
        "Exit status: 0 done, 1 failed while running, 2 wrong use or wrong input.");
    app.require_subcommand(0, 1);
    EditorOptions editor;
    app.add_option("scene", editor.scene, "Scene file to open")->type_name("SCENE");
    app.add_option("--report", editor.report,
                   "Write names, places and state of the editor's controls to this file (for scripted tests)")
        ->type_name("FILE");

    add_trust(app, editor.trust_code);

    RenderOptions render;
    CLI::App* render_command = app.add_subcommand("render", "Render a scene to images without a window");
    render_command->add_option("SCENE", render.scene, "Scene file")->required();
    render_command
        ->add_option("-o,--output", render.outputs,
                     "EXR (linear, every view a layer) or PNG (as displayed); may be repeated")
        ->allow_extra_args(false)  // one for each -o, so that the scene may follow
        ->required()
        ->type_name("IMAGE");
    add_whole(*render_command, "--frames", render.frames, 1, 1'000'000,
              "Frames to accumulate, default 16, or as many as --noise and --seconds allow");
    add_number(*render_command, "--seconds", render.seconds, 1e-3f, 1e7f, "Stop with the frame in which they are over");
    add_whole(*render_command, "--seed", render.seed, 0u, ~0u, "Another seed gives another noise, default 0");
    std::string view_names;
    for (const ViewInfo& v : views()) view_names += (view_names.empty() ? "" : "|") + std::string(v.key);
    render_command
        ->add_option_function<std::string>(
            "--view",
            [&](const std::string& key) {
                const auto found = find_view(key);
                if (!found) refuse("--view", key, "one of " + view_names);
                render.view = *found;
            },
            "What the picture shows, default result")
        ->type_name(view_names);
    add_trust(*render_command, render.trust_code);
    add_common(*render_command, render.size, render.context, render.overrides);

    GlslOptions glsl;
    CLI::App* glsl_command = app.add_subcommand("glsl", "Print the generated distance function");
    glsl_command->add_option("SCENE", glsl.scene, "Scene file")->required();
    glsl_command->add_flag("--live", glsl.live, "The tier that reads its numbers from a parameter block");

    add_trust(*glsl_command, glsl.trust_code);

    CheckOptions check;
    CLI::App* check_command =
        app.add_subcommand("check", "Validate a scene file, print its nodes and what looks wrong");
    check_command->add_option("SCENE", check.scene, "Scene file")->required();
    add_whole(*check_command, "--samples", check.samples, 0, 10'000'000,
              "Pairs of points to find each node's slope by, default 2000; 0 looks at numbers alone");
    check_command->footer(
        "For each node: the Lipschitz constant of its field before it is made safe to step by, where that comes from,\n"
        "the steepest slope found afterwards, and its size in the world. Warnings go to stderr and leave the status "
        "0.");

    CLI::App* schema_command = app.add_subcommand("schema", "Print the JSON Schema of scene files");

    BenchOptions bench;
    CLI::App* bench_command = app.add_subcommand("bench", "Time per pass, evaluations per ray, compile time, memory");
    bench_command->add_option("SCENE", bench.scene, "Scene file")->required();
    add_whole(*bench_command, "--frames", bench.frames, 1, 10'000, "Frames to measure, default 5");
    bench_command->add_flag("--live", bench.live, "Also the tier that reads its numbers from a parameter block");
    bench_command->add_flag("--limit", bench.limit, "Also how near the tracer comes to what the device could do");
    bench_command->add_option("--json", bench.json, "Everything measured, for programs")->type_name("FILE");
    add_trust(*bench_command, bench.trust_code);
    add_common(*bench_command, bench.size, bench.context, bench.overrides);

    ContactSheetOptions sheet;
    CLI::App* sheet_command = app.add_subcommand("contact-sheet", "Render every kind of node into one picture");
    sheet_command->add_option("-o,--output", sheet.output, "PNG or JPEG")->required()->type_name("IMAGE");
    add_device(*sheet_command, "Pixels for each kind", sheet.tile, sheet.context);
    add_whole(*sheet_command, "--columns", sheet.columns, 1, 100, "Kinds in a row, default 8");
    sheet_command->add_option("--only", sheet.only, "These kinds alone, by their keys in scene files")
        ->type_name("KEY");
    add_whole(*sheet_command, "--frames", sheet.frames, 1, 1'000'000, "Frames to accumulate, default 16");

    CompareOptions compare;
    CLI::App* compare_command = app.add_subcommand("compare", "How far an image is from a reference, by every metric");
    compare_command->add_option("IMAGE", compare.image, "EXR (linear) or PNG (sRGB)")->required();
    compare_command->add_option("REFERENCE", compare.reference, "What it should be")->required();
    compare_command->add_option("--layer", compare.layer, "Of EXR files, as \"direct\"; default the file's own R, G, B")
        ->type_name("NAME");
    add_number(*compare_command, "--exposure", compare.exposure, -20.0f, 20.0f,
               "Stops, for FLIP, which compares what a screen shows; default 0");
    compare_command->footer(
        "RMSE / mean, relMSE and mean bias (of the image, less that of the reference) are relative to the reference's\n"
        "mean and count linear values; FLIP (Andersson et al. 2020) is 0 for pictures that look alike and at most 1.");

    ChartOptions chart;
    CLI::App* chart_command = app.add_subcommand("chart", "Speed against accuracy of scenes: CSV, SVG, PNG, tables");
    chart_command->add_option("SCENE", chart.scenes, "Scene files")->required();
    chart_command->add_option("-o,--output", chart.output, "Folder for chart.csv, chart.svg, chart.png and tables.md")
        ->required()
        ->type_name("DIR");
    add_device(*chart_command, "Pixels", chart.plan.size, chart.context);
    add_whole_list(*chart_command, "--samples", chart.plan.samples, 1, 1'000'000,
                   "Samples per pixel to measure at, default 4,16,64,256");
    add_whole(*chart_command, "--seeds", chart.plan.seeds, 1, 1000, "Repetitions with another noise, default 10");
    add_whole(*chart_command, "--reference-samples", chart.plan.reference_samples, 2, 100'000'000,
              "Samples per pixel of references, at least; default 16384");
    chart_command
        ->add_option("--references", chart.references,
                     "Folder where references are kept for the next time, default farfield/references in the user's "
                     "cache")
        ->type_name("DIR");
    chart_command
        ->add_option_function<std::string>(
            "--vary", [&](const std::string& text) { choose_varied(chart.plan, text); },
            "Settings to vary one at a time beside method and samples: any of blur_levels, ao_radius, bounces, scale, "
            "minimum_step with commas between them, or none; default all")
        ->type_name("NAME,...");
    add_trust(*chart_command, chart.trust_code);
    chart_command->footer(
        "Every method at every number of samples with the scene's own settings, and around them one setting varied at "
        "a\n"
        "time: blur levels 0, 1, 2, 4, 5; AO radius x 1/4, 1/2, 2, 4; bounces 1, 2, 4, against a reference with the "
        "most of\n"
        "them; half and quarter width and height, magnified; 4, 16 and 64 times the tracer's minimum step.\n"
        "Lines that chart.csv has already are not measured again: an interrupted run goes on where it was, a changed "
        "scene\n"
        "is measured anew. Time is CPU time of the process on all cores, or the GPU's own; error is that of the light "
        "that\n"
        "indirect light adds, FLIP that of the whole picture. The table has them as measured, the noise of the "
        "reference\n"
        "beside them; chart and tables subtract it. Columns:\n" +
        chart_columns());

    try {
        app.parse(argc, argv);
        int status = 0;
        if (*render_command)
            status = run_render(render);
        else if (*glsl_command)
            status = run_glsl(glsl);
        else if (*check_command)
            status = run_check(check);
        else if (*schema_command)
            status = run_schema();
        else if (*sheet_command)
            status = run_contact_sheet(sheet);
        else if (*compare_command)
            status = run_compare(compare);
        else if (*chart_command)
            status = run_chart(chart);
        else if (*bench_command)
            status = run_bench(bench);
        else
            status = run_editor(editor);
        check_written();
        return status;
    } catch (const CLI::Success& help) {
        app.exit(help);
        if (std::cout.flush()) return 0;
        complain("farfield: the output cannot be written: {}\n", std::strerror(errno));
        return 1;
    } catch (const CLI::ExtrasError& error) {
        if (app.get_subcommands().empty() && !editor.scene.empty() && !std::filesystem::exists(editor.scene))
            complain("\"{}\" given, expected {} or one scene file\n", editor.scene.string(), command_names(app));
        else
            app.exit(error);
        return 2;
    } catch (const CLI::ArgumentMismatch& error) {
        complain("{}\nRun with --help for more information.\n", nothing_given(error.what()));
        return 2;
    } catch (const CLI::ParseError& error) {
        app.exit(error);
        return 2;
    } catch (const SceneFileError& error) {
        complain("{}\n", error.what());
        return 2;
    } catch (const std::invalid_argument& error) {
        complain("{}\n", error.what());
        return 2;
    } catch (const std::exception& error) {
        complain("farfield: {}\n", error.what());
        return 1;
    }
}

}  // namespace
}  // namespace farfield

int main(int argc, char** argv) { return farfield::run_command_line(argc, argv); }
