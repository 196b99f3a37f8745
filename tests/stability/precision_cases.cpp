// Where single precision fails: far from the origin, and steps of the tracer that are coarse on purpose.
#include "renderer/metrics.h"
#include "tests/stability/case.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace farfield::stability {
namespace {

constexpr FrameOptions small{.size = {64, 64}};

/// A still life whose camera and lamp stand on multiples of 1/16 m, which floats hold exactly up to 10^6 m: what is
/// left is the renderer's own. `offset` moves everything along all axes, as one group or shape by shape.
Built still_life(double offset, bool as_group) {
    Built scene;
    constexpr double furthest = 1e6 - 16.0;  // files and edits end at a million metres
    const glm::vec3 moved(static_cast<float>(std::min(offset, furthest)));
    Id parent = 0;
    if (as_group) parent = scene.add(make_node(NodeKind::union_), moved);
    const glm::vec3 each = as_group ? glm::vec3(0.0f) : moved;
    scene.add(box({4.0f, 0.125f, 4.0f}), each + glm::vec3(0.0f, -0.125f, 0.0f), parent);
    scene.add(box({4.0f, 2.0f, 0.125f}), each + glm::vec3(0.0f, 2.0f, -2.0f), parent);
    Node block = box({0.5f, 0.75f, 0.5f});
    block.transform.rotate.y = 30.0f;
    block.material = scene.add_material({0.7f, 0.2f, 0.1f});
    scene.add(block, each + glm::vec3(-0.75f, 0.75f, 0.0f), parent);
    scene.add(sphere(0.5f), each + glm::vec3(0.75f, 0.5f, 0.5f), parent);
    Node ring = make_node(NodeKind::torus);
    ring.transform.rotate = {70.0f, 0.0f, 20.0f};
    scene.add(ring, each + glm::vec3(0.25f, 1.5f, 0.25f), parent);
    scene.add_point_light(moved + glm::vec3(1.5f, 3.0f, 2.0f), glm::vec3(20.0f));
    scene.set_sky(0.5f);
    scene.settings.bounces = 2;
    scene.look(moved + glm::vec3(2.0f, 2.0f, 4.5f), moved + glm::vec3(0.0f, 0.75f, 0.0f));
    return scene;
}

/// RMSE / mean against the same scene at the origin, with the same random numbers: what is left when single paths part
/// ways by rounding, and everything that is worse.
Figures far_away(Stage& stage, double offset, bool as_group) {
    const Pictures here = stage.render(still_life(0.0, as_group), small, 16),
                   there = stage.render(still_life(offset, as_group), small, 16);
    Figures figures;
    for (const Method m : methods) {
        const std::size_t i = static_cast<std::size_t>(m);
        figures[m] = measure(there.result[i], here.result[i]).rmse_over_mean;
    }
    return figures;
}

/// What a tracer with coarse hits loses of the light, and what that saves.
Figures coarse_steps(Stage& stage, double step) {
    const Built scene = still_life(0.0, true);
    FrameOptions options = small;
    options.counting = true;
    const Pictures fine = stage.render(scene, options, 32);
    options.minimum_step = static_cast<float>(step);
    const Pictures coarse = stage.render(scene, options, 32);
    const Statistics& s = stage.renderer().statistics();
    Figures figures;
    for (const Method m : methods) figures[m] = std::abs(mean(coarse.indirect(m)) / mean(fine.indirect(m)) - 1.0);
    figures.note =
        fmt::format("{:.2f} evaluations per ray", static_cast<double>(s.evaluations) / static_cast<double>(s.rays));
    return figures;
}

}  // namespace

std::vector<Case> precision_cases() {
    const std::vector<Point> powers{1, 10, 100, 1e3, 1e4, 1e5, 1e6};
    const std::string far = "far from the origin: float spacing";
    const char* difference = "RMSE / mean against the same scene at the origin";
    return {{"far-group", far, "distance, m (one group)", powers, difference,
             [](Stage& s, const Point& p) { return far_away(s, p.value, true); }, at_most(0.02)},
            {"far-shapes", far, "distance, m (each shape placed there)", powers, difference,
             [](Stage& s, const Point& p) { return far_away(s, p.value, false); }, at_most(0.02)},
            {"minimum-step",
             "coarse steps for speed: light is lost",
             "minimum step, times the usual",
             {1, 2, 4, 8, 16},
             "|indirect light / that of the usual step - 1|",
             [](Stage& s, const Point& p) { return coarse_steps(s, p.value); },
             // A price, not a fault: a percent for each time as coarse.
             [](const Point& p) { return 0.01 * p.value; }}};
}

}  // namespace farfield::stability
