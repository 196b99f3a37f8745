// Where estimates of light fail: leaks through walls, fireflies, bias of filters, errors that stop falling.
#include "renderer/metrics.h"
#include "tests/stability/case.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace farfield::stability {
namespace {

constexpr FrameOptions small{.size = {48, 48}};

FrameOptions seeded(std::uint32_t seed) {
    FrameOptions options = small;
    options.seed = seed;
    return options;
}

/// What indirect light tends to, of so many samples of another seed.
Image truth_of(Stage& stage, const Scene& scene, int samples) {
    constexpr int most = 64;
    return stage.render(scene, seeded(99), most, samples / most).indirect(Method::reference);
}

/// Two rooms of one floor, a lamp in the left one, a wall between them `pixels` wide, seen from above: see
/// Farfield.NothingLeaksAcrossAThinWall. Light on the dark side / light on the bright side at 4 samples.
Figures wall_leak(Stage& stage, const Point& p) {
    Built scene;
    scene.add(make_node(NodeKind::plane));
    constexpr float metres_per_pixel = 3.7f / 64.0f;
    const float pixels = static_cast<float>(p.value);
    scene.add(box({0.5f * pixels * metres_per_pixel, 1.0f, 2.0f}), {0.0f, 1.0f, 0.0f});
    for (const float side : {-1.0f, 1.0f}) {
        scene.add(box({0.05f, 1.0f, 2.0f}), {2.0f * side, 1.0f, 0.0f});
        scene.add(box({2.0f, 1.0f, 0.05f}), {0.0f, 1.0f, 2.0f * side});
    }
    scene.add_point_light({-1.0f, 0.8f, 0.0f}, glm::vec3(3.0f));
    scene.look({0.0f, 8.0f, 0.01f}, glm::vec3(0.0f), 26.0f);
    scene.settings.blur_levels = 4;
    const Pictures pictures = stage.render(scene, {.size = {64, 64}}, 4);
    Figures figures;
    // The wall's top is nearer to the camera and looks 8 / 6 as thick.
    const int beside = 32 + static_cast<int>(std::ceil(0.5f * pixels * 8.0f / 6.0f));
    for (const Method m : methods) {
        const Image& image = pictures.result[static_cast<std::size_t>(m)];
        const auto columns = [&](int first, int last) {
            double sum = 0.0;
            for (int y = 16; y < 48; ++y)
                for (int x = first; x < last; ++x) sum += image.pixels[static_cast<std::size_t>(3 * (64 * y + x))];
            return sum / (32.0 * (last - first));
        };
        figures[m] = columns(beside, 56) / columns(8, 24);
    }
    return figures;
}

/// A closed grey room of 2 m with one small bright panel in the ceiling, whose area times radiance is constant.
Built panel_room(double side) {
    Built scene;
    const Id room = scene.add(make_node(NodeKind::subtract));
    scene.add(box(glm::vec3(1.2f)), {}, room);
    scene.add(box(glm::vec3(1.0f)), {}, room);
    const float half = 0.5f * static_cast<float>(side);
    Node panel = box({half, 0.01f, half});
    panel.material = scene.add_material(glm::vec3(0.0f), glm::vec3(1.0f / (4.0f * half * half)));
    scene.add(panel, {0.3f, 0.99f, 0.2f});
    scene.add(box({0.3f, 0.4f, 0.3f}), {-0.3f, -0.6f, -0.3f});
    scene.materials[0].albedo = glm::vec3(0.5f);
    scene.settings.blur_levels = 3;
    scene.look({0.0f, 0.0f, 0.95f}, {0.0f, -0.5f, -1.0f}, 50.0f);
    return scene;
}

/// The same room, lit by a bright sky through a crack in its ceiling.
Built crack_room(double width) {
    Built scene;
    const Id room = scene.add(make_node(NodeKind::subtract));
    scene.add(box(glm::vec3(1.2f)), {}, room);
    scene.add(box(glm::vec3(1.0f)), {}, room);
    scene.add(box({0.5f * static_cast<float>(width), 0.3f, 0.5f}), {0.3f, 1.1f, 0.0f}, room);
    scene.set_sky(static_cast<float>(1.0 / width));
    scene.materials[0].albedo = glm::vec3(0.5f);
    scene.settings.blur_levels = 3;
    scene.look({0.0f, 0.0f, 0.95f}, {0.0f, -0.5f, -1.0f}, 50.0f);
    return scene;
}

/// Pictures at 16 samples of several seeds against what indirect light tends to.
struct Fireflies {
    std::array<double, 3> bias{};        ///< of the mean over all seeds, relative, without its own standard error
    std::array<double, 3> percentile{};  ///< 99.9 % of the absolute errors of pixels are below that, over the mean
};

const Fireflies& fireflies(Stage& stage, const Scene& scene, const std::string& key) {
    static std::map<std::string, Fireflies> kept;  // for the cases that look at two sides of the same pictures
    const auto [at, fresh] = kept.try_emplace(key);
    if (!fresh) return at->second;
    constexpr int seeds = 12, truth_samples = 4096;
    const Image truth = truth_of(stage, scene, truth_samples);
    const double level = mean(truth);
    std::array<std::vector<double>, 3> means, errors;
    for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
        const Pictures pictures = stage.render(scene, seeded(seed), 16);
        for (const Method m : methods) {
            const std::size_t i = static_cast<std::size_t>(m);
            const Image image = pictures.indirect(m);
            means[i].push_back(mean(image));
            for (std::size_t k = 0; k < image.pixels.size(); k += 3)
                errors[i].push_back(std::abs(image.pixels[k] - truth.pixels[k]) / level);
        }
    }
    for (std::size_t i = 0; i < 3; ++i) {
        double sum = 0.0, squares = 0.0;
        for (const double v : means[i]) sum += v, squares += v * v;
        const double middle = sum / seeds, variance = std::max(squares / seeds - middle * middle, 0.0) / (seeds - 1);
        at->second.bias[i] = std::max(std::abs(middle - level) - 2.0 * std::sqrt(variance), 0.0) / level;
        auto rank = errors[i].begin() + static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(errors[i].size()));
        std::nth_element(errors[i].begin(), rank, errors[i].end());
        at->second.percentile[i] = *rank;
    }
    return at->second;
}

