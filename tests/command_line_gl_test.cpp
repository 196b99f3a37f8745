// The program as scripts use it: exit statuses, messages, files.
#include "renderer/image.h"
#include "renderer/views.h"
#include "tests/program.h"
#include "tests/test_support.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <set>

namespace farfield {
namespace {

TEST(CommandLine, HelpNamesEveryCommandAndNeedsNoDisplay) {
    const Outcome help = farfield_command("--help");
    EXPECT_EQ(help.status, 0);
    for (const char* word :
         {"render", "glsl", "check", "schema", "contact-sheet", "compare", "bench", "SCENE", "scenes/README.md"})
        EXPECT_NE(help.output.find(word), std::string::npos) << word;
    const Outcome render = farfield_command("render --help");
    EXPECT_EQ(render.status, 0);
    for (const char* option : {"--size", "--method", "--samples", "--frames", "--blur-levels", "--ao-radius",
                               "--bounces", "--seed", "--view", "--context", "--exposure"})
        EXPECT_NE(render.output.find(option), std::string::npos) << option;
}

TEST(CommandLine, RenderedFilesHoldEveryViewAndRepeatBitForBit) {
    const TemporaryFolder folder;
    const std::string options = scene("cornell") + " --size 48x32 --frames 2 --samples 2 --seed 3";
    for (const char* name : {"a", "b"}) {
        const Outcome render = farfield_command(fmt::format("render {} -o '{}' -o '{}'", options,
                                                            (folder / fmt::format("{}.exr", name)).string(),
                                                            (folder / fmt::format("{}.png", name)).string()));
        ASSERT_EQ(render.status, 0) << render.output;
        EXPECT_EQ(render.output, "");
    }
    EXPECT_EQ(read_image(folder / "a.exr").pixels, read_image(folder / "b.exr").pixels);
    EXPECT_EQ(read_text(folder / "a.png"), read_text(folder / "b.png"));
    EXPECT_EQ(read_image(folder / "a.png").size, glm::ivec2(48, 32));

    const auto exr = OIIO::ImageInput::open((folder / "a.exr").string());
    ASSERT_TRUE(exr);
    EXPECT_EQ(exr->spec().format, OIIO::TypeDesc::FLOAT);
    const std::vector<std::string>& channels = exr->spec().channelnames;
    for (const ViewInfo& view : views())
        for (const char* channel : {".R", ".G", ".B"})
            EXPECT_NE(std::find(channels.begin(), channels.end(), view.key + std::string(channel)), channels.end())
                << view.key;
}

TEST(CommandLine, AutomaticBouncesSayWhatTheyCameTo) {
    const TemporaryFolder folder;
    const auto picture = folder / "a.png";
    const Outcome render = farfield_command(
        fmt::format("render {} -o '{}' --size 64x64 --frames 1 --bounces auto", scene("cornell"), picture.string()));
    EXPECT_EQ(render.status, 0);
    for (const char* word : {" bounces; bounce ", " adds 0.", " %"})
        EXPECT_NE(render.output.find(word), std::string::npos) << render.output;
}

TEST(CommandLine, RenderingStopsAtANoiseOrATime) {
    const TemporaryFolder folder;
    const std::string render =
        fmt::format("render {} -o '{}' --size 32x32 --samples 4 ", scene("cornell"), (folder / "a.png").string());
    const auto frames = [&](const std::string& options) {
        const Outcome outcome = farfield_command(render + options);
        EXPECT_EQ(outcome.status, 0) << outcome.output;
        const std::size_t at = outcome.output.find("samples in ");
        return at == std::string::npos ? -1 : std::stoi(outcome.output.substr(at + 11));
    };
    const int coarse = frames("--method reference --noise 16"), fine = frames("--method reference --noise 8");
    EXPECT_GT(coarse, 4);
    EXPECT_NEAR(fine, 4 * coarse, 2 * coarse);  // a quarter of the variance; looked at every quarter more
    EXPECT_LT(frames("--noise 16"), coarse);
    EXPECT_EQ(frames("--noise 1 --frames 2"), 2);
    EXPECT_EQ(frames("--noise off --seconds 0.001"), 1);
    EXPECT_EQ(frames("--noise 0.1 --seconds 0.001"), 1);
}

TEST(CommandLine, GeneratedCodeIsPrinted) {
    const Outcome glsl = farfield_command("glsl " + scene("cornell"));
    EXPECT_EQ(glsl.status, 0);
    EXPECT_NE(glsl.output.find("float scene_distance(vec3 p) {"), std::string::npos);
}

TEST(CommandLine, TheSchemaIsPrinted) {
    const Outcome schema = farfield_command("schema");
    EXPECT_EQ(schema.status, 0);
    EXPECT_EQ(schema.output, read_text(std::filesystem::path(FARFIELD_SCENES) / "schema.json"));
}

/// A stranger's code is not given to the driver unasked; what comes with the program is.
TEST(CommandLine, CodeFromElsewhereIsRefused) {
    const TemporaryFolder folder;
    const auto file = folder / "foreign.json", picture = folder / "a.png", config = folder / "config";
    write_text(file,
               "{\"farfield\": 1, \"root\": {\"kind\": \"union\", \"children\": [{\"kind\": \"custom\", \"name\": "
               "\"blob\", \"code\": [\"float sdf(vec3 p) { return length(p) - 0.125; }\"]}, {\"kind\": \"custom\", "
               "\"code\": [\"float sdf(vec3 p) { return 1.0; }\"]}, {\"kind\": \"custom\"}]}}");
    const std::string before = fmt::format("export XDG_CONFIG_HOME='{}';", config.string());
    const auto run = [&](const std::string& arguments) { return farfield_command(arguments, before.c_str()); };
    const std::string render =
        fmt::format("render '{}' -o '{}' --size 16x16 --frames 1 ", file.string(), picture.string());
    for (const std::string& command :
         {render, fmt::format("glsl '{}'", file.string()), fmt::format("bench '{}' --size 16x16", file.string())}) {
        const Outcome refused = run(command);
        EXPECT_EQ(refused.status, 2) << command;
        for (const char* word : {"foreign.json: root/children[0] \"blob\"", "one other node", "--trust-code"})
            EXPECT_NE(refused.output.find(word), std::string::npos) << refused.output;
    }
    EXPECT_FALSE(std::filesystem::exists(picture));
    EXPECT_EQ(run(fmt::format("check '{}'", file.string())).status, 0);  // gives nothing to the driver
    EXPECT_EQ(run(render + "--trust-code").status, 0);
    EXPECT_TRUE(std::filesystem::exists(picture));
    EXPECT_EQ(run(render).status, 2) << "the option counts for one command";
    EXPECT_EQ(run("glsl " + scene("gyroid")).status, 0);
    EXPECT_NE(farfield_command("--help").output.find("--trust-code"), std::string::npos);
    EXPECT_NE(farfield_command("render --help").output.find("--trust-code"), std::string::npos);
}

TEST(CommandLine, BenchReportsPassesAndEvaluations) {
    const Outcome bench = farfield_command("bench " + scene("cornell") + " --size 32x32 --frames 1 --live");
    EXPECT_EQ(bench.status, 0) << bench.output;
    for (const char* word :
         {"compiled in", "frames/s", "camera rays", "far light", "evaluations per ray", "live program"})
        EXPECT_NE(bench.output.find(word), std::string::npos) << word;
}

TEST(CommandLine, BenchComparesTheTracerWithWhatIsPossible) {
    const TemporaryFolder folder;
    const auto file = folder / "bench.json";
    const Outcome bench = farfield_command(
        fmt::format("bench {} --size 64x64 --frames 1 --limit --json '{}'", scene("cornell"), file.string()));
    ASSERT_EQ(bench.status, 0) << bench.output;
    for (const char* word : {"multiply-adds", "oracle", "plain loop", "shadow of a bounce", "MB per megapixel"})
        EXPECT_NE(bench.output.find(word), std::string::npos) << word;
    std::ifstream in(file);
    const auto json = nlohmann::json::parse(in);
    const auto &program = json.at("specialised"), &limit = program.at("limit");
    EXPECT_GT(limit.at("multiply_adds_per_second"), 1e8);
    std::uint64_t rays = 0;
    double evaluations = 0.0;
    for (const auto& kind : limit.at("rays")) {
        rays += kind.at("rays").get<std::uint64_t>();
        evaluations += kind.at("rays").get<double>() * kind.at("evaluations_per_ray").get<double>();
        EXPECT_GE(kind.at("over_oracle"), 1.0) << kind;
        EXPECT_GT(kind.at("lane_occupancy"), 0.1) << kind;
        EXPECT_LE(kind.at("lane_occupancy"), 1.0) << kind;
        EXPECT_GT(kind.at("tracer_over_plain"), 0.0) << kind;
    }
    // The census traces the frame's rays, no others; which of a pixel's rays have none of a light depends on the
    // samples.
    const auto& counted = program.at("rays");
    EXPECT_NEAR(static_cast<double>(rays), counted.at("rays").get<double>(), 0.02 * static_cast<double>(rays));
    EXPECT_NEAR(evaluations, counted.at("evaluations").get<double>(), 0.02 * evaluations);
    EXPECT_EQ(limit.at("rays")[0].at("rays"), 64 * 64) << "a camera ray for each pixel";
    EXPECT_EQ(farfield_command("bench " + scene("cornell") + " --json a.txt").status, 2);
}

TEST(CommandLine, AContactSheetShowsTheKindsAskedFor) {
    const TemporaryFolder folder;
    const auto sheet = [&](const char* name, const char* arguments) {
        return farfield_command(
            fmt::format("contact-sheet -o '{}' --size 40x24 --frames 1 {}", (folder / name).string(), arguments));
    };
    // Distinct pixels: a tile of nothing but background, text or black has few.
    const auto colours = [](const Image& image) {
        std::set<std::array<float, 3>> found;
        for (std::size_t i = 0; i < image.pixels.size(); i += 3)
            found.insert({image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]});
        return found.size();
    };
    for (const char* name : {"one.png", "again.png"}) {
        const Outcome one = sheet(name, "--only torus");
        ASSERT_EQ(one.status, 0) << one.output;
        EXPECT_EQ(one.output, "");
    }
    EXPECT_EQ(read_text(folder / "one.png"), read_text(folder / "again.png"));
    ASSERT_EQ(sheet("two.png", "--only torus subtract").status, 0);
    ASSERT_EQ(sheet("below.png", "--columns 1 --only torus subtract").status, 0);
    const Image one = read_image(folder / "one.png"), two = read_image(folder / "two.png"),
                below = read_image(folder / "below.png");
    EXPECT_GT(colours(one), 100u);
    EXPECT_GE(two.size.x, one.size.x + 40);
    EXPECT_EQ(two.size.y, one.size.y);
    EXPECT_EQ(below.size.x, one.size.x);
    EXPECT_GE(below.size.y, one.size.y + 24);

