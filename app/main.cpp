// The command line: `farfield [SCENE]` opens the editor, the subcommands work without a window.
#include "app/commands.h"
#include "app/contact_sheet.h"
#include "app/editor.h"
#include "renderer/gl.h"
#include "renderer/image.h"
#include "sdf/fields.h"
#include "sdf/scene_file.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>

namespace farfield {
namespace {

/// "768x512" to a size; throws CLI::ValidationError.
glm::ivec2 parse_size(const std::string& text) {
    glm::ivec2 size{0};
    char rest = 0;
    if (std::sscanf(text.c_str(), "%dx%d%c", &size.x, &size.y, &rest) != 2 || size.x < 1 || size.y < 1 ||
        size.x > 16384 || size.y > 16384)
        throw CLI::ValidationError("--size",
                                   fmt::format("\"{}\" given, expected WIDTHxHEIGHT, each between 1 and 16384", text));
    return size;
}

/// Options of every command that renders.
void add_device(CLI::App& command, const char* pixels, glm::ivec2& size, ContextKind& context) {
    command
        .add_option_function<std::string>(
            "--size", [&](const std::string& text) { size = parse_size(text); },
            fmt::format("{}, default {}x{}", pixels, size.x, size.y))
        ->type_name("WxH");
    command.add_option("--context", context, "Where OpenGL comes from")
        ->transform(CLI::CheckedTransformer(std::map<std::string, ContextKind>{
            {"auto", ContextKind::automatic}, {"egl", ContextKind::egl}, {"osmesa", ContextKind::osmesa}}))
        ->type_name("auto|egl|osmesa");
}

/// The same for commands that render a scene. One option for each setting comes from the settings table.
void add_common(CLI::App& command, glm::ivec2& size, ContextKind& context, Overrides& overrides) {
    add_device(command, "Pixels", size, context);
    for (const Field<Settings>& field : fields<Settings>()) {
        const Parameter& p = field.parameter;
        std::string option = fmt::format("--{}", p.key);
        std::replace(option.begin(), option.end(), '_', '-');
        command
            .add_option_function<std::string>(
                option,
                [&overrides, key = p.key](const std::string& text) { overrides.values.emplace_back(key, text); },
                fmt::format("{} (default: the scene's)", p.tip))
            ->type_name(p.choices.empty() ? "NUMBER" : fmt::format("{}", fmt::join(p.choices, "|")));
    }
}

int run(int argc, char** argv) {
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

    RenderOptions render;
    CLI::App* render_command = app.add_subcommand("render", "Render a scene to images without a window");
    render_command->add_option("SCENE", render.scene, "Scene file")->required();
    render_command
        ->add_option("-o,--output", render.outputs,
                     "EXR (linear, every view a layer) or PNG (as displayed); may be repeated")
        ->allow_extra_args(false)  // one for each -o, so that the scene may follow
        ->required()
        ->type_name("IMAGE");
    render_command->add_option("--frames", render.frames, "Frames to accumulate, default 16")
        ->check(CLI::Range(1, 1'000'000));
    render_command->add_option("--seed", render.seed, "Another seed gives another noise, default 0");
    std::string view_names;
    for (const ViewInfo& v : views()) view_names += (view_names.empty() ? "" : "|") + std::string(v.key);
    render_command
        ->add_option_function<std::string>(
            "--view",
            [&](const std::string& key) {
                const auto found = find_view(key);
                if (!found)
                    throw CLI::ValidationError("--view",
                                               fmt::format("\"{}\" given, expected one of {}", key, view_names));
                render.view = *found;
            },
            "What the picture shows, default result")
        ->type_name(view_names);
    add_common(*render_command, render.size, render.context, render.overrides);

    GlslOptions glsl;
    CLI::App* glsl_command = app.add_subcommand("glsl", "Print the generated distance function");
    glsl_command->add_option("SCENE", glsl.scene, "Scene file")->required();
    glsl_command->add_flag("--live", glsl.live, "The tier that reads its numbers from a parameter block");

    std::filesystem::path check_scene;
    CLI::App* check_command = app.add_subcommand("check", "Validate a scene file");
    check_command->add_option("SCENE", check_scene, "Scene file")->required();

    CLI::App* schema_command = app.add_subcommand("schema", "Print the JSON Schema of scene files");

    BenchOptions bench;
    CLI::App* bench_command = app.add_subcommand("bench", "Time per pass, evaluations per ray, compile time");
    bench_command->add_option("SCENE", bench.scene, "Scene file")->required();
    bench_command->add_option("--frames", bench.frames, "Frames to measure, default 5")->check(CLI::Range(1, 10'000));
    bench_command->add_flag("--live", bench.live, "Also the tier that reads its numbers from a parameter block");
    add_common(*bench_command, bench.size, bench.context, bench.overrides);

    ContactSheetOptions sheet;
    CLI::App* sheet_command = app.add_subcommand("contact-sheet", "Render every kind of node into one picture");
    sheet_command->add_option("-o,--output", sheet.output, "PNG or JPEG")->required()->type_name("IMAGE");
    add_device(*sheet_command, "Pixels for each kind", sheet.tile, sheet.context);
    sheet_command->add_option("--columns", sheet.columns, "Kinds in a row, default 8")->check(CLI::Range(1, 100));
    sheet_command->add_option("--only", sheet.only, "These kinds alone, by their keys in scene files")
        ->type_name("KEY");
    sheet_command->add_option("--frames", sheet.frames, "Frames to accumulate, default 16")
        ->check(CLI::Range(1, 1'000'000));

    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& e) {
        return app.exit(e);
    } catch (const CLI::ParseError& e) {
        app.exit(e);
        return 2;
    }
    try {
        if (*render_command) return run_render(render);
        if (*glsl_command) return run_glsl(glsl);
        if (*check_command) return run_check(check_scene);
        if (*schema_command) return run_schema();
        if (*sheet_command) return run_contact_sheet(sheet);
        if (*bench_command) return run_bench(bench);
        return run_editor(editor);
    } catch (const SceneFileError& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 2;
    } catch (const std::invalid_argument& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 2;
    } catch (const std::exception& error) {
        fmt::print(stderr, "farfield: {}\n", error.what());
        return 1;
    }
}

}  // namespace
}  // namespace farfield

int main(int argc, char** argv) { return farfield::run(argc, argv); }
