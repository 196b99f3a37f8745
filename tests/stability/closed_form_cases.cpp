// Light that is known exactly, swept over the parameter of each formula. tests/closed_forms_gl_test.cpp holds the
// reference against single values of these; here are all methods, over the whole range.
#include "renderer/metrics.h"
#include "tests/stability/case.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace farfield::stability {
namespace {

constexpr double pi = std::numbers::pi;
constexpr FrameOptions patch{.size = {64, 64}};
/// 64 x 64 pixels of so many samples: 260,000 paths for a figure, whose standard error is 0.2 % at most.
constexpr int samples = 16, frames = 4;
constexpr double albedo = 0.5;

/// 1 + q + ... + q^(terms - 1).
double series(double q, int terms) { return (1.0 - std::pow(q, terms)) / (1.0 - q); }

Built grey() {
    Built scene;
    scene.materials[0].albedo = glm::vec3(static_cast<float>(albedo));
    return scene;
}

/// A closed sphere of radius 1 seen from inside.
Built hollow_sphere() {
    Built scene = grey();
    const Id cut = scene.add(make_node(NodeKind::subtract));
    scene.add(sphere(1.5f), {}, cut);
    scene.add(sphere(1.0f), {}, cut);
    scene.look({0.3f, 0.2f, 0.5f}, {0.0f, 0.0f, -1.0f});
    return scene;
}

Node plane(double turned_about_z = 0.0) {
    Node node = make_node(NodeKind::plane);
    node.transform.rotate.z = static_cast<float>(turned_about_z);
    return node;
}

void look_at_patch(Built& scene, glm::vec3 at, glm::vec3 from) { scene.look(from, at, 1.0f); }

/// |found / answer - 1| of the mean over the picture.
Figures error(Stage& stage, const Scene& scene, double answer, bool indirect_alone) {
    const Pictures pictures = stage.render(scene, patch, samples, frames);
    Figures figures;
    for (const Method m : methods) {
        const Image image = indirect_alone ? pictures.indirect(m) : pictures.result[static_cast<std::size_t>(m)];
        figures[m] = std::abs(mean(image) / answer - 1.0);
    }
    return figures;
}

/// `irradiance` over pi: what a grey surface sends back of it is the indirect light.
Figures irradiance_error(Stage& stage, const Scene& scene, double irradiance) {
    return error(stage, scene, albedo * irradiance, true);
}

Figures furnace(Stage& stage, const Point& p) {
    Built scene = hollow_sphere();
    scene.materials[0].emission = glm::vec3(1.0f);
    scene.settings.bounces = static_cast<int>(p.value);
    return error(stage, scene, series(albedo, scene.settings.bounces + 1), false);
}

Figures lamp_in_sphere(Stage& stage, const Point& p) {
    Built scene = hollow_sphere();
    scene.add_point_light(glm::vec3(0.6f, -0.8f, 0.0f) * static_cast<float>(p.value), glm::vec3(2.0f));
    scene.settings.bounces = 4;
    return irradiance_error(stage, scene, 2.0 / pi * albedo * series(albedo, 4));
}

Figures diffuse_sphere(Stage& stage, const Point& p) {
    Built scene = hollow_sphere();
    scene.add_point_light(glm::vec3(0.0f), glm::vec3(static_cast<float>(pi)));
    scene.settings.bounces = static_cast<int>(p.value);
    return error(stage, scene, 1.0 - std::pow(0.5, scene.settings.bounces + 1), false);
}

/// Half space minus a sphere of radius 1 whose centre lies h deep.
Figures pit(Stage& stage, const Point& p) {
    const double h = p.value, f = 0.5 * (1.0 - h);
    Built scene = grey();
    const Id cut = scene.add(make_node(NodeKind::subtract));
    scene.add(plane(), {}, cut);
    scene.add(sphere(1.0f), {0.0f, static_cast<float>(-h), 0.0f}, cut);
    scene.set_sky(1.0f);
    scene.settings.bounces = 8;
    const glm::vec3 bottom(0.0f, static_cast<float>(-1.0 - h), 0.0f);
    look_at_patch(scene, bottom, bottom + glm::vec3(-0.3f, 0.8f, 0.02f));
    return irradiance_error(stage, scene, f * series(albedo * (1.0 - f), 8));
}

Figures wedge(Stage& stage, const Point& p) {
    Built scene = grey();
    scene.set_sky(1.0f);
    scene.add(plane());
    scene.add(plane(p.value - 180.0));
    scene.settings.bounces = 8;
    const double f = 0.5 * (1.0 + std::cos(p.value * pi / 180.0));
    look_at_patch(scene, {1.0f, 0.0f, 0.0f}, {1.2f, 0.2f, 0.01f});
    return irradiance_error(stage, scene, (1.0 - f) * series(albedo * f, 8));
}

/// Openness of a floor at distance a from a wall: 1 - the cosine-weighted mean over the hemisphere of w, where the wall
/// is met within the radius 1. Hard, as in the paper, w is 1 there; farfield's w falls off with the distance.
double openness_beside_wall(double a, bool hard) {
    constexpr int steps = 2000;
    double hidden = 0.0;
    for (int i = 0; i < steps; ++i)
        for (int k = 0; k < steps; ++k) {
            // Directions of density cos / pi, from a grid of the unit square.
            const double r = std::sqrt((i + 0.5) / steps), phi = 2.0 * pi * (k + 0.5) / steps,
                         to_wall = -r * std::cos(phi);
            if (to_wall <= a) continue;  // met beyond 1, or never
            const double t = a / to_wall, w = (1.0 - t * t) * (1.0 - t * t);
            hidden += hard ? 1.0 : w;
        }
    return 1.0 - hidden / (static_cast<double>(steps) * steps);
}

/// Of the view of ambient occlusion by both methods that have one, against the mean of their own weight.
Figures occlusion_error(Stage& stage, const Scene& scene, double hard, double soft) {
    stage.render(scene, patch, samples, frames);
    const auto found = [&](Method m) { return mean(stage.read(scene, patch, m, View::occlusion)); };
    Figures figures;
    figures[Method::paper] = std::abs(found(Method::paper) / hard - 1.0);
    figures[Method::farfield] = std::abs(found(Method::farfield) / soft - 1.0);
    return figures;
}

Figures wall_occlusion(Stage& stage, const Point& p) {
    Built scene = grey();
    scene.add(plane());
    scene.add(plane(-90.0));
    scene.settings.ao_radius = 0.5f;
    const float a = static_cast<float>(p.value) * scene.settings.ao_radius;
    look_at_patch(scene, {a, 0.0f, 0.0f}, {a, 0.2f, 0.01f});
    const double c = p.value, hard = 1.0 - (std::acos(c) - c * std::sqrt(1.0 - c * c)) / pi;
    return occlusion_error(stage, scene, hard, openness_beside_wall(c, false));
}

Figures sphere_over_plane(Stage& stage, const Point& p) {
    const double r = 0.5, h = 0.7, x = p.value, answer = 1.0 - h * r * r / std::pow(x * x + h * h, 1.5);
    Built scene = grey();
    scene.add(plane());
    scene.add(sphere(static_cast<float>(r)), {0.0f, static_cast<float>(h), 0.0f});
    scene.settings.ao_radius = 1000.0f;  // so far that all that is met counts whole
    const float at = static_cast<float>(x);
    look_at_patch(scene, {at, 0.0f, 0.0f}, {at + 0.1f, 0.1f, 0.01f});
    return occlusion_error(stage, scene, answer, answer);
}

/// Two planes without end face each other, and the lower one emits.
Figures parallel_planes(Stage& stage, const Point& p) {
    Built scene = grey();
    scene.add(plane());
    Node upper = plane(180.0);
    upper.material = scene.add_material(glm::vec3(static_cast<float>(p.value)));
    scene.add(upper, {0.0f, 1.0f, 0.0f});
    scene.materials[0].emission = glm::vec3(1.0f);
    scene.settings.bounces = 8;
    look_at_patch(scene, {0.0f, 0.0f, 0.0f}, {0.1f, 0.5f, 0.0f});
    return error(stage, scene, series(albedo * p.value, 5), false);
}

Figures coaxial_disc(Stage& stage, const Point& p) {
    const double r = 0.5, h = p.value;
    Built scene = grey();
    scene.add(plane());
    constexpr float half = 0.01f;
    Node disc = shape(NodeKind::capped_cylinder, {number(r), number(half)});
    disc.material = scene.add_material(glm::vec3(0.0f), glm::vec3(1.0f));
    scene.add(disc, {0.0f, static_cast<float>(h) + half, 0.0f});
    look_at_patch(scene, {0.0f, 0.0f, 0.0f}, glm::vec3(0.4f, 0.4f, 0.08f) * static_cast<float>(std::min(h, 0.2)));
    return irradiance_error(stage, scene, r * r / (r * r + h * h));
}

/// A sphere stays what it is however its space is twisted, but its field becomes flat: rays that leave it must not meet
/// it again. Under an even sky and a lamp.
Figures twisted_sphere(Stage& stage, const Point& p) {
    Built scene = grey();
    const Id twist = scene.add(shape(NodeKind::twist, {number(p.value)}));
    scene.add(sphere(0.5f), {}, twist);
    scene.set_sky(1.0f);
    scene.add_point_light({1.5f, 0.0f, 0.0f}, glm::vec3(static_cast<float>(pi)));
    look_at_patch(scene, {0.5f, 0.0f, 0.0f}, {1.5f, 0.1f, 0.1f});
    return error(stage, scene, albedo * 2.0, false);
}

}  // namespace

