// References that are kept and grow, the sweep over settings, and `farfield chart` as scripts use it.
#include "app/chart_table.h"
#include "renderer/metrics.h"
#include "renderer/reference_store.h"
#include "renderer/sweep.h"
#include "renderer/sweep_statistics.h"
#include "sdf/scene_file.h"
#include "tests/gl_test.h"
#include "tests/program.h"
#include "tests/test_support.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace farfield {
namespace {

constexpr glm::ivec2 size{32, 32};

class Charts : public GlTest {
protected:
    void SetUp() override {
        GlTest::SetUp();
        renderer_.emplace();
    }
    void TearDown() override {
        renderer_.reset();
        GlTest::TearDown();
    }
    void grow(Reference& reference, int samples) {
        ASSERT_TRUE(extend(
            reference, *renderer_, scene_, size, samples, [] { return true; }, [] {}));
    }
    Scene scene_ = load_scene(std::filesystem::path(FARFIELD_SCENES) / "cornell.json");
    std::optional<Renderer> renderer_;
};

/// A picture of another seed with as many samples is as far from the mean of the halves as two such noises.
TEST_F(Charts, AReferenceKnowsItsNoise) {
    Reference reference;
    grow(reference, 512);
    EXPECT_EQ(reference.samples(), 512);
    scene_.settings.method = Method::reference;
    renderer_->update(scene_, {.size = size, .seed = 7, .samples = 8});
    renderer_->discard();
    while (renderer_->statistics().samples < 512) renderer_->render_frame();
    const Image image = difference(renderer_->read(View::result), renderer_->read(View::direct));
    const Metrics metrics = measure(image, reference.indirect());
    EXPECT_GT(metrics.rmse * metrics.rmse, 1.0 * reference.noise_mse());
    EXPECT_LT(metrics.rmse * metrics.rmse, 4.0 * reference.noise_mse());
    EXPECT_GT(metrics.relative_mse, 1.0 * reference.noise_relative_mse());
    EXPECT_LT(metrics.relative_mse, 4.0 * reference.noise_relative_mse());
    EXPECT_LT(std::abs(metrics.bias), 0.01);
}

TEST_F(Charts, AReferenceGrowsOnTopOfWhatThereIs) {
    Reference grown, whole;
    grow(grown, 64);
    const double noise = grown.noise_mse();
    EXPECT_EQ(frames_to_extend(grown, 64), 0);
    EXPECT_EQ(frames_to_extend(grown, 512), (512 - 64) / 8);
    const Image first = grown.halves[0].indirect;
    grow(grown, 512);
    EXPECT_EQ(grown.halves[0].samples, 256);
    EXPECT_NE(grown.halves[0].indirect.pixels, first.pixels);
    EXPECT_LT(grown.noise_mse(), 0.3 * noise) << "an eighth, for independent samples";
    const Image before = grown.indirect();
    grow(grown, 512);
    EXPECT_EQ(grown.indirect().pixels, before.pixels);

    int frames = 0;  // interrupted: the portion counts for nothing
    EXPECT_FALSE(extend(
        grown, *renderer_, scene_, size, 1024, [&] { return ++frames < 3; }, [] { FAIL(); }));
    EXPECT_EQ(frames, 3);
    EXPECT_EQ(grown.indirect().pixels, before.pixels);
}

TEST_F(Charts, TheKeyIsOfWhatLightDependsOn) {
    const std::string key = reference_key(scene_, size);
    EXPECT_EQ(key.size(), 64u);
    Scene other = scene_;
    other.settings = {.method = Method::paper,
                      .samples = 9,
                      .bounces = scene_.settings.bounces,
                      .blur_levels = 0,
                      .ao_radius = 3.0f,
                      .exposure = 2.0f};
    other.materials[0].name = "renamed";
    EXPECT_EQ(reference_key(other, size), key);
    const auto differs = [&](auto change) {
        Scene changed = scene_;
        change(changed);
        return reference_key(changed, size) != key;
    };
    EXPECT_TRUE(differs([](Scene& s) { s.settings.bounces = 2; }));
    EXPECT_TRUE(differs([](Scene& s) { s.camera.position.x += 0.01f; }));
    EXPECT_TRUE(differs([](Scene& s) { s.camera.field_of_view += 1.0f; }));
    EXPECT_TRUE(differs([](Scene& s) { s.materials[0].albedo.x *= 0.5f; }));
    EXPECT_TRUE(differs([](Scene& s) { s.lights.at(0).intensity *= 2.0f; }));
    EXPECT_TRUE(differs([](Scene& s) { s.sky.zenith.x += 1.0f; }));
    EXPECT_TRUE(differs([](Scene& s) { s.root.children.pop_back(); }));
    EXPECT_TRUE(differs([](Scene& s) { s.root.children[0].transform.translate.x += 0.1f; }));
    EXPECT_NE(reference_key(scene_, {32, 31}), key);
}

TEST_F(Charts, StoredReferencesComeBackAndBrokenOnesDoNot) {
    const TemporaryFolder folder;
    const ReferenceStore store(folder / "a/b");
    const std::string key = reference_key(scene_, size);
    std::string problem;
    EXPECT_EQ(store.load(key, size, problem).samples(), 0);
    EXPECT_EQ(problem, "");
    Reference reference;
    grow(reference, 32);
    store.save(key, reference);
    const Reference loaded = store.load(key, size, problem);
    EXPECT_EQ(problem, "");
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(loaded.halves[i].samples, reference.halves[i].samples);
        EXPECT_EQ(loaded.halves[i].indirect.pixels, reference.halves[i].indirect.pixels);
        EXPECT_EQ(loaded.halves[i].result.pixels, reference.halves[i].result.pixels);
    }

