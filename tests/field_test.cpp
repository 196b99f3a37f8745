// Properties of the field beyond those of every kind, which kinds_test tests.
#include "sdf/evaluate.h"

#include "sdf/edit.h"
#include "tests/test_support.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
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

TEST(Field, EdgeProfilesHaveTheTightestSafeDistance) {
    // Where both surfaces run side by side, a = y and b = y - offset, the distance is known: the height above the point
    // at which the profile's curve is met, and no factor less than 1 takes anything off it. kinds_test shows that they
    // are safe.
    constexpr float radius = 0.4f, steps = 3.0f;
    const std::vector<glm::vec3> v{{radius, 0.0f, 0.0f}, {steps, 0.0f, 0.0f}};
    for (const NodeKind kind : {NodeKind::chamfer_union, NodeKind::round_union, NodeKind::stairs_union}) {
        const auto combine = info(kind).combine;
        for (int i = -20; i <= 20; ++i) {
            const float offset = 0.019f * static_cast<float>(i);
            const float d = combine(0.0f, -offset, v);
            for (const float y : {-1.0f, 0.3f, 2.0f}) EXPECT_NEAR(combine(y, y - offset, v), y + d, 1e-6f) << i;
            EXPECT_NEAR(combine(-d, -d - offset, v), 0.0f, 1e-6f);
            const float a = -d, b = -d - offset;  // on the curve: hg_sdf's
            if (kind == NodeKind::chamfer_union) {
                EXPECT_NEAR(a + b, radius, 1e-6f);
            }
            if (kind == NodeKind::round_union) {
                EXPECT_NEAR(glm::length(glm::vec2(a - radius, b - radius)), radius, 1e-6f);
                EXPECT_LT(std::max(a, b), radius + 1e-6f);
            }
            if (kind == NodeKind::stairs_union) {  // on a tread or a riser: one of them is a multiple of a step
                constexpr float step = radius / (steps + 1.0f);
                EXPECT_TRUE(std::abs(std::remainder(a, step)) < 1e-6f || std::abs(std::remainder(b, step)) < 1e-6f)
                    << a;
            }
        }
    }
}

TEST(Field, ProfiledIntersectionsAndSubtractionsMirrorTheUnions) {
    using K = NodeKind;
    std::mt19937 random(9);
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    const std::vector<glm::vec3> v{{0.4f, 0.0f, 0.0f}, {3.0f, 0.0f, 0.0f}};
    const K kinds[][3] = {{K::union_, K::intersect, K::subtract},
                          {K::chamfer_union, K::chamfer_intersect, K::chamfer_subtract},
                          {K::round_union, K::round_intersect, K::round_subtract},
                          {K::stairs_union, K::stairs_intersect, K::stairs_subtract},
                          {K::columns_union, K::columns_intersect, K::columns_subtract}};
    for (const auto& [unite, intersect, subtract] : kinds)
        for (int i = 0; i < 1000; ++i) {
            const float a = uniform(random), b = uniform(random);
            EXPECT_NEAR(info(intersect).combine(a, b, v), -info(unite).combine(-a, -b, v), 1e-6f);
            EXPECT_NEAR(info(subtract).combine(a, b, v), -info(unite).combine(-a, b, v), 1e-6f);
            EXPECT_NEAR(info(unite).combine(a, b, v), info(unite).combine(b, a, v), 1e-6f);
            EXPECT_NEAR(info(unite).weight(a, b, v), 1.0f - info(unite).weight(b, a, v), 1e-6f);
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

TEST(Field, CopiesThatAreCutOffHaveNoSurfaceNearerThanTheySay) {
    std::mt19937 random(3);
    for (const Scene& scene : scenes_with_cut_copies()) {
        const FieldEvaluator field(scene);
        ASSERT_TRUE(field.tree().root->children[0].guarded);
        for (int i = 0; i < 400; ++i) {
            const glm::vec3 a = random_point(random, 2.0f);
            const float d = field.distance(a);
            for (int k = 0; k < 10 && std::abs(d) > 1e-4f; ++k) {
                const glm::vec3 way = glm::normalize(random_point(random, 1.0f)) * (std::abs(d) - 1e-4f);
                ASSERT_EQ(d > 0.0f, field.distance(a + way) > 0.0f) << d;
            }
        }
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