std::vector<Case> closed_form_cases() {
    const char* error_of = "|mean / exact answer - 1|";
    // Noise of these paths included; where nothing is left to chance the figure is far below.
    constexpr double tolerance = 0.005;
    std::vector<Case> cases{
        {"furnace", "furnace: energy lost or made", "bounces", {1, 2, 4, 6, 8}, error_of, furnace, at_most(tolerance)},
        {"lamp-in-sphere",
         "inside a sphere: sampling",
         "distance of the lamp from the centre / radius",
         {0, 0.2, 0.4, 0.6, 0.8},
         error_of,
         lamp_in_sphere,
         at_most(tolerance)},
        {"spherical-pit",
         "spherical pit: near and far light, AO",
         "depth of the centre",
         {0.01, 0.25, 0.5, 0.75},
         error_of,
         pit,
         at_most(tolerance)},
        {"wedge", "wedge: double counting", "angle, °", {30, 60, 90, 120, 150}, error_of, wedge, at_most(tolerance)},
        {"ao-wall",
         "AO beside a wall",
         "distance / AO radius",
         {0.02, 0.1, 0.2, 0.4, 0.6, 0.8, 0.95},
         "|openness / exact answer - 1|",
         wall_occlusion,
         at_most(tolerance),
         true},
        {"ao-sphere",
         "AO of a sphere over a plane, soft",
         "distance from the foot, m",
         {0, 0.2, 0.5, 1, 2},
         "|openness / exact answer - 1|",
         sphere_over_plane,
         at_most(tolerance)},
        {"parallel-planes",
         "parallel planes: maximum distance",
         "albedo of the upper one",
         {0.1, 0.3, 0.6, 0.9},
         error_of,
         parallel_planes,
         at_most(tolerance)},
        {"coaxial-disc",
         "coaxial disc: form factor",
         "height, m",
         {0.05, 0.1, 0.5, 1, 2},
         error_of,
         coaxial_disc,
         at_most(tolerance)},
        {"diffuse-sphere",
         "diffuse sphere: everything at once",
         "bounces",
         {1, 2, 4, 8},
         error_of,
         diffuse_sphere,
         at_most(0.02)},
        {"flat-field",
         "flat field: self-intersection of rays that leave a surface",
         "twist rate of a sphere, °/m",
         {0, 100, 1000, 10000, 36000},
         error_of,
         twisted_sphere,
         at_most(0.01)}};
    return cases;
}

}  // namespace farfield::stability
