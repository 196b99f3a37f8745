// Properties of the field beyond those of every kind, which kinds_test tests.
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