    const auto refused = [&](const std::string& of, glm::ivec2 expected_size) {
        const Reference none = store.load(of, expected_size, problem);
        EXPECT_NE(problem.find(store.file(of).string()), std::string::npos) << problem;
        EXPECT_NE(problem.find("is made again"), std::string::npos) << problem;
        return none.samples() == 0;
    };
    EXPECT_TRUE(refused(key, {32, 31}));
    const std::string bytes = read_text(store.file(key));
    write_text(store.file(std::string(64, '0')), bytes);
    EXPECT_TRUE(refused(std::string(64, '0'), size)) << "under another name";
    for (const std::size_t length : {std::size_t(0), std::size_t(10), bytes.size() / 2, bytes.size() - 1}) {
        write_text(store.file(key), bytes.substr(0, length));
        EXPECT_TRUE(refused(key, size)) << length;
    }
    const std::vector<Layer> layers{{"a.indirect", loaded.halves[0].indirect},
                                    {"a.result", loaded.halves[0].result},
                                    {"b.indirect", loaded.halves[1].indirect},
                                    {"b.result", loaded.halves[1].result}};
    for (const char* samples : {"0", "-4", "nan", "99999999999", "2000000000", ""}) {
        write_exr(store.file(key), layers,
                  {{"farfield:key", key}, {"farfield:samples.a", samples}, {"farfield:samples.b", "16"}});
        EXPECT_TRUE(refused(key, size)) << samples;
    }
}

