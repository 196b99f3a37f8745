#include "sdf/pick.h"

#include "sdf/edit.h"
#include "sdf/scene_file.h"
#include "tests/test_support.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace farfield {
namespace {

constexpr glm::vec3 forward{0.0f, 0.0f, -1.0f};

Node ball(glm::vec3 centre, float radius) {
    Node node = make_node(NodeKind::sphere);
    node.values[0].x = radius;
    node.transform.translate = centre;
    return node;
}

TEST(Pick, FindsTheFirstShapeAndWhereItIs) {
    Scene scene;
    const Id front = apply(scene, InsertNode{scene.root.id, -1, ball({0.0f, 0.0f, 0.0f}, 1.0f)});
    const Id back = apply(scene, InsertNode{scene.root.id, -1, ball({0.0f, 1.5f, -5.0f}, 1.0f)});
    const FieldEvaluator field(scene);
    const std::optional<Pick> near = pick(field, {0.0f, 0.0f, 4.0f}, forward);
    ASSERT_TRUE(near);
    EXPECT_EQ(near->node, front);
    EXPECT_NEAR(near->distance, 3.0f, 1e-3f);
    EXPECT_NEAR(near->position.z, 1.0f, 1e-3f);
    const std::optional<Pick> far = pick(field, {0.0f, 1.5f, 4.0f}, forward);
    ASSERT_TRUE(far);
    EXPECT_EQ(far->node, back);
    EXPECT_FALSE(pick(field, {0.0f, 4.0f, 4.0f}, forward));
    EXPECT_FALSE(pick(field, {0.0f, 0.0f, 4.0f}, -forward));
    EXPECT_FALSE(pick(FieldEvaluator(Scene()), {0.0f, 0.0f, 4.0f}, forward));
}

TEST(Pick, ChoosesTheLargerPartOfABlendAndWhatACutLeavesBehind) {
    Scene scene;
    Node blend = make_node(NodeKind::union_);
    blend.values[0].x = 0.5f;
    const Id group = apply(scene, InsertNode{scene.root.id, -1, blend});
    const Id left = apply(scene, InsertNode{group, -1, ball({-1.0f, 0.0f, 0.0f}, 1.0f)});
    const Id right = apply(scene, InsertNode{group, -1, ball({1.0f, 0.0f, 0.0f}, 1.0f)});
    const FieldEvaluator field(scene);
    for (const float x : {-0.8f, -0.1f, 0.1f, 0.8f}) {
        const std::optional<Pick> hit = pick(field, {x, 0.0f, 4.0f}, forward);
        ASSERT_TRUE(hit) << x;
        EXPECT_EQ(hit->node, x < 0.0f ? left : right) << x;
    }

    Scene carved;
    const Id cut = apply(carved, InsertNode{carved.root.id, -1, make_node(NodeKind::subtract)});
    apply(carved, InsertNode{cut, -1, ball({}, 1.0f)});
    const Id tool = apply(carved, InsertNode{cut, -1, ball({0.0f, 0.0f, 1.0f}, 0.5f)});
    const std::optional<Pick> hollow = pick(FieldEvaluator(carved), {0.0f, 0.0f, 4.0f}, forward);
    ASSERT_TRUE(hollow);
    EXPECT_EQ(hollow->node, tool) << "its surface is what shows in the hollow";
}

TEST(Pick, NamesAShapeOfTheTreeInEveryBundledScene) {
    for (const auto& file : bundled_scenes()) {
        const Scene scene = load_scene(file);
        const FieldEvaluator field(scene);
        const CameraBasis basis(scene.camera);
        int hits = 0;
        for (int y = 0; y < 12; ++y)
            for (int x = 0; x < 16; ++x) {
                const glm::vec2 at((static_cast<float>(x) + 0.5f) / 16.0f, (static_cast<float>(y) + 0.5f) / 12.0f);
                const std::optional<Pick> hit =
                    pick(field, scene.camera.position, basis.direction(at, 4.0f / 3.0f), 1e-3f);
                if (!hit) continue;
                ++hits;
                const Node* node = find_node(scene, hit->node);
                ASSERT_TRUE(node) << file;
                EXPECT_FALSE(info(node->kind).takes_children()) << file;
                for (const Node* up = node; up->id != scene.root.id;) {
                    up = find_parent(scene, up->id);
                    ASSERT_TRUE(up) << file << ": " << node->name << " is not below the scene's root";
                }
            }
        EXPECT_GT(hits, 20) << file;
    }
}

}  // namespace
}  // namespace farfield
