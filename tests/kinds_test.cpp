// Properties of every kind of the table. A new kind is tested without writing a test.
#include "sdf/evaluate.h"
#include "tests/test_support.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace farfield {
namespace {

/// Everything that the tests look at lies in the cube from -extent to extent.
constexpr float extent = 1.5f;
/// Coordinates of about 2 m pass through about 20 operations of float rounding, 1.2e-7 relative each.
constexpr float rounding = 1e-5f;

float uniform(std::mt19937& random, float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
}

glm::vec3 random_point(std::mt19937& random, float half) {
    const float x = uniform(random, -half, half), y = uniform(random, -half, half), z = uniform(random, -half, half);
    return {x, y, z};
}

glm::vec3 random_direction(std::mt19937& random) {
    for (;;) {
        const glm::vec3 v = random_point(random, 1.0f);
        const float length = glm::length(v);
        if (length > 1e-3f && length < 1.0f) return v / length;
    }
}

/// How far parameters leave their defaults.
enum class Spread {
    none,  ///< not at all
    near,  ///< up to a fifth
    wide,  ///< anywhere between degenerate and larger than what the tests look at
};

glm::vec3 random_parameter(const Parameter& parameter, Spread spread, std::mt19937& random) {
    glm::vec3 v = parameter.initial;
    for (int i = 0; i < parameter.components(); ++i) {
        if (spread == Spread::none) continue;
        if (parameter.is_whole())
            v[i] += static_cast<float>(random() % (spread == Spread::near ? 2 : 5));
        else if (spread == Spread::near)
            v[i] *= uniform(random, 0.8f, 1.2f);
        else if (parameter.unit == Unit::metres)
            v[i] = random() % 16 == 0 ? 0.0f : std::exp2(uniform(random, -6.0f, 1.0f)) * (random() % 2 ? -1.0f : 1.0f);
        else
            v[i] = uniform(random, parameter.minimum, parameter.maximum);
        if (parameter.minimum >= 0.0f) v[i] = std::abs(v[i]);
    }
    return clamped(parameter, v);
}

/// A scene of one node of `kind`; an operation gets two primitives to work on, small enough for the cells of a
/// repetition.
Scene scene_of(const KindInfo& kind, Spread spread, std::mt19937& random) {
    Scene scene;
    Node node = make_node(kind.kind);
    const std::vector<Parameter> list = parameters(node);
    for (std::size_t i = 0; i < list.size(); ++i) node.values[i] = random_parameter(list[i], spread, random);
    if (kind.takes_children()) {
        Node box = make_node(NodeKind::box), ball = make_node(NodeKind::sphere);
        box.values[0] = {0.25f, 0.2f, 0.15f};
        ball.values[0].x = 0.2f;
        ball.transform.translate = {0.15f, 0.1f, 0.0f};
        node.children = {box, ball};
    }
    if (kind.role == Role::instance) {
        Node box = make_node(NodeKind::rounded_box);
        box.id = node.definition = scene.new_id();
        scene.definitions.push_back(box);
    }
    scene.root.children.push_back(node);
    return scene;
}

std::string parameters_text(const Scene& scene) {
    const Node& node = scene.root.children[0];
    std::string text;
    for (std::size_t i = 0; i < node.values.size(); ++i)
        text += fmt::format("{} ({}, {}, {}) ", parameters(node)[i].key, node.values[i].x, node.values[i].y,
                            node.values[i].z);
    return text;
}

std::string text(glm::vec3 p) { return fmt::format("({}, {}, {})", p.x, p.y, p.z); }

class EveryKind : public testing::TestWithParam<NodeKind> {
protected:
    const KindInfo& kind() const { return info(GetParam()); }

    /// Calls check(scene, spread) for the defaults, `count` sets of parameters near them and as many wide ones.
    template <class Check>
    void for_scenes(int count, Check check) {
        for (int i = 0; i < 2 * count + 1 && !HasFailure(); ++i) {
            const Spread spread = i == 0 ? Spread::none : i <= count ? Spread::near : Spread::wide;
            const Scene scene = scene_of(kind(), spread, random_);
            SCOPED_TRACE(parameters_text(scene));
            check(scene, spread);
        }
    }