TEST_F(Charts, ASweepMeasuresWhatItSaysAndStopsWhenTold) {
    SweepPlan plan{.size = size,
                   .samples = {4, 8},
                   .seeds = 2,
                   .reference_samples = 128,
                   .blur_levels = {0, 3},
                   .ao_factors = {0.5f},
                   .bounces = {1, 2},
                   .minimum_steps = {8.0f},
                   .scales = {0.5f}};
    Sweep sweep(scene_, plan);
    EXPECT_EQ(sweep.runs().size(), 2u * 6u);
    EXPECT_EQ(sweep.reference_bounces(), (std::vector<int>{1, 2}));
    Reference reference;
    grow(reference, 128);
    std::vector<Measurement> found, expected;
    for (const SweepRun& run : sweep.runs()) {
        if (run.reference_bounces != 1) continue;
        const std::vector<Measurement> some = sweep.expected(run);
        expected.insert(expected.end(), some.begin(), some.end());
        EXPECT_TRUE(sweep.measure(
            *renderer_, run, reference, [] { return true; }, [&](const Measurement& m) { found.push_back(m); }));
    }
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        const Measurement& m = found[i];
        EXPECT_EQ(m.setting, expected[i].setting);
        EXPECT_EQ(m.varied, expected[i].varied);
        EXPECT_EQ(m.seed, expected[i].seed);
        EXPECT_GT(m.seconds, 0.0);
        EXPECT_GT(m.rmse_over_mean, m.noise_rmse_over_mean);
        EXPECT_GT(m.relative_mse, 0.0);
        EXPECT_LT(std::abs(m.bias), 0.5);
        EXPECT_GT(m.flip, 0.0);
        EXPECT_LT(m.flip, 1.0);
        EXPECT_EQ(m.reference_samples, 128);
    }
    // Without blur farfield is the reference's estimate; one accumulation gave both.
    const auto measured = [&](Varied varied, Method method, int levels) {
        return std::ranges::find_if(found, [&](const Measurement& m) {
            return m.varied == varied && m.setting.method == method && m.setting.blur_levels == levels;
        });
    };
    const auto unfiltered = measured(Varied::blur_levels, Method::farfield, 0),
               raw = measured(Varied::none, Method::reference, 0);
    ASSERT_TRUE(unfiltered != found.end() && raw != found.end());
    EXPECT_NEAR(unfiltered->rmse_over_mean, raw->rmse_over_mean, 1e-3 * raw->rmse_over_mean);

    // The same again, bit for bit, but for the time.
    std::vector<Measurement> again;
    EXPECT_TRUE(sweep.measure(
        *renderer_, sweep.runs()[0], reference, [] { return true; },
        [&](const Measurement& m) { again.push_back(m); }));
    for (std::size_t i = 0; i < again.size(); ++i) EXPECT_EQ(again[i].rmse_over_mean, found[i].rmse_over_mean);

    int frames = 0;
    again.clear();
    EXPECT_FALSE(sweep.measure(
        *renderer_, sweep.runs()[0], reference, [&] { return ++frames < 2; },
        [&](const Measurement& m) { again.push_back(m); }));
    EXPECT_EQ(again.size(), sweep.runs()[0].readings.size()) << "what the first frame gave";
}

TEST_F(Charts, ALongerMinimumStepTakesFewerEvaluationsAndIsLessExact) {
    // What the Cornell room is made of is met in closed form, without steps.
    const Scene scene = load_scene(std::filesystem::path(FARFIELD_SCENES) / "csg_part.json");
    std::vector<std::uint64_t> evaluations;
    std::vector<Image> images;
    for (const float step : {1.0f, 16.0f, 256.0f}) {
        renderer_->update(scene, {.size = size, .samples = 8, .counting = true, .minimum_step = step});
        renderer_->render_frame();
        evaluations.push_back(renderer_->statistics().evaluations);
        images.push_back(renderer_->read(View::depth));
    }
    EXPECT_LT(evaluations[1], evaluations[0]);
    EXPECT_LT(evaluations[2], evaluations[1]);
    EXPECT_LT(compare(images[0], images[1]).rmse, compare(images[0], images[2]).rmse);
}

Measurement measured(Method method, int samples, std::uint32_t seed, double seconds, double error, double noise) {
    Measurement m;
    m.setting.method = method;
    m.setting.samples = samples;
    m.seed = seed;
    m.seconds = seconds;
    m.rmse_over_mean = error;
    m.noise_rmse_over_mean = noise;
    return m;
}

