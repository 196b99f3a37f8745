// What the properties of every kind do not see: that the ellipsoid's bound is one for thin bodies, and the fractals'
// finest structure, where a field without a proof goes wrong first.
#include "sdf/evaluate.h"
#include "tests/test_support.h"

#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace farfield {
namespace {

float uniform(std::mt19937& random, float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
}

glm::vec3 random_point(std::mt19937& random, float half) {
    const float x = uniform(random, -half, half), y = uniform(random, -half, half), z = uniform(random, -half, half);
    return {x, y, z};
}

/// The signed distance by bisection in double precision.
double ellipsoid_distance(glm::dvec3 p, glm::dvec3 radii) {
    p = glm::max(glm::abs(p), glm::dvec3(1e-14));
    const double shortest = std::min({radii.x, radii.y, radii.z});
    const glm::dvec3 r = radii / shortest, k = (r - 1.0) * (r + 1.0), a = r * r * p / radii;
    double low = 0.0, high = glm::length(a);
    for (int i = 0; i < 200; ++i) {
        const double u = 0.5 * (low + high);
        (glm::length(a / (u + k)) > 1.0 ? low : high) = u;
    }
    const glm::dvec3 n = glm::normalize(a / ((0.5 * (low + high) + k) * r));
    return glm::dot(n, p) - glm::length(radii * n);
}

TEST(Ellipsoid, IsABoundForThinBodiesAndOnTheirSymmetryPlanes) {
    const KindInfo& kind = info(NodeKind::ellipsoid);
    std::mt19937 random(1);
    for (int i = 0; i < 50'000; ++i) {
        glm::vec3 radii;
        for (int axis = 0; axis < 3; ++axis) radii[axis] = std::pow(10.0f, uniform(random, -3.0f, 0.0f));
        if (i % 4 == 0) radii[1] = radii[0];
        glm::vec3 p = i % 2 ? random_point(random, 1.5f) : radii * random_point(random, 1.5f);
        for (int axis = 0; axis < 3; ++axis)
            if (random() % 3 == 0) p[axis] *= random() % 2 ? 0.0f : std::pow(10.0f, uniform(random, -9.0f, 0.0f));
        const double bound = kind.primitive(p, std::vector{radii}), distance = ellipsoid_distance(p, radii);
        // 1e-5: the rounding of coordinates up to 1.5.
        ASSERT_TRUE(std::abs(bound) <= std::abs(distance) + 1e-5 && (bound > 1e-5) <= (distance > 0.0))
            << bound << " for " << distance << " at " << p.x << ' ' << p.y << ' ' << p.z << " in " << radii.x << ' '
            << radii.y << ' ' << radii.z;
    }
}

/// The slope of the mandelbulb's field at p by differences over 2e-4 m, which average the finer structure but show
/// every slope that a ray can meet; 0 where the ball around it counts, whose slope is 1 without a search.
float slope(const KindInfo& kind, const std::vector<glm::vec3>& values, glm::vec3 p) {
    constexpr float h = 1e-4f;
    if (kind.primitive(p, values) < glm::length(p) - values[0].x + 4.0f * h) return 0.0f;
    glm::vec3 gradient;
    for (int i = 0; i < 3; ++i) {
        glm::vec3 step(0.0f);
        step[i] = h;
        gradient[i] = (kind.primitive(p + step, values) - kind.primitive(p - step, values)) / (2.0f * h);
    }
    return glm::length(gradient);
}

TEST(Mandelbulb, SearchFindsNoSlopeAboveOne) {
    // Nothing proves the mandelbulb's constant, so this looks for the steepest place: from the steepest of many
    // samples, most of them near the surface and some near the y axis, it climbs by random steps. Rounding: 2e-6 m over
    // 2e-4 m.
    constexpr float radius = 1.0f, allowed = 1.0f + 1e-2f;
    const KindInfo& kind = info(NodeKind::mandelbulb);
    std::mt19937 random(2);
    for (int power = 2; power <= 16; ++power)
        for (const int iterations : {1, 2, 3, 5, 8, 16}) {
            const std::vector<glm::vec3> values{glm::vec3(radius), glm::vec3(static_cast<float>(power)),
                                                glm::vec3(static_cast<float>(iterations))};
            std::vector<std::pair<float, glm::vec3>> samples;
            for (int i = 0; i < 1000; ++i) {
                glm::vec3 p = random_point(random, 1.05f * radius);
                if (i % 4 == 0) p *= glm::vec3(std::exp2(uniform(random, -8.0f, 0.0f)), 1.0f, 1.0f) * 0.9f;
                if (i % 8 == 0) p.z *= std::exp2(uniform(random, -8.0f, 0.0f));
                for (int steps = static_cast<int>(random() % 30); steps > 0 && glm::length(p) > 0.1f; --steps)
                    p -= glm::normalize(p) * 2.0f * kind.primitive(p, values);
                samples.emplace_back(slope(kind, values, p), p);
            }
            std::sort(samples.begin(), samples.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
            for (int start = 0; start < 6; ++start) {
                auto [steepest, p] = samples[static_cast<std::size_t>(start)];
                float stride = 0.03f;
                for (int i = 0; i < 120; ++i) {
                    const glm::vec3 q = p + random_point(random, stride);
                    const float found = slope(kind, values, q);
                    stride *= found > steepest ? 1.2f : 0.95f;
                    if (found > steepest) steepest = found, p = q;
                }
                ASSERT_LE(steepest, allowed)
                    << "power " << power << ", iterations " << iterations << " at " << p.x << ' ' << p.y << ' ' << p.z;
            }
        }
}

TEST(Fractals, SphereTracingMeetsTheFirstSurfaceThatSmallStepsMeet) {
    std::mt19937 random(3);
    for (const NodeKind shape : {NodeKind::mandelbulb, NodeKind::menger_sponge}) {
        const KindInfo& kind = info(shape);
        std::vector<glm::vec3> values;
        for (const Parameter& parameter : kind.parameters) values.push_back(parameter.initial);
        int hits = 0;
        for (int ray = 0; ray < 300; ++ray) {
            const glm::vec3 origin = 1.5f * glm::normalize(random_point(random, 1.0f));
            const glm::vec3 direction = glm::normalize(random_point(random, 0.6f) - origin);
            constexpr float epsilon = 1e-3f, small_step = 1e-3f;
            float t = 0.0f, small = 0.0f;
            while (t < 3.0f) {
                const float d = kind.primitive(origin + t * direction, values);
                if (d < epsilon) break;
                t += d;
            }
            while (small < 3.0f && kind.primitive(origin + small * direction, values) > 0.0f) small += small_step;
            if (small >= 3.0f) continue;
            ASSERT_LE(t, small + small_step) << "ray " << ray << " of " << kind.key;  // else it went through a wall
            ++hits;
        }
        EXPECT_GT(hits, 50) << kind.key;
    }
}

TEST(Fractals, TheSpongeIsTheSetOfBaseThreeDigits) {
    // A point of the cube [0, 1]³ is cut away where at some place two or more of its coordinates have the digit 1.
    const KindInfo& kind = info(NodeKind::menger_sponge);
    std::mt19937 random(4);
    for (int i = 0; i < 20'000; ++i) {
        const int iterations = static_cast<int>(random() % 7);
        const glm::vec3 p = random_point(random, 0.5f);
        glm::vec3 digits = p + 0.5f;
        bool solid = true;
        for (int k = 0; k < iterations; ++k) {
            digits *= 3.0f;
            int middle = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const float digit = std::floor(digits[axis]);
                middle += digit == 1.0f;
                digits[axis] -= digit;
            }
            solid = solid && middle < 2;
        }
        const float d = kind.primitive(p, std::vector{glm::vec3(0.5f), glm::vec3(static_cast<float>(iterations))});
        if (std::abs(d) < 1e-5f) continue;  // rounding
        ASSERT_EQ(d < 0.0f, solid) << iterations << " at " << p.x << ' ' << p.y << ' ' << p.z;
    }
}

}  // namespace
}  // namespace farfield