Figures firefly_bias(Stage& stage, const Scene& scene, const std::string& key) {
    const auto& b = fireflies(stage, scene, key).bias;
    return {{b[0], b[1], b[2]}, ""};
}

/// Over that of the reference at the same samples, which takes what paths find as it is.
Figures firefly_size(Stage& stage, const Scene& scene, const std::string& key) {
    const auto& p = fireflies(stage, scene, key).percentile;
    return {{p[0] / p[2], p[1] / p[2], 1.0}, ""};
}

/// Two rooms with a door ajar between them; the camera is in the one without a lamp.
Built door_ajar() {
    Built scene;
    const Id rooms = scene.add(make_node(NodeKind::subtract));
    scene.add(box({2.2f, 1.2f, 1.2f}), {}, rooms);
    scene.add(box({0.95f, 1.0f, 1.0f}), {-1.05f, 0.0f, 0.0f}, rooms);
    scene.add(box({0.95f, 1.0f, 1.0f}), {1.05f, 0.0f, 0.0f}, rooms);
    scene.add(box({0.2f, 0.8f, 0.06f}), {0.0f, -0.2f, 0.3f}, rooms);  // the gap
    scene.materials[0].albedo = glm::vec3(0.7f);
    scene.add_point_light({1.2f, 0.5f, -0.3f}, glm::vec3(5.0f));
    scene.settings.bounces = 3;
    scene.settings.ao_radius = 0.4f;
    scene.look({-1.8f, 0.1f, -0.5f}, {0.0f, -0.3f, 0.5f}, 60.0f);
    return scene;
}

const Image& kept_truth(Stage& stage, const Scene& scene, const std::string& key) {
    static std::map<std::string, Image> kept;
    const auto [at, fresh] = kept.try_emplace(key);
    if (fresh) at->second = truth_of(stage, scene, 4096);
    return at->second;
}

constexpr int door_seeds = 2;

/// RMSE / mean of indirect light, the median of two seeds' mean square.
std::array<double, 3> errors(Stage& stage, const Scene& scene, const Image& truth, int samples) {
    std::array<double, 3> squares{};
    for (std::uint32_t seed = 1; seed <= door_seeds; ++seed) {
        const int each = std::min(samples, 64);
        const Pictures pictures = stage.render(scene, seeded(seed), each, samples / each);
        for (const Method m : methods)
            squares[static_cast<std::size_t>(m)] += std::pow(measure(pictures.indirect(m), truth).rmse_over_mean, 2);
    }
    for (double& v : squares) v = std::sqrt(v / door_seeds);
    return squares;
}

Figures door_error(Stage& stage, const Point& p) {
    const Built scene = door_ajar();
    const auto e = errors(stage, scene, kept_truth(stage, scene, "door"), static_cast<int>(p.value));
    return {{e[0] / e[2], e[1] / e[2], 1.0}, ""};
}

