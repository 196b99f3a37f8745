// Where distance fields fail: steps that overshoot, steps that run out, skins thinner than what rays can tell.
#include "renderer/metrics.h"
#include "sdf/audit.h"
#include "sdf/custom_code.h"
#include "tests/stability/case.h"
#include "tests/tiny_steps.h"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace farfield::stability {
namespace {

constexpr FrameOptions small{.size = {64, 64}};

/// Of 1,000 rays that meet the surface in steps of 1e-4 m, those that pass through it; with how many evaluations.
Figures holes(const Scene& scene) {
    const Box box = FieldTree(scene).bounds().common({glm::vec3(-2.0f), glm::vec3(2.0f)});
    const std::vector<RayRecord> rays = camera_rays(box, 48);
    const std::vector<float> truth = marched(scene, rays);
    const std::vector<HitRecord> found = traced(scene, Tier::specialised, rays);
    double hits = 0.0, through = 0.0, steps = 0.0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        steps += found[i].steps & 0xffffu;  // above them stands the part of the scene
        if (truth[i] < 0.0f) continue;
        hits += 1.0;
        const float tolerance = 2.0f * fine_footprint * rays[i].reach;
        through += found[i].distance < 0.0f || found[i].distance > truth[i] + tolerance;
    }
    return shared(hits > 0.0 ? 1000.0 * through / hits : NAN,
                  fmt::format("{:.1f} evaluations per ray", steps / static_cast<double>(rays.size())));
}

Scene modified(NodeKind kind, std::vector<glm::vec3> values = {}) {
    Built scene;
    Node node = shape(kind, std::move(values));
    if (info(kind).takes_children()) node.children = {beam(), ball()};
    scene.add(node);
    return scene;
}

constexpr NodeKind stretching[] = {NodeKind::twist,   NodeKind::bend,          NodeKind::taper,
                                   NodeKind::stretch, NodeKind::displace_sine, NodeKind::displace_noise,
                                   NodeKind::custom};

Scene stretched(const Point& point) {
    const NodeKind kind = stretching[static_cast<std::size_t>(point.value)];
    switch (kind) {
        case NodeKind::twist:
            return modified(kind, {number(700.0)});
        case NodeKind::bend:
            return modified(kind, {number(200.0)});
        case NodeKind::taper:
            return modified(kind, {number(-3.0)});
        case NodeKind::stretch:
            return modified(kind, {{0.05f, 3.0f, 0.4f}});
        case NodeKind::displace_sine:
            return modified(kind, {number(0.1), number(0.08)});
        case NodeKind::displace_noise:
            return modified(kind, {number(0.1), number(0.1), number(8.0)});
        default: {
            Scene scene = modified(kind);
            apply(scene, SetCode{scene.root.children[0].id,
                                 "const float lipschitz = 1.8;\nfloat sdf(vec3 p) { vec3 q = 9.0 * p; "
                                 "return abs(dot(sin(q), cos(q.yzx))) / 9.0 - 0.03; }"});
            return scene;
        }
    }
}

std::vector<Point> stretching_kinds() {
    std::vector<Point> points;
    for (const NodeKind kind : stretching) points.emplace_back(static_cast<double>(points.size()), info(kind).key);
    return points;
}

Figures steepest_slope(const Scene& scene) {
    AuditOptions options;
    options.samples = 20000;
    float steepest = 0.0f;
    for (const NodeAudit& node : audit(scene, options).nodes) steepest = std::max(steepest, node.slope);
    return shared(steepest);
}

/// Of 1,000 pixels those whose depth is another one: repeated, and every copy placed by itself.
Figures unrolled(Stage& stage, double spacing) {
    constexpr int count = 4;
    const float apart = static_cast<float>(spacing);
    const auto look = [&](Built& scene) {
        scene.look(glm::vec3(1.2f, 1.6f, 2.4f) * (4.0f * apart), {0.0f, 0.1f, 0.0f}, 30.0f);
    };
    Built rolled, flat;
    Node repeat = shape(NodeKind::repeat, {{apart, 0.0f, apart}, {count, 0.0f, count}});
    repeat.children = {beam(), ball()};
    rolled.add(repeat);
    for (int x = 0; x < count; ++x)
        for (int z = 0; z < count; ++z)
            for (const Node& part : {beam(), ball()})
                flat.add(part, {apart * (static_cast<float>(x) - 1.5f), 0.0f, apart * (static_cast<float>(z) - 1.5f)});
    look(rolled), look(flat);
    // The copies placed by themselves are met in closed form, the repeated ones within the tracer's tolerance.
    constexpr FrameOptions fine{.size = small.size, .minimum_step = 0.1f};
    const Image a = stage.render(rolled, fine, 1).depth, b = stage.render(flat, fine, 1).depth;
    int differing = 0;
    for (std::size_t i = 0; i < a.pixels.size(); i += 3)
        differing += std::abs(a.pixels[i] - b.pixels[i]) > 1e-3f * std::max(a.pixels[i], b.pixels[i]);
    return shared(3000.0 * differing / static_cast<double>(a.pixels.size()));
}

Scene blended(double radius) {
    Built scene;
    Node all = shape(NodeKind::union_, {number(radius)}), cut = shape(NodeKind::subtract, {number(radius)});
    cut.children = {beam(), ball()};
    Node other = sphere(0.3f);
    other.transform.translate = {-0.5f, 0.1f, 0.2f};
    all.children = {cut, other};
    scene.add(all);
    return scene;
}