TEST(ChartStatistics, MediansFrontsAndInterpolationAgreeWithHand) {
    const auto paper = Method::paper, farfield = Method::farfield;
    const std::vector<Measurement> measurements{
        measured(farfield, 4, 1, 1.0, 0.5, 0.3), measured(farfield, 4, 2, 3.0, 1.3, 0.5),
        measured(farfield, 4, 3, 2.0, 0.1, 0.2), measured(farfield, 16, 1, 8.0, 0.1, 0.0),
        measured(paper, 4, 1, 2.5, 0.9, 0.0),    measured(paper, 16, 1, 4.0, 0.2, 0.0)};
    EXPECT_DOUBLE_EQ(true_error(measurements[0]), 0.4);
    EXPECT_DOUBLE_EQ(true_error(measurements[2]), 0.0);
    const std::vector<ChartPoint> points = chart_points(measurements);
    ASSERT_EQ(points.size(), 4u);
    EXPECT_EQ(points[0].seeds, 3);
    EXPECT_DOUBLE_EQ(points[0].seconds, 2.0);
    EXPECT_DOUBLE_EQ(points[0].error, 0.4);
    EXPECT_DOUBLE_EQ(points[0].low, 0.0);
    EXPECT_NEAR(points[0].high, 1.2, 1e-12);

    const std::vector<ChartPoint> front = pareto_front(points);
    ASSERT_EQ(front.size(), 3u) << "paper with 4 samples is slower and worse than farfield with 4";
    EXPECT_EQ(front[1].setting.method, paper);
    EXPECT_EQ(front[2].setting.samples, 16);

    const std::vector<ChartPoint> line = curve(points, farfield);
    ASSERT_EQ(line.size(), 2u);
    EXPECT_NEAR(*error_at(line, 4.0), 0.2, 1e-12) << "half way from 2 to 8 and from 0.4 to 0.1";
    EXPECT_FALSE(error_at(line, 1.9));
    EXPECT_FALSE(error_at(line, 8.1));
    EXPECT_NEAR(*seconds_for(line, 0.2), 4.0, 1e-12);
    EXPECT_DOUBLE_EQ(*seconds_for(line, 1.0), 2.0);
    EXPECT_FALSE(seconds_for(line, 0.05));

    const std::vector<ChartPoint> means =
        mean_points({{measured(paper, 4, 1, 1.0, 0.1, 0.0)},
                     {measured(paper, 4, 1, 4.0, 0.4, 0.0), measured(paper, 16, 1, 1.0, 1.0, 0.0)}});
    ASSERT_EQ(means.size(), 1u) << "what every scene has";
    EXPECT_NEAR(means[0].seconds, 2.0, 1e-12);
    EXPECT_NEAR(means[0].error, 0.2, 1e-12);
}

ChartLine line_of(const std::string& scene, int samples) {
    ChartLine line;
    line.scene = scene;
    line.hash = "0123456789ab";
    line.device = "a device, \"software\"";
    line.size = {8, 4};
    line.measurement = measured(Method::paper, samples, 3, 0.1, 1.0 / 3.0, 0.0);
    line.measurement.varied = Varied::ao_radius;
    line.measurement.setting.ao_radius = 0.1f;
    line.measurement.bias = -0.25;
    line.measurement.reference_samples = 64;
    return line;
}

TEST(ChartTable, LinesComeBackExactlyAndBrokenOnesAreLeftOut) {
    const TemporaryFolder folder;
    const auto file = folder / "chart.csv";
    ChartTable table(file);
    table.add(line_of("a, \"b\"", 4));
    table.add(line_of("c", 16));
    const ChartTable again(file);
    EXPECT_TRUE(again.problems().empty());
    const ChartLine* found = again.find(line_of("a, \"b\"", 4));
    ASSERT_TRUE(found);
    EXPECT_EQ(found->measurement.rmse_over_mean, 1.0 / 3.0);
    EXPECT_EQ(found->measurement.setting.ao_radius, 0.1f);
    EXPECT_EQ(found->measurement.bias, -0.25);
    EXPECT_FALSE(again.find(line_of("c", 4)));
    ChartLine more = line_of("c", 16);
    more.measurement.reference_samples = 65;
    EXPECT_FALSE(again.find(more)) << "against a better reference it is measured anew";

    const std::string text = read_text(file), whole = text.substr(0, text.size() - 1);
    const std::string last = whole.substr(whole.rfind('\n') + 1);
    for (const std::string& broken : {last.substr(0, last.size() / 2), std::string("nonsense"),
                                      "nan" + last.substr(last.rfind(',')), last + ",1", [&] {
                                          std::string negative = last;
                                          return negative.replace(negative.find(",0.1,0.333"), 5, ",-0.1,");
                                      }()}) {
        write_text(file, text + broken);
        ChartTable torn(file);
        EXPECT_EQ(torn.problems().size(), 1u) << broken;
        EXPECT_TRUE(torn.find(line_of("c", 16)));
        torn.add(line_of("d", 4));
        EXPECT_TRUE(ChartTable(file).find(line_of("d", 4))) << "after a torn line a new one begins";
    }
    write_text(file, "another,table\n1,2\n");
    EXPECT_THROW(ChartTable{file}, ImageError);
    EXPECT_EQ(read_text(file), "another,table\n1,2\n");
}

