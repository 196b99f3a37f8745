// What emits, as boxes that rays are sent to.
#include "renderer/emitters.h"

#include "sdf/edit.h"
#include "tests/test_support.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace farfield {
namespace {

class Emitters : public testing::Test {
protected:
    Emitters() {
        lamp_ = apply(scene_, AddMaterial{Material{}});
        scene_.materials.back().emission = glm::vec3(2.0f);
    }
    Id add(NodeKind kind, glm::vec3 at = glm::vec3(0.0f), Id parent = 0, bool emits = true) {
        Node node = make_node(kind);
        node.transform.translate = at;
        if (emits) node.material = lamp_;
        return apply(scene_, InsertNode{parent > 0 ? parent : scene_.root.id, -1, node});
    }
    std::vector<EmitterRecord> found() const { return find_emitters(scene_, FieldTree(scene_)); }
    static void expect_box(const EmitterRecord& e, glm::vec3 low, glm::vec3 high) {
        EXPECT_LT(glm::length(e.low - low) + glm::length(e.high - high), 1e-3f)
            << e.low.x << " " << e.low.y << " " << e.low.z << " to " << e.high.x << " " << e.high.y << " " << e.high.z;
    }
    Scene scene_;
    Id lamp_ = 0;
};

TEST_F(Emitters, AreTheShapesThatEmit) {
    add(NodeKind::sphere, {}, 0, false);
    EXPECT_TRUE(found().empty());
    add(NodeKind::sphere, {3.0f, 2.0f, 1.0f});
    ASSERT_EQ(found().size(), 1u);
    const float r = make_node(NodeKind::sphere).values[0].x;
    expect_box(found()[0], glm::vec3(3.0f, 2.0f, 1.0f) - r, glm::vec3(3.0f, 2.0f, 1.0f) + r);
    scene_.materials.back().emission = glm::vec3(0.0f);
    EXPECT_TRUE(found().empty());
}

TEST_F(Emitters, WhatHasNoEndIsNone) {
    add(NodeKind::plane);
    EXPECT_TRUE(found().empty());
}

TEST_F(Emitters, OperationsAboveMoveThemCopyThemAndCutThem) {
    const float r = make_node(NodeKind::sphere).values[0].x;
    const Id mirror = add(NodeKind::mirror, {0.0f, 1.0f, 0.0f}, 0, false);
    add(NodeKind::sphere, {3.0f, 0.0f, 0.0f}, mirror);
    ASSERT_EQ(found().size(), 1u);
    expect_box(found()[0], {-3.0f - r, 1.0f - r, -r}, {3.0f + r, 1.0f + r, r});

    scene_.root.children.clear();
    const Id common = add(NodeKind::intersect, {}, 0, false);
    add(NodeKind::plane, {}, common, false);
    add(NodeKind::sphere, {}, common);
    ASSERT_EQ(found().size(), 1u);
    expect_box(found()[0], {-r, -r, -r}, {r, 0.0f, r});
}

TEST_F(Emitters, StandWhereInstancesOfThemStand) {
    // Another one, which has a material of its own.
    const Id other = add(NodeKind::union_, {}, 0, false);
    Node dark = make_node(NodeKind::box);
    dark.material = scene_.materials[0].id;
    apply(scene_, InsertNode{other, -1, dark});
    apply(scene_, MakeDefinition{other});
    const Id lamp = add(NodeKind::sphere);
    apply(scene_, MakeDefinition{lamp});
    Node instance = make_instance(scene_.definitions[1]);
    instance.transform.translate = {0.0f, 5.0f, 0.0f};
    apply(scene_, InsertNode{scene_.root.id, -1, instance});
    EXPECT_EQ(found().size(), 1u);  // the material is the first instance's
    instance.material = lamp_;
    apply(scene_, InsertNode{scene_.root.id, -1, instance});
    const std::vector<EmitterRecord> both = found();
    ASSERT_EQ(both.size(), 2u);
    const float r = make_node(NodeKind::sphere).values[0].x;
    expect_box(both[0].low.y > both[1].low.y ? both[0] : both[1], glm::vec3(0.0f, 5.0f, 0.0f) - r,
               glm::vec3(0.0f, 5.0f, 0.0f) + r);
}

TEST_F(Emitters, ManyAreThoseThatGiveMost) {
    for (std::size_t i = 0; i < 3 * most_emitters; ++i) {
        const Id id = add(NodeKind::sphere, {static_cast<float>(i), 0.0f, 0.0f});
        apply(scene_, SetValue{{ObjectType::node, id}, "radius", glm::vec3(0.001f * static_cast<float>(i + 1))});
    }
    const std::vector<EmitterRecord> most = found();
    ASSERT_EQ(most.size(), most_emitters);
    for (const EmitterRecord& e : most) EXPECT_GT(e.high.x, static_cast<float>(2 * most_emitters));
}

TEST_F(Emitters, CountFromTheCameraAndInUnitsOfOtherLight) {
    add(NodeKind::sphere, {1e6f, 0.0f, 0.0f});
    scene_.camera.position = {1e6f, 0.0f, 5.0f};
    scene_.camera.target = {1e6f, 0.0f, 0.0f};
    scene_.sky = {glm::vec3(1.0f), glm::vec3(1.0f)};
    ASSERT_EQ(found().size(), 1u);
    EXPECT_LT(glm::length(found()[0].low), 100.0f);
    EXPECT_FLOAT_EQ(found()[0].radiance, 2.0f);
    scene_.sky = {glm::vec3(4.0f), glm::vec3(4.0f)};
    EXPECT_FLOAT_EQ(found()[0].radiance, 0.5f);
    scene_.sky = {glm::vec3(0.0f), glm::vec3(0.0f)};
    EXPECT_TRUE(std::isfinite(found()[0].radiance));
    EXPECT_GT(found()[0].radiance, 1e5f);
}

}  // namespace
}  // namespace farfield
