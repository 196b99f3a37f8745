// Properties of the field, over every kind of the table.
#include "sdf/evaluate.h"

#include "sdf/edit.h"
#include "tests/test_support.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace farfield {
namespace {

glm::vec3 random_point(std::mt19937& random, float extent) {
    std::uniform_real_distribution<float> uniform(-extent, extent);
    const float x = uniform(random), y = uniform(random), z = uniform(random);
    return {x, y, z};
}

/// A scene of one node of `kind`; an operation gets two primitives to work on.
Scene scene_of(NodeKind kind) {
    Scene scene;
    const Id id = apply(scene, InsertNode{scene.root.id, -1, make_node(kind)});
    if (!info(kind).takes_children()) return scene;
    Node box = make_node(NodeKind::box);
    box.values[0] = {0.3f, 0.2f, 0.25f};
    Node ball = make_node(NodeKind::sphere);
    ball.values[0].x = 0.3f;
    ball.transform.translate = {0.2f, 0.1f, 0.0f};
    apply(scene, InsertNode{id, -1, box});
    apply(scene, InsertNode{id, -1, ball});
    return scene;
}

class EveryKind : public testing::TestWithParam<NodeKind> {};
INSTANTIATE_TEST_SUITE_P(Table, EveryKind, testing::ValuesIn([] {
                             std::vector<NodeKind> kinds;
                             for (const KindInfo& kind : node_kinds()) kinds.push_back(kind.kind);
                             return kinds;
                         }()),
                         [](const auto& test) { return std::string(farfield::info(test.param).key); });

TEST_P(EveryKind, NeverClaimsMoreThanTheDistanceToAnotherSide) {
    // Where two points lie on different sides of the surface, the surface is between them: neither distance may exceed theirs.
    std::mt19937 random(7);
    const Scene scene = scene_of(GetParam());
    const FieldEvaluator field(scene);
    int pairs = 0;
    for (int i = 0; i < 200'000; ++i) {
        const glm::vec3 a = random_point(random, 1.5f);
        const glm::vec3 b = a + random_point(random, 0.3f);
        const float da = field.distance(a), db = field.distance(b);
        if ((da > 0.0f) == (db > 0.0f)) continue;
        ++pairs;
        ASSERT_LE(std::max(std::abs(da), std::abs(db)), glm::length(a - b) + 1e-5f)
            << "at " << a.x << " " << a.y << " " << a.z << " and " << b.x << " " << b.y << " " << b.z;
    }
    EXPECT_GT(pairs, 100);
}

TEST_P(EveryKind, AnswersFiniteNumbersAtTheLimitsOfItsParameters) {
    std::mt19937 random(11);
    const KindInfo& kind = info(GetParam());
    for (int round = 0; round < 200; ++round) {
        Scene scene = scene_of(GetParam());
        const ObjectRef node{ObjectType::node, scene.root.children[0].id};
        for (const Parameter& parameter : kind.parameters) {
            glm::vec3 v{0.0f};
            for (int i = 0; i < parameter.components(); ++i) {
                const float choices[] = {parameter.minimum, parameter.maximum, 0.0f, parameter.initial[i]};
                v[i] = choices[random() % 4];
            }
            v = clamped(parameter, v);
            set_value(scene, node, parameter.key, v);
        }
        const FieldEvaluator field(scene);
        for (int i = 0; i < 20; ++i) {
            const glm::vec3 p = i == 0 ? glm::vec3(0.0f) : random_point(random, i < 10 ? 2.0f : 1e4f);
            ASSERT_TRUE(std::isfinite(field.distance(p))) << kind.key << " at " << p.x << " " << p.y << " " << p.z;
        }
    }
}

TEST(Field, ScaleRescalesTheDistance) {
    Scene scene;
    Node ball = make_node(NodeKind::sphere);
    ball.transform.scale = 3.0f;
    apply(scene, InsertNode{scene.root.id, -1, ball});
    EXPECT_FLOAT_EQ(FieldEvaluator(scene).distance({5.0f, 0.0f, 0.0f}), 3.5f);
}

TEST(Field, RotationsTurnAboutXThenYThenZ) {
    Scene scene;
    Node box = make_node(NodeKind::box);
    box.values[0] = {2.0f, 0.1f, 0.1f};
    box.transform.rotate = {90.0f, 0.0f, 90.0f};  // the long axis stays on x, then turns to y
    apply(scene, InsertNode{scene.root.id, -1, box});
    EXPECT_NEAR(FieldEvaluator(scene).distance({0.0f, 3.0f, 0.0f}), 1.0f, 1e-6f);
}

TEST(Field, SmoothUnionIsOneLipschitzAndNoGreaterThanItsParts) {
    std::mt19937 random(3);
    const KindInfo& kind = info(NodeKind::union_);
    std::uniform_real_distribution<float> uniform(-2.0f, 2.0f);
    for (int i = 0; i < 100'000; ++i) {
        const std::vector<glm::vec3> v{{std::abs(uniform(random)), 0.0f, 0.0f}};
        const float a = uniform(random), b = uniform(random), da = 0.1f * uniform(random), db = 0.1f * uniform(random);
        const float f = kind.combine(a, b, v);
        ASSERT_LE(f, std::min(a, b) + 1e-6f);
        ASSERT_GE(f, std::min(a, b) - 0.25f * v[0].x - 1e-6f);
        ASSERT_LE(std::abs(kind.combine(a + da, b + db, v) - f), std::max(std::abs(da), std::abs(db)) + 1e-5f);
    }
}

TEST(Field, AsymmetricContentRepeatsWithoutOvershoot) {
    // A small ball at the edge of its cell: from the other half of the cell the neighbour's copy is nearer.
    Scene scene;
    Node repeat = make_node(NodeKind::repeat);
    repeat.values = {{1.0f, 0.0f, 1.0f}, {0.0f, 0.0f, 5.0f}};
    const Id id = apply(scene, InsertNode{scene.root.id, -1, repeat});
    Node ball = make_node(NodeKind::sphere);
    ball.values[0].x = 0.05f;
    ball.transform.translate = {0.4f, 0.0f, -0.4f};
    apply(scene, InsertNode{id, -1, ball});
    const FieldEvaluator field(scene);
    std::mt19937 random(5);
    for (int i = 0; i < 20'000; ++i) {
        const glm::vec3 p = random_point(random, 4.0f);
        float exact = 1e9f;
        for (int x = -8; x <= 8; ++x)
            for (int z = -2; z <= 2; ++z)
                exact = std::min(exact, glm::length(p - glm::vec3(float(x) + 0.4f, 0.0f, float(z) - 0.4f)) - 0.05f);
        ASSERT_NEAR(field.distance(p), exact, 1e-5f);
    }
}

TEST(Field, SmoothSeamsBlendMaterials) {
    EXPECT_EQ(blend_materials(3, 5, 0.0f), 3u);
    EXPECT_EQ(blend_materials(3, 5, 1.0f), 5u);
    const std::uint32_t half = blend_materials(3, 5, 0.5f);
    EXPECT_EQ(half & 0xfffu, 3u);
    EXPECT_EQ((half >> 12) & 0xfffu, 5u);
    EXPECT_NEAR(static_cast<double>(half >> 24), 127.5, 0.6);
}

}  // namespace
}  // namespace farfield