/// Error times the root of the samples over that of the reference at 4 samples: 1 is the Monte-Carlo rate.
Figures plateau(Stage& stage, const Point& p) {
    const Built scene = door_ajar();
    const Image& truth = kept_truth(stage, scene, "door");
    static const double first = errors(stage, scene, truth, 4)[2];
    const auto e = errors(stage, scene, truth, static_cast<int>(p.value));
    const double rate = std::sqrt(p.value / 4.0) / first;
    return {{e[0] * rate, e[1] * rate, e[2] * rate}, ""};
}

/// |bias| of indirect light at 64 samples, by AO radius or by samples, less two standard errors of its own noise.
Figures mean_bias(Stage& stage, const Scene& scene, int samples, int seeds) {
    const Image& truth = kept_truth(stage, scene, "door");
    const double level = mean(truth);
    std::array<std::vector<double>, 3> found;
    for (std::uint32_t seed = 1; seed <= static_cast<std::uint32_t>(seeds); ++seed) {
        const Pictures pictures = stage.render(scene, seeded(seed), samples);
        for (const Method m : methods)
            found[static_cast<std::size_t>(m)].push_back(mean(pictures.indirect(m)) / level - 1.0);
    }
    Figures figures;
    for (const Method m : methods) {
        const auto& values = found[static_cast<std::size_t>(m)];
        double sum = 0.0, squares = 0.0;
        for (const double v : values) sum += v, squares += v * v;
        const double n = static_cast<double>(values.size()), middle = sum / n;
        const double standard = std::sqrt(std::max(squares / n - middle * middle, 0.0) / (n - 1.0));
        figures[m] = std::max(std::abs(middle) - 2.0 * standard, 0.0);
    }
    return figures;
}

Figures radius_bias(Stage& stage, const Point& p) {
    Built scene = door_ajar();
    scene.settings.ao_radius = static_cast<float>(p.value);
    return mean_bias(stage, scene, 64, 4);
}

Figures sample_bias(Stage& stage, const Point& p) {
    const int samples = static_cast<int>(p.value);
    return mean_bias(stage, door_ajar(), samples, std::clamp(256 / samples, 4, 32));
}

}  // namespace

std::vector<Case> light_cases() {
    const auto with_panel = [](auto figure) {
        return [figure](Stage& s, const Point& p) {
            return figure(s, panel_room(p.value), "panel" + std::to_string(p.value));
        };
    };
    const auto with_crack = [](auto figure) {
        return [figure](Stage& s, const Point& p) {
            return figure(s, crack_room(p.value), "crack" + std::to_string(p.value));
        };
    };
    const char* bias = "|bias| of indirect light beyond two standard errors";
    const char* percentile = "99.9th percentile of pixels' errors / that of the reference";
    const std::string rare = "small emitter at equal power: fireflies";
    const std::string cracks = "bright sky through a crack: fireflies";
    return {{"wall-in-pixels",
             "bright and dark room: the filter leaks",
             "thickness of the wall, pixels",
             {0.5, 1, 2, 4, 8},
             "light on the dark side / on the bright side, 4 samples",
             wall_leak,
             at_most(0.02),
             true},
            {"emitter-bias",
             rare,
             "side of the emitter, m",
             {0.4, 0.2, 0.1, 0.05},
             bias,
             with_panel(firefly_bias),
             at_most(0.01)},
            {"emitter-fireflies",
             rare,
             "side of the emitter, m",
             {0.4, 0.2, 0.1, 0.05},
             percentile,
             with_panel(firefly_size),
             at_most(1.0)},
            {"crack-bias",
             cracks,
             "width of the crack, m",
             {0.2, 0.1, 0.05, 0.02},
             bias,
             with_crack(firefly_bias),
             at_most(0.01)},
            {"crack-fireflies",
             cracks,
             "width of the crack, m",
             {0.2, 0.1, 0.05, 0.02},
             percentile,
             with_crack(firefly_size),
             at_most(1.0)},
            {"door-ajar",
             "dark room, door ajar: hard visibility",
             "samples",
             {4, 16, 64, 256},
             "RMSE of indirect light / that of the reference at equal samples",
             door_error,
             at_most(1.0)},
            {"many-samples",
             "many samples: the error stops falling",
             "samples",
             {4, 16, 64, 256, 1024},
             "RMSE x √samples / that of the reference at 4 samples",
             plateau,
             at_most(1.3)},
            {"ao-radius",
             "AO radius: near light counted twice or not at all",
             "AO radius, m",
             {0.05, 0.1, 0.2, 0.5, 1, 2, 10},
             "|bias| of indirect light beyond two standard errors, 64 samples",
             radius_bias,
             at_most(0.01)},
            {"samples-bias",
             "few samples: a ratio of estimates is biased",
             "samples",
             {1, 2, 4, 16, 64},
             bias,
             sample_bias,
             at_most(0.01)}};
}

}  // namespace farfield::stability