    std::mt19937 random_{7};
};
INSTANTIATE_TEST_SUITE_P(Table, EveryKind, testing::ValuesIn([] {
                             std::vector<NodeKind> kinds;
                             for (const KindInfo& kind : node_kinds()) kinds.push_back(kind.kind);
                             return kinds;
                         }()),
                         [](const auto& test) { return std::string(farfield::info(test.param).key); });

TEST_P(EveryKind, IsOneLipschitz) {
    for_scenes(6, [&](const Scene& scene, Spread) {
        const FieldEvaluator field(scene);
        for (int i = 0; i < 80'000; ++i) {  // 10^6 pairs in all, from a millimetre to a metre apart
            const glm::vec3 a = random_point(random_, extent);
            const glm::vec3 b = a + random_direction(random_) * std::exp2(uniform(random_, -10.0f, 0.0f));
            ASSERT_LE(std::abs(field.distance(a) - field.distance(b)), glm::length(a - b) + rounding)
                << "at " << text(a) << " and " << text(b);
        }
    });
}

/// Points where the field changes its sign along the edges of a grid, within 3e-6 metres.
std::vector<glm::vec3> surface_points(const FieldEvaluator& field) {
    constexpr int n = 40;
    constexpr float cell = 2.0f * extent / static_cast<float>(n - 1);
    const auto point = [&](int x, int y, int z) {
        return glm::vec3(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)) * cell - extent;
    };
    std::vector<bool> inside;
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) inside.push_back(field.distance(point(x, y, z)) < 0.0f);
    std::vector<glm::vec3> found;
    constexpr int strides[] = {1, n, n * n};
    for (int i = 0; i < n * n * n; ++i)
        for (int axis = 0; axis < 3; ++axis) {
            if (i / strides[axis] % n == n - 1 || inside[i] == inside[i + strides[axis]]) continue;
            glm::vec3 a = point(i % n, i / n % n, i / (n * n)), b = a;
            b[axis] += cell;
            for (int k = 0; k < 15; ++k) {
                const glm::vec3 middle = 0.5f * (a + b);
                ((field.distance(middle) < 0.0f) == inside[i] ? a : b) = middle;
            }
            found.push_back(a);
        }
    return found;
}

TEST_P(EveryKind, NeverClaimsMoreThanTheDistanceToTheSurface) {
    for_scenes(3, [&](const Scene& scene, Spread spread) {
        const FieldEvaluator field(scene);
        const std::vector<glm::vec3> surface = surface_points(field);
        if (spread == Spread::none) {
            EXPECT_GT(surface.size(), 20u);
        }
        for (int i = 0; i < 1000 && !surface.empty(); ++i) {
            const glm::vec3 p = random_point(random_, extent);
            float nearest = 1e9f;
            for (const glm::vec3& s : surface) nearest = std::min(nearest, glm::dot(s - p, s - p));
            ASSERT_LE(std::abs(field.distance(p)), std::sqrt(nearest) + rounding) << "at " << text(p);
        }
        for (int i = 0; i < 20'000; ++i) {  // close to the surface, where its points are too sparse
            const glm::vec3 a = random_point(random_, extent);
            const glm::vec3 b = a + random_point(random_, 0.1f);
            const float da = field.distance(a), db = field.distance(b);
            if ((da < 0.0f) == (db < 0.0f)) continue;
            ASSERT_LE(std::max(std::abs(da), std::abs(db)), glm::length(a - b) + rounding)
                << "at " << text(a) << " and " << text(b);
        }
    });
}

constexpr float tolerance = 1e-3f;

