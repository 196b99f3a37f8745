// Operations on operations: what holds for every kind holds for trees of them.
#include "sdf/evaluate.h"
#include "tests/test_support.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace farfield {
namespace {

float uniform(std::mt19937& random, float low, float high) {
    return low + (high - low) * static_cast<float>(random() >> 8) * 0x1p-24f;
}

glm::vec3 random_point(std::mt19937& random, float half) {
    const float x = uniform(random, -half, half), y = uniform(random, -half, half);
    return {x, y, uniform(random, -half, half)};
}

std::string text(glm::vec3 p) { return fmt::format("({}, {}, {})", p.x, p.y, p.z); }

std::string outline(const Node& node, int depth = 0) {
    std::string text = fmt::format("\n{:{}}{}", "", 2 * depth, info(node.kind).key);
    for (const glm::vec3& v : node.values) text += fmt::format(" ({} {} {})", v.x, v.y, v.z);
    for (const Node& child : node.children) text += outline(child, depth + 1);
    return text;
}

class RandomTree : public testing::TestWithParam<unsigned> {
protected:
    /// A scene of one tree of depth six.
    Scene scene() {
        Scene scene;
        scene.root.children.push_back(random_tree(6, random_));
        return scene;
    }
    std::mt19937 random_{GetParam()};
};
INSTANTIATE_TEST_SUITE_P(DepthSix, RandomTree, testing::Range(0u, 8u));

/// Coordinates of about 2 m pass through six levels of rounding, 1.2e-7 relative each, scales up to 3 a level.
constexpr float rounding = 5e-5f;

TEST_P(RandomTree, IsOneLipschitz) {
    const Scene tree = scene();
    const FieldEvaluator field(tree);
    for (int i = 0; i < 1'000'000; ++i) {
        const glm::vec3 a = random_point(random_, 2.0f);
        const glm::vec3 direction = glm::normalize(random_point(random_, 1.0f) + 1e-6f);
        const glm::vec3 b = a + direction * std::exp2(uniform(random_, -10.0f, 0.0f));
        ASSERT_LE(std::abs(field.distance(a) - field.distance(b)), glm::length(a - b) + rounding)
            << "from " << text(a) << " to " << text(b) << outline(tree.root.children[0]);
    }
}

TEST_P(RandomTree, HasNoSurfaceNearerThanItSays) {
    const Scene tree = scene();
    const FieldEvaluator field(tree);
    for (int i = 0; i < 20'000; ++i) {
        const glm::vec3 a = random_point(random_, 2.0f);
        const float d = field.distance(a);
        for (int k = 0; k < 10 && std::abs(d) > rounding; ++k) {
            const glm::vec3 direction = glm::normalize(random_point(random_, 1.0f) + 1e-6f);
            const glm::vec3 b = a + direction * uniform(random_, 0.0f, std::min(std::abs(d) - rounding, 4.0f));
            ASSERT_EQ(d > 0.0f, field.distance(b) > 0.0f)
                << d << " at " << text(a) << ", another sign at " << text(b) << outline(tree.root.children[0]);
        }
    }
}

TEST_P(RandomTree, LiesWithinItsBounds) {
    const Scene tree = scene();
    const FieldEvaluator field(tree);
    const Box box = field.tree().bounds();
    for (int i = 0; i < 100'000; ++i) {
        const glm::vec3 p = random_point(random_, i % 2 ? 3.0f : 20.0f);
        if (field.distance(p) > 0.0f) continue;
        ASSERT_TRUE(glm::clamp(p, box.low, box.high) == p) << text(p) << outline(tree.root.children[0]);
    }
}

}  // namespace
}  // namespace farfield