    const Outcome wrong = sheet("wrong.png", "--only torus speere");
    EXPECT_EQ(wrong.status, 2);
    EXPECT_NE(wrong.output.find("\"speere\" given"), std::string::npos) << wrong.output;
    EXPECT_NE(wrong.output.find("(perhaps sphere)"), std::string::npos) << wrong.output;
    EXPECT_EQ(sheet("wrong.exr", "--only torus").status, 2);
    EXPECT_EQ(sheet("no/folder.png", "--only torus").status, 1);
    EXPECT_FALSE(std::filesystem::exists(folder / "wrong.png"));
}

TEST(CommandLine, CompareMeasuresLayersAndDisplayFiles) {
    const TemporaryFolder folder;
    const auto file = [&](const char* name) { return fmt::format("'{}'", (folder / name).string()); };
    const Image one{{2, 1}, {1, 1, 1, 1, 1, 1}}, two{{2, 1}, {2, 2, 2, 1, 1, 1}};
    write_exr(folder / "a.exr", {{"", one}, {"direct", two}});
    write_exr(folder / "b.exr", {{"", one}, {"direct", one}});
    write_exr(folder / "nan.exr", {{"", Image{{2, 1}, {1, 1, 1, 1, 1, std::nanf("")}}}});
    write_exr(folder / "small.exr", {{"", Image{{1, 1}, {1, 1, 1}}}});
    write_display(folder / "a.png", {2, 1}, {255, 255, 255, 255, 255, 255});
    write_text(folder / "text.exr", "no image");
    const Outcome alike = farfield_command("compare " + file("a.exr") + " " + file("a.png"));
    EXPECT_EQ(alike.status, 0) << alike.output;
    EXPECT_NE(alike.output.find("RMSE / mean      0\n"), std::string::npos) << alike.output;
    EXPECT_NE(alike.output.find("FLIP             0.000000\n"), std::string::npos) << alike.output;
    const Outcome layer = farfield_command("compare " + file("a.exr") + " " + file("b.exr") + " --layer direct");
    EXPECT_EQ(layer.status, 0) << layer.output;
    for (const char* text :
         {"RMSE / mean      0.707107\n", "mean bias        +50.0000 %\n", "relMSE           0.49505\n"})
        EXPECT_NE(layer.output.find(text), std::string::npos) << text << layer.output;
    for (const char* arguments : {"a.exr nan.exr", "a.exr small.exr", "a.exr text.exr", "a.exr missing.exr"}) {
        const std::string_view both = arguments, second = both.substr(6);
        const Outcome wrong = farfield_command("compare " + file("a.exr") + " " + file(std::string(second).c_str()));
        EXPECT_EQ(wrong.status, 2) << arguments << wrong.output;
        EXPECT_NE(wrong.output.find(second), std::string::npos) << wrong.output;
    }
    EXPECT_EQ(farfield_command("compare " + file("a.exr") + " " + file("b.exr") + " --layer no").status, 2);
    EXPECT_EQ(farfield_command("compare " + file("a.exr") + " " + file("b.exr") + " --exposure nan").status, 2);
    EXPECT_EQ(farfield_command("compare " + file("a.exr")).status, 2);
}

TEST(CommandLine, WrongUseAndWrongInputExitWithTwo) {
    const TemporaryFolder folder;
    write_text(folder / "broken.json", "{\n  \"farfield\": 1,\n  \"root\": {\"kind\": \"blob\"}\n}\n");
    const std::string broken = fmt::format("'{}'", (folder / "broken.json").string());
    const std::string output = fmt::format(" -o '{}'", (folder / "out.png").string());
    for (const std::string& arguments :
         {std::string("render"), "render " + scene("cornell"), "render " + scene("cornell") + output + " --size 0x4",
          "render " + scene("cornell") + output + " --size big",
          "render " + scene("cornell") + output + " --samples 65",
          "render " + scene("cornell") + output + " --samples nan",
          "render " + scene("cornell") + output + " --method magic",
          "render " + scene("cornell") + output + " --view nothing",
          "render " + scene("cornell") + output + " --frames 0", "render " + broken + output, "glsl " + broken,
          "check " + broken, "bench " + broken, "render " + scene("cornell") + " -o a.unknown",
          std::string("--nonsense"), "render '" + (folder / "missing.json").string() + "'" + output}) {
        const Outcome outcome = farfield_command(arguments);
        EXPECT_EQ(outcome.status, 2) << arguments << "\n" << outcome.output;
        EXPECT_FALSE(outcome.output.empty()) << arguments;
    }
    EXPECT_NE(farfield_command("check " + broken).output.find("broken.json:3: root/kind"), std::string::npos)
        << farfield_command("check " + broken).output;
    EXPECT_FALSE(std::filesystem::exists(folder / "out.png"));
}

TEST(CommandLine, CheckTellsOfNodesAndWarnsAtTheirLines) {
    const TemporaryFolder folder;
    const std::string file = (folder / "scene.json").string();
    write_text(file, R"({"farfield": 1, "root": {"kind": "union", "children": [
        {"kind": "twist", "name": "vase", "rate": 110, "children": [
            {"kind": "box", "half_size": [0.3, 0.5, 0.3]}]},
        {"kind": "shell", "name": "skin", "thickness": 5e-5, "children": [{"kind": "sphere"}]}]}})");
    const Outcome found = farfield_command(fmt::format("check '{}' --samples 100", file));
    EXPECT_EQ(found.status, 0) << found.output;
    for (const char* text :
         {"5 nodes", "bounds  x -0.5 to 0.5", "camera  outside of what is solid", "\n  vase ", "\n    Box ",
          "twist: 110 °/m at up to 0.424 m from the axis", "0.849 x 1 x 0.849 m", "1 warning\n"})
        EXPECT_NE(found.output.find(text), std::string::npos) << text << "\n" << found.output;
    EXPECT_NE(found.output.find(file + ":4: root/children[1] \"skin\": a skin of 5e-05 m"), std::string::npos)
        << found.output;
    const Outcome table = farfield_command(fmt::format("check '{}' 2>/dev/null", file));
    EXPECT_EQ(table.output.find("a skin"), std::string::npos) << "warnings go to stderr";
    for (const auto& bundled : bundled_scenes()) {
        const Outcome quiet = farfield_command(fmt::format("check '{}' >/dev/null", bundled.string()));
        EXPECT_EQ(quiet.output, "") << bundled;
    }
    EXPECT_EQ(farfield_command(fmt::format("check '{}' --samples -1", file)).status, 2);
}