/// Whether both signs occur within `tolerance` of q, so that the surface does. The straight way through is tried first;
/// at an acute edge or tip only chance finds the few per cent of the ball that are inside.
bool surface_is_at(const FieldEvaluator& field, glm::vec3 q, glm::vec3 normal, std::mt19937& random) {
    const bool inside = field.distance(q + tolerance * normal) < 0.0f;
    if (inside != (field.distance(q - tolerance * normal) < 0.0f)) return true;
    for (int i = 0; i < 5000; ++i)
        if (inside != (field.distance(q + uniform(random, 0.0f, tolerance) * random_direction(random)) < 0.0f))
            return true;
    return false;
}

/// An exact distance d at p means that the ball of radius |d| around p holds no surface inside, which the test above
/// shows, and that it touches some: at p - d grad d. Where the surface lies within 1e-3 of that, the distance is at
/// most |d| + 1e-3. Differences over 2 mm give the gradient with an error of 1e-4 by rounding; only across the medial
/// axis, where it jumps, are they wrong. So one of a few points within 5 mm of p must show it: where a bound is not
/// exact none will.
void expect_exact(const FieldEvaluator& field, glm::vec3 p, std::mt19937& random) {
    for (int attempt = 0; attempt < 32; ++attempt) {
        const glm::vec3 q = attempt == 0 ? p : p + random_point(random, 5e-3f);
        const float d = field.distance(q);
        glm::vec3 gradient;
        constexpr float h = 1e-3f;
        for (int i = 0; i < 3; ++i) {
            glm::vec3 step(0.0f);
            step[i] = h;
            gradient[i] = (field.distance(q + step) - field.distance(q - step)) / (2.0f * h);
        }
        if (glm::length(gradient) < 0.9f) continue;
        gradient = glm::normalize(gradient);
        if (surface_is_at(field, q - d * gradient, gradient, random)) return;
    }
    FAIL() << "no surface at the distance " << field.distance(p) << " from " << text(p);
}

TEST_P(EveryKind, ExactOnesAgreeWithTheNearestSurface) {
    if (!kind().exact) return;
    for_scenes(4, [&](const Scene& scene, Spread spread) {
        const bool operation = kind().takes_children();
        if (spread == Spread::wide || (operation && spread != Spread::none)) return;
        const FieldEvaluator field(scene);
        for (int i = 0; i < 3000 && !HasFailure(); ++i) {
            const glm::vec3 p = random_point(random_, extent);
            if (operation && field.distance(p) < 0.05f) continue;  // inside they are bounds; 0.05: the neighbours too
            expect_exact(field, p, random_);
        }
    });
}

TEST_P(EveryKind, LiesWithinItsBounds) {
    for_scenes(8, [&](const Scene& scene, Spread) {
        // The level of a radius around it too, which is what a smooth union or `round` above would show.
        for (const float level : {0.0f, 0.2f}) {
            Scene grown = scene;
            Node round = make_node(NodeKind::round);
            round.values[0].x = level;
            round.children = grown.root.children;
            grown.root.children = {round};
            const FieldEvaluator field(grown);
            const Box box = field.tree().bounds();
            for (int i = 0; i < 20'000; ++i) {
                const glm::vec3 p = random_point(random_, 2.0f * extent);
                if (field.distance(p) > 0.0f) continue;
                ASSERT_TRUE(glm::clamp(p, box.low, box.high) == p)
                    << text(p) << " is outside of " << text(box.low) << " to " << text(box.high);
            }
        }
    });
}

TEST_P(EveryKind, IsItsMirrorImageWhereItSaysSo) {
    for_scenes(4, [&](const Scene& scene, Spread) {
        const FieldEvaluator field(scene);
        for (int axis = 0; axis < 3; ++axis) {
            if (!field.tree().root->extent.symmetric[axis]) continue;
            for (int i = 0; i < 1000; ++i) {
                const glm::vec3 p = random_point(random_, extent);
                glm::vec3 q = p;
                q[axis] = -p[axis];
                ASSERT_NEAR(field.distance(p), field.distance(q), rounding) << "at " << text(p) << " along " << axis;
            }
        }
    });
}

