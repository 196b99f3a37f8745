// Where estimates of light fail: leaks through walls, fireflies, bias of filters, errors that stop falling.
#include "renderer/metrics.h"
#include "sdf/pick.h"
#include "tests/stability/case.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace farfield::stability {
namespace {

constexpr FrameOptions small{.size = {48, 48}};

FrameOptions seeded(std::uint32_t seed, FrameOptions options = small) {
    options.seed = seed;
    return options;
}

/// What indirect light tends to, of so many samples of another seed.
Image truth_of(Stage& stage, const Scene& scene, int samples, const FrameOptions& options = small) {
    constexpr int most = 64;
    return stage.render(scene, seeded(99, options), most, samples / most).indirect(Method::reference);
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

/// A closed grey room of 2 m with one small bright panel just under the ceiling, whose area times radiance is constant.
struct PanelRoom {
    explicit PanelRoom(double side) : half(0.5f * static_cast<float>(side)), radiance(1.0f / (4.0f * half * half)) {
        const Id room = scene.add(make_node(NodeKind::subtract));
        scene.add(box(glm::vec3(1.2f)), {}, room);
        scene.add(box(glm::vec3(1.0f)), {}, room);
        Node panel = box({half, thickness, half});
        panel.material = scene.add_material(glm::vec3(0.0f), glm::vec3(radiance));
        scene.add(panel, centre);
        scene.materials[0].albedo = glm::vec3(albedo);
        scene.settings.blur_levels = 3;
        scene.look({0.0f, 0.0f, 0.95f}, {0.0f, -0.5f, -1.0f}, 50.0f);
    }

    /// Radiance / pi that reaches a surface: the panel's five faces by Lambert's formula for polygons (1760), which
    /// holds as long as all of each is above the surface.
    double light_at(glm::dvec3 p, glm::dvec3 normal) const {
        const glm::dvec3 h(half, thickness, half);
        double sum = 0.0;
        for (int face = 0; face < 5; ++face) {
            const int axis = face < 4 ? (face < 2 ? 0 : 2) : 1, u = (axis + 1) % 3, v = (axis + 2) % 3;
            glm::dvec3 middle(centre);
            middle[axis] += (face == 4 || face % 2 ? -1.0 : 1.0) * h[axis];
            if ((p[axis] - middle[axis]) * (middle[axis] - centre[axis]) <= 0.0) continue;  // turned away
            double form = 0.0;
            for (int i = 0; i < 4; ++i) {
                const auto corner = [&](int k) {
                    glm::dvec3 c = middle;
                    c[u] += (k % 4 == 0 || k % 4 == 3 ? -1.0 : 1.0) * h[u];
                    c[v] += (k % 4 < 2 ? -1.0 : 1.0) * h[v];
                    return glm::normalize(c - p);
                };
                const glm::dvec3 a = corner(i), b = corner(i + 1), across = glm::cross(a, b);
                const double length = glm::length(across);
                if (length > 0.0) form += std::atan2(length, glm::dot(a, b)) * glm::dot(across, normal) / length;
            }
            sum += std::abs(form) / (2.0 * std::numbers::pi);
        }
        return radiance * sum;
    }

    static constexpr float albedo = 0.5f, thickness = 0.002f;
    glm::vec3 centre{0.3f, 1.0f - thickness, 0.2f};
    float half, radiance;
    Built scene;
};

/// Indirect light of the panel room, exactly: at the middles of the pixels, where one frame looks.
Image exact(Stage& stage, const PanelRoom& room) {
    const Pictures pictures = stage.render(room.scene, small, 1);
    const Image normals = stage.read(room.scene, small, Method::reference, View::normals);
    const CameraBasis basis(room.scene.camera);
    Image image = normals;
    for (int y = 0; y < small.size.y; ++y)
        for (int x = 0; x < small.size.x; ++x) {
            const std::size_t i = 3 * static_cast<std::size_t>(y * small.size.x + x);
            const glm::vec2 at = (glm::vec2(x, y) + 0.5f) / glm::vec2(small.size);
            const glm::dvec3 p = glm::dvec3(room.scene.camera.position) +
                                 static_cast<double>(pictures.depth.pixels[i]) * glm::dvec3(basis.direction(at, 1.0f));
            const glm::dvec3 n(normals.pixels[i], normals.pixels[i + 1], normals.pixels[i + 2]);
            const double light = PanelRoom::albedo * room.light_at(p, glm::normalize(2.0 * n - 1.0));
            for (std::size_t c = 0; c < 3; ++c) image.pixels[i + c] = static_cast<float>(light);
        }
    return image;
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

struct Mean {
    double value = 0.0, standard_error = 0.0;
    /// How far it is from 0, less three standard errors.
    double beyond_noise() const { return std::max(std::abs(value) - 3.0 * standard_error, 0.0); }
};

Mean mean_of(const std::vector<double>& values) {
    double sum = 0.0, squares = 0.0;
    for (const double v : values) sum += v, squares += v * v;
    const double n = static_cast<double>(values.size()), middle = sum / n;
    return {middle, std::sqrt(std::max(squares / n - middle * middle, 0.0) / (n - 1.0))};
}

/// Means of pictures by seed. The reference's bias is against the truth, that of the others against the reference of
/// the same samples, whose noise they share.
struct Biases {
    std::array<std::vector<double>, 3> values;
    void add(const Pictures& pictures, double level) {
        const double raw = mean(pictures.indirect(Method::reference));
        for (const Method m : methods)
            values[static_cast<std::size_t>(m)].push_back(
                (m == Method::reference ? raw - level : mean(pictures.indirect(m)) - raw) / level);
    }
    Figures result() const {
        Figures figures;
        std::vector<std::string> notes;
        for (const Method m : methods) {
            const Mean found = mean_of(values[static_cast<std::size_t>(m)]);
            figures[m] = found.beyond_noise();
            notes.push_back(fmt::format("{} {:+.2f} ± {:.2f} %", method_names[static_cast<std::size_t>(m)],
                                        100.0 * found.value, 100.0 * found.standard_error));
        }
        figures.note = fmt::format("{}", fmt::join(notes, ", "));
        return figures;
    }
};

/// Pictures at 16 samples of several seeds against what indirect light tends to.
struct Fireflies {
    Figures bias;                        ///< see Biases
    std::array<double, 3> percentile{};  ///< 99.9 % of the absolute errors of pixels are below that, over the mean
};

Fireflies fireflies(Stage& stage, const Scene& scene, const Image& truth) {
    constexpr int seeds = 24;
    const double level = mean(truth);
    Fireflies result;
    Biases biases;
    std::array<std::vector<double>, 3> errors;
    for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
        const Pictures pictures = stage.render(scene, seeded(seed), 4, 4);  // as the editor does
        biases.add(pictures, level);
        for (const Method m : methods) {
            const Image image = pictures.indirect(m);
            for (std::size_t k = 0; k < image.pixels.size(); k += 3)
                errors[static_cast<std::size_t>(m)].push_back(std::abs(image.pixels[k] - truth.pixels[k]) / level);
        }
    }
    result.bias = biases.result();
    for (std::size_t i = 0; i < 3; ++i) {
        auto rank = errors[i].begin() + static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(errors[i].size()));
        std::nth_element(errors[i].begin(), rank, errors[i].end());
        result.percentile[i] = *rank;
    }
    return result;
}

/// The reference's own bias against the exact light; of more samples, because few of them find a small emitter.
Mean emitter_gain(Stage& stage, const Scene& scene, double level) {
    std::vector<double> found;
    for (std::uint32_t seed = 1; seed <= 8; ++seed)
        found.push_back(mean(stage.render(scene, seeded(seed), 64, 8).indirect(Method::reference)) / level - 1.0);
    return mean_of(found);
}

/// Kept for the two cases that look at the same pictures.
const Fireflies& of_panel(Stage& stage, const Point& p) {
    static std::map<double, Fireflies> kept;
    const auto [at, fresh] = kept.try_emplace(p.value);
    const PanelRoom room(p.value);
    if (fresh) {
        const Image truth = exact(stage, room);
        const Mean gain = emitter_gain(stage, room.scene, mean(truth));
        at->second = fireflies(stage, room.scene, truth);
        at->second.bias[Method::reference] = gain.beyond_noise();
        at->second.bias.note += fmt::format("; reference with 4,096 samples {:+.2f} ± {:.2f} %", 100.0 * gain.value,
                                            100.0 * gain.standard_error);
    }
    return at->second;
}

const Fireflies& of_crack(Stage& stage, const Point& p) {
    static std::map<double, Fireflies> kept;
    const auto [at, fresh] = kept.try_emplace(p.value);
    const Built room = crack_room(p.value);
    if (fresh) at->second = fireflies(stage, room, truth_of(stage, room, 4096));
    return at->second;
}

/// Over that of the reference at the same samples, which takes what paths find as it is.
Figures size_of(const Fireflies& f) {
    const auto& p = f.percentile;
    return {{p[0] / p[2], p[1] / p[2], 1.0}, fmt::format("{:.3g} times the mean in the reference", p[2])};
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

/// RMSE / mean of indirect light; the mean square over seeds, as many as make 512 samples or two.
std::array<double, 3> errors(Stage& stage, const Scene& scene, const Image& truth, int samples) {
    const int seeds = std::max(512 / samples, 2);
    std::array<double, 3> squares{};
    for (int seed = 1; seed <= seeds; ++seed) {
        // In frames of 4, whose rays pass pixels at different places: edges are as smooth as the truth's.
        const Pictures pictures = stage.render(scene, seeded(static_cast<std::uint32_t>(seed)), 4, samples / 4);
        for (const Method m : methods)
            squares[static_cast<std::size_t>(m)] += std::pow(measure(pictures.indirect(m), truth).rmse_over_mean, 2);
    }
    for (double& v : squares) v = std::sqrt(v / seeds);
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

/// Two rooms from eight views, because what few samples gain or lose in one is a matter of where its pixels lie on the
/// bright door, up to 2 % of the light in either direction; 96 pixels wide, so that the wavelet's coarsest steps fit.
Figures mean_bias(Stage& stage, float ao_radius, int samples, int pictures) {
    constexpr FrameOptions larger{.size = {96, 96}};
    constexpr std::uint32_t views = 8;
    static std::array<double, views> levels{};
    Biases biases;
    const int of_frame = std::min(samples, 4);  // see errors
    for (std::uint32_t seed = 0; seed < static_cast<std::uint32_t>(pictures); ++seed) {
        Built scene = door_ajar();
        const float aside = 0.05f * static_cast<float>(seed % views) - 0.2f;
        scene.look({-1.8f, 0.1f, -0.5f}, {aside, 0.7f * aside - 0.3f, 0.5f}, 60.0f);
        double& level = levels[seed % views];
        if (level == 0.0) level = mean(truth_of(stage, scene, 1024, larger));
        scene.settings.ao_radius = ao_radius;
        biases.add(stage.render(scene, seeded(seed, larger), of_frame, samples / of_frame), level);
    }
    return biases.result();
}

Figures radius_bias(Stage& stage, const Point& p) { return mean_bias(stage, static_cast<float>(p.value), 64, 8); }

Figures sample_bias(Stage& stage, const Point& p) {
    const int samples = static_cast<int>(p.value);
    return mean_bias(stage, door_ajar().settings.ao_radius, samples, std::clamp(512 / samples, 8, 64));
}

}  // namespace

std::vector<Case> light_cases() {
    const char* bias = "|bias| of indirect light beyond three standard errors";
    const char* percentile = "99.9th percentile of pixels' errors / that of the reference";
    const std::string rare = "small emitter at equal power: fireflies";
    const std::string cracks = "bright sky through a crack: fireflies";
    return {
        {"wall-in-pixels",
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
         [](Stage& s, const Point& p) { return of_panel(s, p).bias; },
         at_most(0.01)},
        {"emitter-fireflies",
         rare,
         "side of the emitter, m",
         {0.4, 0.2, 0.1, 0.05},
         percentile,
         [](Stage& s, const Point& p) { return size_of(of_panel(s, p)); },
         at_most(1.0)},
        {"crack-bias",
         cracks,
         "width of the crack, m",
         {0.2, 0.1, 0.05, 0.02},
         bias,
         [](Stage& s, const Point& p) { return of_crack(s, p).bias; },
         at_most(0.01),
         false,
         "With 16 samples single paths are worth up to hundreds of times the mean here, no detail can be told from "
         "noise, and the picture is the widest filter's, which carries light beside where it falls: see the figures "
         "below. It goes with the samples: 256 leave 0.0 % at 0.2 m and 4 % at 0.05 m. Take more samples, or "
         "`reference`."},
        {"crack-fireflies",
         cracks,
         "width of the crack, m",
         {0.2, 0.1, 0.05, 0.02},
         percentile,
         [](Stage& s, const Point& p) { return size_of(of_crack(s, p)); },
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
         "|bias| of indirect light beyond three standard errors, 64 samples",
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