TEST(CommandLine, AMessageAboutAnOptionTellsOptionFoundAndExpected) {
    const std::pair<const char*, const char*> cases[] = {
        {"--frames 0", "--frames: \"0\" given, expected a whole number between 1 and 1000000"},
        {"--noise 0", "--noise: \"0\" given, expected a number between 0.1 and 100, or \"off\""},
        {"--seconds nan", "--seconds: \"nan\" given, expected a number between 0.001 and 10000000"},
        {"--frames 1.5", "--frames: \"1.5\" given, expected a whole number between 1 and 1000000"},
        {"--seed -1", "--seed: \"-1\" given, expected a whole number between 0 and 4294967295"},
        {"--context foo", "--context: \"foo\" given, expected auto, egl or osmesa"},
        {"--view q", "--view: \"q\" given, expected one of result|"},
        {"--ao-radius big", "--ao-radius: \"big\" given, expected a number"},
        {"--exposure +-2", "--exposure: \"+-2\" given, expected a number between -20 and 20"},
        {"--size 8x", "--size: \"8x\" given, expected WIDTHxHEIGHT, each between 1 and 16384"},
        {"--size 16384x16384", "--size: \"16384x16384\" given, expected at most 33554432 pixels"},
        {"--size", "--size: nothing given, expected WxH"},
    };
    for (const auto& [option, message] : cases) {
        const Outcome outcome = farfield_command(fmt::format("render {} -o a.png {}", scene("cornell"), option));
        EXPECT_EQ(outcome.status, 2) << option;
        EXPECT_TRUE(outcome.output.starts_with(message)) << option << "\n" << outcome.output;
    }
    const Outcome unknown = farfield_command("rendr " + scene("cornell"));
    EXPECT_EQ(unknown.status, 2);
    EXPECT_TRUE(unknown.output.starts_with("\"rendr\" given, expected render, glsl, check, ")) << unknown.output;
}