class ChartCommand : public testing::Test {
protected:
    std::string quoted(const char* name) const { return fmt::format("'{}'", (folder_ / name).string()); }
    std::string arguments(const char* plan = "--seeds 2 --samples 4,8 --vary blur_levels") const {
        return fmt::format("chart {} -o {} --references {} --size 32x32 --reference-samples 64 {}", quoted("room.json"),
                           quoted("out"), quoted("references"), plan);
    }
    Outcome chart() const { return farfield_command(arguments()); }
    std::string csv() const { return read_text(folder_ / "out/chart.csv"); }
    void SetUp() override {
        write_text(folder_ / "room.json", read_text(std::filesystem::path(FARFIELD_SCENES) / "cornell.json"));
    }
    static constexpr std::ptrdiff_t lines =
        1 + 2 * 2 * (3 + 2 * 5);  // seeds x samples x (methods + blur levels of two)
    TemporaryFolder folder_;
};

TEST_F(ChartCommand, WritesTableAndPicturesAndGoesOnWhereItStopped) {
    const Outcome first = chart();
    ASSERT_EQ(first.status, 0) << first.output;
    EXPECT_EQ(first.output, "");
    const std::string all = csv();
    EXPECT_EQ(std::ranges::count(all, '\n'), lines);
    EXPECT_TRUE(all.starts_with(chart_columns() + "\n"));
    EXPECT_TRUE(ChartTable(folder_ / "out/chart.csv").problems().empty());
    const Image picture = read_image(folder_ / "out/chart.png");
    EXPECT_GT(picture.size.x, 400);
    EXPECT_GT(*std::ranges::max_element(picture.pixels) - *std::ranges::min_element(picture.pixels), 0.5f);
    EXPECT_NE(read_text(folder_ / "out/chart.svg").find("farfield"), std::string::npos);
    const std::string tables = read_text(folder_ / "out/tables.md");
    for (const char* text : {"## Equal samples", "## Equal time", "## Equal error", "| room | farfield |"})
        EXPECT_NE(tables.find(text), std::string::npos) << text;

    ASSERT_EQ(chart().status, 0);
    EXPECT_EQ(csv(), all) << "nothing was missing";

    // Half of the lines and a torn one: only what is missing is measured, the same as before but for the time.
    const std::size_t half = all.find('\n', all.size() / 2) + 1;
    write_text(folder_ / "out/chart.csv", all.substr(0, half) + "room,12");
    const Outcome resumed = chart();
    ASSERT_EQ(resumed.status, 0) << resumed.output;
    EXPECT_NE(resumed.output.find("no measurement, left out"), std::string::npos) << resumed.output;
    EXPECT_TRUE(csv().starts_with(all.substr(0, half)));
    EXPECT_EQ(std::ranges::count(csv(), '\n'), lines + 1);

    // A view setting leaves the reference as it is; the measurements are new.
    write_text(folder_ / "out/chart.csv", all);
    std::string text = read_text(folder_ / "room.json");
    text.replace(text.find("\"ao_radius\": 0.6"), 16, "\"ao_radius\": 0.7");
    write_text(folder_ / "room.json", text);
    ASSERT_EQ(chart().status, 0);
    EXPECT_TRUE(csv().starts_with(all));
    EXPECT_EQ(std::ranges::count(csv(), '\n'), 2 * lines - 1);
    EXPECT_EQ(std::ranges::distance(std::filesystem::directory_iterator(folder_ / "references")), 1);
}