/// Rays that graze: a camera a hand above a floor of bumps, which a ray passes for twenty metres.
Built grazing() {
    Built scene;
    Node bumps = shape(NodeKind::displace_sine, {number(0.05), number(0.6)});
    bumps.children = {box({10.0f, 0.2f, 10.0f})};
    scene.add(bumps);
    scene.add(sphere(0.5f), {0.0f, 0.6f, -4.0f});
    scene.look({0.0f, 0.45f, 9.5f}, {0.0f, 0.35f, 0.0f});
    scene.set_sky(1.0f);
    return scene;
}

/// Of 1,000 pixels those that are surface where steps without end find none, or the reverse.
Figures out_of_steps(Stage& stage, int limit, double* exhausted = nullptr) {
    FrameOptions options = small;
    options.counting = true;
    options.step_limit = limit;
    const Built scene = grazing();
    const Image depth = stage.render(scene, options, 1).depth;
    const Statistics& statistics = stage.renderer().statistics();
    const double share = 1000.0 * static_cast<double>(statistics.exhausted_rays) / static_cast<double>(statistics.rays);
    if (exhausted) *exhausted = share;
    options.step_limit = 100000;
    const Image truth = stage.render(scene, options, 1).depth;
    int differing = 0;
    for (std::size_t i = 0; i < truth.pixels.size(); i += 3)
        differing += (depth.pixels[i] > 0.0f) != (truth.pixels[i] > 0.0f);
    return shared(3000.0 * differing / static_cast<double>(truth.pixels.size()));
}

Figures exhausted_rays(Stage& stage, int limit) {
    double exhausted = 0.0;
    out_of_steps(stage, limit, &exhausted);
    return shared(exhausted);
}

/// A sphere's skin around a lamp, seen from outside, where nothing is lit: the light that comes through, over the light
/// that the skin sends back on its inside.
Figures leak(Stage& stage, double over_epsilon) {
    constexpr double epsilon = 1e-4;  // where rays leave a surface they start twice this above it
    Built scene;
    Node shell = shape(NodeKind::shell, {number(over_epsilon * epsilon)});
    shell.children = {sphere(1.0f)};
    scene.add(shell);
    scene.add_point_light({0.2f, 0.1f, 0.0f}, glm::vec3(3.0f));
    scene.settings.bounces = 2;
    scene.look({0.0f, 0.0f, 0.3f}, {0.3f, 0.0f, -1.0f});
    const Pictures inside = stage.render(scene, small, 4);
    scene.look({0.5f, 1.0f, 3.0f}, glm::vec3(0.0f), 30.0f);
    const Pictures outside = stage.render(scene, small, 4);
    Figures figures;
    for (const Method m : methods) {
        const std::size_t i = static_cast<std::size_t>(m);
        figures[m] = mean(outside.result[i]) / mean(inside.result[i]);
    }
    return figures;
}

}  // namespace

std::vector<Case> field_cases() {
    std::vector<Case> cases;
    const std::string overshoot = "overshoot of stretched space: holes";
    cases.push_back({"twist-rate",
                     overshoot,
                     "twist rate, °/m",
                     {10, 100, 360, 1000, 3600, 10000},
                     "rays through the surface, of 1,000 that meet it",
                     [](Stage&, const Point& p) { return holes(modified(NodeKind::twist, {number(p.value)})); },
                     at_most(0.0)});
    cases.push_back({"stretch-holes", overshoot, "kind, extreme parameters", stretching_kinds(),
                     "rays through the surface, of 1,000 that meet it",
                     [](Stage&, const Point& p) { return holes(stretched(p)); }, at_most(0.0)});
    cases.push_back({"stretch-slope", overshoot, "kind, extreme parameters", stretching_kinds(),
                     "steepest slope between 20,000 random pairs of points",
                     [](Stage&, const Point& p) { return steepest_slope(stretched(p)); },
                     // 1, and the rounding of the two values
                     at_most(1.0001), true});
    cases.push_back({"repeat-asymmetric",
                     "repetition of asymmetric content: cut copies",
                     "spacing, m",
                     {0.6, 0.8, 1.0, 1.5, 3.0},
                     "pixels of 1,000 with another depth than the unrolled scene",
                     [](Stage& s, const Point& p) { return unrolled(s, p.value); },
                     at_most(0.5)});
    cases.push_back({"blend-radius",
                     "subtraction, blends: bounds only",
                     "blend radius, m",
                     {0.001, 0.01, 0.1, 1, 10, 1000},
                     "rays through the surface, of 1,000 that meet it",
                     [](Stage&, const Point& p) { return holes(blended(p.value)); },
                     at_most(0.0)});
    // A quarter of the tracer's own limit must do as well; far less is shown for what it does.
    const std::vector<Point> limits{16, 32, 64, 128, 256, 512};
    const auto from_a_quarter = [](const Point& p) { return p.value >= 128.0 ? 2.0 : 1000.0; };
    cases.push_back({"step-limit", "grazing rays: steps run out", "steps for each ray (the tracer's own limit: 512)",
                     limits, "pixels of 1,000 that are surface instead of sky, or the reverse",
                     [](Stage& s, const Point& p) { return out_of_steps(s, static_cast<int>(p.value)); },
                     from_a_quarter});
    cases.push_back({"exhausted-rays", "grazing rays: steps run out",
                     "steps for each ray (the tracer's own limit: 512)", limits, "rays of 1,000 that the limit stopped",
                     [](Stage& s, const Point& p) { return exhausted_rays(s, static_cast<int>(p.value)); },
                     from_a_quarter});
    cases.push_back({"shell-thickness",
                     "thin shells: light leaks",
                     "thickness / ε (ε = 0.1 mm)",
                     {0.1, 0.2, 0.5, 1, 2, 5, 10},
                     "light outside a lit shell / light inside",
                     [](Stage& s, const Point& p) { return leak(s, p.value); },
                     at_most(1e-4)});
    return cases;
}

}  // namespace farfield::stability