TEST(CommandLine, NumbersMayHaveAPlus) {
    const TemporaryFolder folder;
    const Outcome outcome =
        farfield_command(fmt::format("render {} --size +8x8 --frames +1 --samples +1 --exposure +2 -o '{}'",
                                     scene("cornell"), (folder / "a.png").string()));
    EXPECT_EQ(outcome.status, 0) << outcome.output;
}

TEST(CommandLine, AFullDiskIsNoticed) {
    for (const std::string& arguments :
         {"check " + scene("cornell"), "glsl " + scene("helix"), std::string("--help"), std::string("render --help")}) {
        const Outcome outcome = farfield_command(arguments + " >/dev/full");
        EXPECT_EQ(outcome.status, 1) << arguments;
        EXPECT_NE(outcome.output.find("No space left on device"), std::string::npos) << arguments << outcome.output;
    }
    EXPECT_EQ(farfield_command("check nosuch.json 2>/dev/full").status, 2) << "a message that cannot be written";
    // As full as can be had without a disk of one's own: files of 4 blocks at most.
    const TemporaryFolder folder;
    for (const char* file : {"a.png", "a.exr"}) {
        const Outcome outcome = farfield_command(fmt::format("render {} --size 256x256 --frames 1 --samples 1 -o '{}'",
                                                             scene("cornell"), (folder / file).string()),
                                                 "trap '' XFSZ; ulimit -f 4; ");
        EXPECT_EQ(outcome.status, 1) << file;
        EXPECT_NE(outcome.output.find(std::string(file) + ": cannot be written"), std::string::npos) << outcome.output;
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder / ""));
}

TEST(CommandLine, AnImpossibleOutputExitsWithOneAndLeavesNothing) {
    const TemporaryFolder folder;
    for (const char* file : {"no/such/folder/a.png", "a.exr/b.exr"}) {
        const Outcome outcome = farfield_command(fmt::format("render {} --size 8x8 --frames 1 --samples 1 -o '{}'",
                                                             scene("cornell"), (folder / file).string()));
        EXPECT_EQ(outcome.status, 1) << file << "\n" << outcome.output;
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder / ""));
}

TEST(CommandLine, WithoutADisplayTheEditorSaysSo) {
    const Outcome outcome = farfield_command(scene("cornell"));
    EXPECT_EQ(outcome.status, 1);
    EXPECT_FALSE(outcome.output.empty());
    const Outcome missing = farfield_command("nosuch.json");
    EXPECT_EQ(missing.status, 2);
    EXPECT_EQ(missing.output, "nosuch.json: cannot be opened: No such file or directory\n");
}

}  // namespace
}  // namespace farfield