TEST_F(ChartCommand, AnInterruptedRunLeavesAValidTable) {
    // Many samples, so that it is at work for long; stopped as soon as there is a line.
    const std::string script = fmt::format(
        "exec 2>&1; '{}' {} & p=$!; while [ ! -s {}/chart.csv ] && kill -0 $p; do sleep 0.05; done; "
        "kill -TERM $p; wait $p; echo \"status $?\"",
        FARFIELD_PROGRAM, arguments("--seeds 1 --samples 4,100000 --vary none"), quoted("out"));
    FILE* pipe = popen(script.c_str(), "r");
    ASSERT_TRUE(pipe);
    std::string output;
    std::array<char, 4096> buffer{};
    while (const std::size_t n = fread(buffer.data(), 1, buffer.size(), pipe)) output.append(buffer.data(), n);
    pclose(pipe);
    EXPECT_NE(output.find("status 1"), std::string::npos) << output;
    EXPECT_NE(output.find("interrupted: "), std::string::npos) << output;
    EXPECT_TRUE(ChartTable(folder_ / "out/chart.csv").problems().empty());
    EXPECT_EQ(std::ranges::count(csv(), '\n'), 1 + 3) << "4 samples of each method";
}

TEST_F(ChartCommand, WithoutGnuplotTheNumbersAreThere) {
    const std::string before = fmt::format("PATH={}; ", quoted("."));
    const Outcome outcome = farfield_command(arguments("--vary none --seeds 1 --samples 4,8"), before.c_str());
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.output.find("gnuplot, which draws the chart, is not installed"), std::string::npos)
        << outcome.output;
    EXPECT_EQ(std::ranges::count(csv(), '\n'), 1 + 2 * 3);
    for (const char* file : {"out/chart.gp", "out/tables.md"}) EXPECT_FALSE(read_text(folder_ / file).empty()) << file;
}

TEST_F(ChartCommand, WrongUseAndWrongInputExitWithTwo) {
    write_text(folder_ / "broken.json", "{\n  \"farfield\": 1,\n  \"root\": {\"kind\": \"blob\"}\n}\n");
    write_text(folder_ / "black.json", "{\"farfield\": 1, \"root\": {\"kind\": \"union\"}}");
    for (const std::string& more :
         {quoted("broken.json"), quoted("room.json"), std::string("--samples 0"), std::string("--samples 4,x"),
          std::string("--samples nan"), std::string("--samples -4"), std::string("--seeds 0"),
          std::string("--vary colour"), std::string("--reference-samples 1"), std::string("--reference-samples 1e9"),
          std::string("--size 0x0")}) {
        const Outcome outcome =
            farfield_command(fmt::format("chart {} -o {} {}", quoted("room.json"), quoted("out"), more));
        EXPECT_EQ(outcome.status, 2) << more << "\n" << outcome.output;
        EXPECT_FALSE(outcome.output.empty()) << more;
    }
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out")) << "nothing is made before everything is known to be right";
    const Outcome black =
        farfield_command(fmt::format("chart {} -o {} --references {} --size 8x8 --reference-samples 16",
                                     quoted("black.json"), quoted("out"), quoted("references")));
    EXPECT_EQ(black.status, 2);
    EXPECT_NE(black.output.find("black: no indirect light is seen"), std::string::npos) << black.output;
    EXPECT_EQ(farfield_command("chart").status, 2);
    const Outcome help = farfield_command("chart --help");
    EXPECT_EQ(help.status, 0);
    for (const char* word : {"--samples", "--seeds", "--reference-samples", "--references", "--vary", "rmse_over_mean"})
        EXPECT_NE(help.output.find(word), std::string::npos) << word;
    write_text(folder_ / "file", "");
    const Outcome impossible = farfield_command(fmt::format("chart {} -o {}", quoted("room.json"), quoted("file/sub")));
    EXPECT_EQ(impossible.status, 1);
    EXPECT_NE(impossible.output.find("cannot be made"), std::string::npos) << impossible.output;
}

}  // namespace
}  // namespace farfield