TEST_P(EveryKind, IsTheSameAllAlongWhereItSaysSo) {
    for_scenes(4, [&](const Scene& scene, Spread) {
        const FieldEvaluator field(scene);
        for (int axis = 0; axis < 3; ++axis) {
            if (!field.tree().root->extent.constant[axis]) continue;
            for (int i = 0; i < 1000; ++i) {
                const glm::vec3 p = random_point(random_, extent);
                glm::vec3 q = p;
                q[axis] = 0.0f;
                ASSERT_NEAR(field.distance(p), field.distance(q), rounding) << "at " << text(p) << " along " << axis;
            }
        }
    });
}

/// Operations for profiles promise the exact distance on both sides, by their defaults and for exact profiles that do
/// not reach over the axis of revolution; at this scale none does, by parameters up to a fifth from its defaults.
constexpr float scale_of_profiles = 0.8f;

TEST(Profiles, MakeExactBodies) {
    std::mt19937 random(11);
    int bodies = 0;
    for (const KindInfo& operation : node_kinds())
        for (const KindInfo& profile : node_kinds()) {
            if (!operation.flat || !operation.takes_children() || !profile.flat || profile.takes_children()) continue;
            for (const Spread spread : {Spread::none, Spread::near}) {
                Scene scene = scene_of(operation, Spread::none, random);
                Node child = scene_of(profile, spread, random).root.children[0];
                child.transform.scale = scale_of_profiles;
                scene.root.children[0].children = {child};
                SCOPED_TRACE(std::string(operation.key) + " of " + profile.key);
                const FieldEvaluator field(scene);
                for (int i = 0; i < 1500 && !testing::Test::HasFailure(); ++i)
                    expect_exact(field, random_point(random, extent), random);
                for (int i = 0; i < 20'000; ++i) {
                    const glm::vec3 a = random_point(random, extent);
                    const glm::vec3 b = a + random_direction(random) * std::exp2(uniform(random, -10.0f, 0.0f));
                    ASSERT_LE(std::abs(field.distance(a) - field.distance(b)), glm::length(a - b) + rounding)
                        << "at " << text(a) << " and " << text(b);
                }
                ++bodies;
            }
        }
    EXPECT_GE(bodies, 24);
}

TEST(Profiles, AreTheSameAtEveryZ) {
    std::mt19937 random(12);
    for (const KindInfo& profile : node_kinds()) {
        if (!profile.flat || profile.takes_children()) continue;
        const FieldEvaluator field(scene_of(profile, Spread::none, random));
        for (int i = 0; i < 1000; ++i) {
            const glm::vec3 p = random_point(random, extent);
            EXPECT_EQ(field.distance(p), field.distance({p.x, p.y, 0.0f})) << profile.key;
        }
    }
}

TEST_P(EveryKind, AnswersFiniteNumbersAtTheLimitsOfItsParameters) {
    for (int round = 0; round < 400; ++round) {
        Scene scene = scene_of(kind(), Spread::none, random_);
        Node& node = scene.root.children[0];
        const std::vector<Parameter> list = parameters(node);
        for (std::size_t k = 0; k < list.size(); ++k) {
            const Parameter& parameter = list[k];
            for (int i = 0; i < parameter.components(); ++i) {
                const float choices[] = {
                    parameter.minimum, parameter.maximum, 0.0f, 1e-6f, -1e-30f, -0.5f, parameter.initial[i], 1e3f};
                node.values[k][i] = choices[random_() % std::size(choices)];
            }
            node.values[k] = clamped(parameter, node.values[k]);
        }
        SCOPED_TRACE(parameters_text(scene));
        const FieldEvaluator field(scene);
        for (int i = 0; i < 20; ++i) {
            glm::vec3 p = random_point(random_, i < 10 ? 2.0f : 1e4f);
            if (i < 7) p = glm::vec3(i & 1 ? p.x : 0.0f, i & 2 ? p.y : 0.0f, i & 4 ? p.z : 0.0f);  // on axes and planes
            ASSERT_TRUE(std::isfinite(field.distance(p))) << "at " << text(p);
        }
    }
}

}  // namespace
}  // namespace farfield
