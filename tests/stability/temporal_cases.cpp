// What is left of the past: samples of an old scene, and how much a picture flickers when it begins anew with every
// frame.
#include "renderer/metrics.h"
#include "tests/stability/case.h"

#include <fmt/format.h>
#include <glm/trigonometric.hpp>

#include <cmath>

namespace farfield::stability {
namespace {

constexpr FrameOptions small{.size = {48, 48}};

Built room() {
    Built scene;
    const Id walls = scene.add(make_node(NodeKind::subtract));
    scene.add(box({1.6f, 1.2f, 1.6f}), {}, walls);
    scene.add(box({1.5f, 1.1f, 1.5f}), {}, walls);
    Node block = box({0.3f, 0.6f, 0.3f});
    block.transform.rotate.y = 20.0f;
    block.material = scene.add_material({0.7f, 0.2f, 0.1f});
    scene.add(block, {-0.5f, -0.5f, -0.3f});
    scene.add(sphere(0.4f), {0.6f, -0.7f, 0.2f});
    scene.add_point_light({0.2f, 0.9f, 0.3f}, glm::vec3(4.0f));
    scene.materials[0].albedo = glm::vec3(0.6f);
    scene.settings.bounces = 2;
    scene.look({0.2f, 0.1f, 1.4f}, {0.0f, -0.2f, -1.0f}, 60.0f);
    return scene;
}

ObjectRef block(const Scene& scene) { return {ObjectType::node, scene.root.children[1].id}; }

struct Change {
    const char* name;
    void (*make)(Scene& scene);
    Tier tier = Tier::specialised;
    bool within_frame = false;  ///< it comes while a frame is being rendered
    bool reprojects = false;    ///< the past counts for seven pictures
};

const Change changes[] = {
    {"camera moves", [](Scene& s) { s.camera.position.x += 0.05f; }, Tier::specialised, false, true},
    {"camera moves within a frame", [](Scene& s) { s.camera.position.x += 0.05f; }, Tier::specialised, true, true},
    {"camera turns a hair", [](Scene& s) { s.camera.target.x += 1e-4f; }, Tier::specialised, false, true},
    {"camera and a node move",
     [](Scene& s) {
         s.camera.position.x += 0.05f;
         apply(s, SetValue{block(s), "translate", {0.5f, -0.5f, -0.3f}});
     }},
    {"a node moves",
     [](Scene& s) {
         apply(s, SetValue{block(s), "translate", {0.5f, -0.5f, -0.3f}});
     }},
    {"a node moves within a frame",
     [](Scene& s) {
         apply(s, SetValue{block(s), "translate", {0.5f, -0.5f, -0.3f}});
     },
     Tier::live, true},
    {"a node is deleted", [](Scene& s) { apply(s, RemoveNode{block(s).id}); }},
    {"a node is hidden",
     [](Scene& s) {
         apply(s, SetHidden{block(s).id, true});
     },
     Tier::live},
    {"a material changes",
     [](Scene& s) {
         s.materials[1].albedo = {0.1f, 0.2f, 0.7f};
     }},
    {"a lamp moves", [](Scene& s) { s.lights[0].position.x -= 0.5f; }},
    {"a lamp goes out within a frame", [](Scene& s) { apply(s, RemoveLight{s.lights[0].id}); }, Tier::live, true},
    {"the sky changes", [](Scene& s) { s.sky.zenith = glm::vec3(1.0f); }},
    {"more bounces", [](Scene& s) { s.settings.bounces = 4; }},
};

std::vector<Point> change_points() {
    std::vector<Point> points;
    for (const Change& c : changes) points.emplace_back(static_cast<double>(points.size()), c.name);
    return points;
}

/// Values of the picture after the change that differ from those of a renderer that has never seen anything else; of
/// one that reprojects once the past counts no more.
Figures survivors(Stage& stage, const Change& change) {
    FrameOptions options = small;
    options.tier = change.tier;
    options.occlusion = true;
    options.batch = 512;
    options.reprojection = true;
    Built before = room();
    before.settings.samples = 2;
    Scene after = before;
    change.make(after);
    const auto frames = [&](Renderer& renderer) {
        renderer.update(after, options);
        while (renderer.statistics().frames < (change.reprojects ? Reprojection::pictures : 2)) renderer.render_frame();
    };
    Renderer& renderer = stage.renderer();
    renderer.update(before, options);
    renderer.discard();
    for (int i = 0; i < 3; ++i) renderer.render_frame();
    stage.read(before, options, Method::farfield, View::result);
    for (int i = 0; change.within_frame && i < 7; ++i) renderer.step();
    frames(renderer);
    std::array<std::vector<Image>, 3> found;
    const View shown[] = {View::result, View::coarse, View::occlusion, View::depth};
    for (const Method m : methods)
        for (const View view : shown) found[static_cast<std::size_t>(m)].push_back(stage.read(after, options, m, view));
    Figures figures;
    {
        Stage fresh;
        options.seed = change.reprojects ? 1 : 0;  // each picture of a moving camera takes other samples
        frames(fresh.renderer());
        for (const Method m : methods) {
            int differing = 0;
            for (std::size_t v = 0; v < std::size(shown); ++v) {
                const Image truth = fresh.read(after, options, m, shown[v]);
                const Image& image = found[static_cast<std::size_t>(m)][v];
                for (std::size_t i = 0; i < truth.pixels.size(); ++i) differing += truth.pixels[i] != image.pixels[i];
            }
            figures[m] = differing;
        }
    }
    stage.make_current();
    return figures;
}

/// Standard deviation of a pixel's indirect light from one first picture to the next, over the mean of all.
std::array<double, 3> flicker(Stage& stage, int samples) {
    constexpr int seeds = 6;
    const Built scene = room();
    std::array<std::vector<double>, 3> sums, squares;
    for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
        FrameOptions options = small;
        options.seed = seed;
        const Pictures pictures = stage.render(scene, options, samples);
        for (const Method m : methods) {
            const Image image = pictures.indirect(m);
            auto &sum = sums[static_cast<std::size_t>(m)], &square = squares[static_cast<std::size_t>(m)];
            sum.resize(image.pixels.size()), square.resize(image.pixels.size());
            for (std::size_t i = 0; i < image.pixels.size(); ++i) {
                sum[i] += image.pixels[i];
                square[i] += static_cast<double>(image.pixels[i]) * image.pixels[i];
            }
        }
    }
    std::array<double, 3> result{};
    for (std::size_t m = 0; m < 3; ++m) {
        double variance = 0.0, level = 0.0;
        for (std::size_t i = 0; i < sums[m].size(); ++i) {
            const double middle = sums[m][i] / seeds;
            variance += std::max(squares[m][i] / seeds - middle * middle, 0.0) * seeds / (seeds - 1);
            level += middle;
        }
        const double n = static_cast<double>(sums[m].size());
        result[m] = std::sqrt(variance / n) / (level / n);
    }
    return result;
}

/// Over that of the reference with 16 times as many samples.
Figures flicker_of_few(Stage& stage, const Point& p) {
    const int samples = static_cast<int>(p.value);
    const auto few = flicker(stage, samples), many = flicker(stage, 16 * samples);
    return {{few[0] / many[2], few[1] / many[2], std::nullopt},
            fmt::format("{:.3g} of the mean in farfield, {:.3g} in the reference; with {} samples {:.3g} and {:.3g}",
                        few[1], few[2], 16 * samples, many[1], many[2])};
}

/// RMSE of farfield's indirect light in the first picture, of one sample, after eight moves of the camera around its
/// target by so many degrees, with the past over without; of the room.
Figures reprojection(Stage& stage, const Point& p) {
    constexpr int moves = 8, seeds = 6;
    constexpr float start = 10.0f;
    const auto from = [&](int move) {
        Built scene = room();
        const float angle = glm::radians(start + static_cast<float>(p.value * (moves - move)));
        scene.look({1.5f * std::sin(angle), 0.1f, 1.5f * std::cos(angle) - 1.0f}, {0.0f, -0.2f, -1.0f}, 60.0f);
        scene.settings.samples = 1;
        return scene;
    };
    FrameOptions options = small;
    const Image truth = stage.render(from(moves), options, 64, 16).indirect(Method::reference);
    std::array<double, 2> errors{};
    std::array<double, 2> shares{};
    for (std::uint32_t seed = 1; seed <= seeds; ++seed)
        for (const bool past : {false, true}) {
            options.seed = 100 * seed + (past ? 0 : moves);
            options.reprojection = past;
            stage.renderer().update(from(moves), options);
            stage.renderer().discard();
            Image image;
            for (int move = past ? 0 : moves; move <= moves; ++move) {
                stage.renderer().update(from(move), options);
                stage.renderer().render_frame();
                image = stage.renderer().read(View::result);
            }
            const Image direct = stage.renderer().read(View::direct);
            double sum = 0.0, mean = 0.0;
            for (std::size_t i = 0; i < image.pixels.size(); ++i) {
                const double off = image.pixels[i] - direct.pixels[i] - truth.pixels[i];
                sum += off * off;
                mean += off;
            }
            errors[past] += sum;
            shares[past] += mean;
        }
    double light = 0.0;
    for (const float v : truth.pixels) light += v;
    const double values = static_cast<double>(truth.pixels.size());
    const auto error = [&](std::size_t past) { return std::sqrt(errors[past] * values / seeds) / light; };
    return {{std::nullopt, std::sqrt(errors[1] / errors[0]), std::nullopt},
            fmt::format("RMSE / mean {:.3f}, without {:.3f}; mean off by {:.2g} %, without by {:.2g} %", error(1),
                        error(0), 100.0 * shares[1] / light / seeds, 100.0 * shares[0] / light / seeds)};
}

}  // namespace

std::vector<Case> temporal_cases() {
    return {{"ghosts", "camera moves, live edits: samples of the old scene", "change", change_points(),
             "values that differ from a renderer that knows the new scene alone",
             [](Stage& s, const Point& p) { return survivors(s, changes[static_cast<std::size_t>(p.value)]); },
             at_most(0.0)},
            {"flicker",
             "camera moves, live edits: flicker",
             "samples",
             {1, 4, 16},
             "deviation from picture to picture / that of the reference with 16 times the samples",
             flicker_of_few,
             at_most(1.0)},
            {"reprojection",
             "camera moves: what the last picture knew",
             "degrees a move",
             {0.03, 0.1, 0.3, 1, 3, 10},
             "error of indirect light with the past / without",
             reprojection,
             [](const Point& p) { return p.value <= 3.0 ? 0.8 : 1.0; },
             false,
             "A move of 3 degrees: the first picture of one sample came nearer to the truth when places and directions "
             "were made "
             "one sequence (0.170 to 0.135 of the mean), and what the past makes of it did not (0.11, as before), so "
             "the past is "
             "worth less. See the errors below."}};
}

}  // namespace farfield::stability
