// Large scenes in parts: together they are the scene, and an edit touches few of them.
#include "sdf/scene_parts.h"

#include "sdf/codegen.h"
#include "sdf/edit.h"
#include "sdf/evaluate.h"
#include "tests/test_support.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace farfield {
namespace {

/// Several random trees and many primitives under hard unions.
Scene large_scene(unsigned seed, int nodes = 200) {
    std::mt19937 random(seed);
    Scene scene = random_scene(seed, 24);
    const Id group = apply(scene, InsertNode{scene.root.id, 0, make_node(NodeKind::union_)});
    while (count_nodes(scene) < nodes) {
        const Id parent = random() % 2 ? group : scene.root.id;
        apply(scene, InsertNode{parent, 0, random_tree(static_cast<int>(random() % 3), random)});
    }
    return scene;
}

std::vector<std::string> keys(const Scene& scene) {
    std::vector<std::string> keys;
    for (const Scene& part : scene_parts(scene)) keys.push_back(generate(part, Tier::live).key);
    return keys;
}

TEST(SceneParts, SmallScenesStayWhole) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        const Scene scene = random_scene(seed, 20);
        if (expanded_node_count(scene) > largest_whole_scene) continue;
        ASSERT_EQ(scene_parts(scene).size(), 1u);
        ASSERT_EQ(generate(scene_parts(scene)[0], Tier::specialised).text, generate(scene, Tier::specialised).text);
    }
}

TEST(SceneParts, TheNearestOfThemIsTheScene) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> place(-5.0f, 5.0f);
    for (unsigned seed = 1; seed <= 12; ++seed) {
        const Scene scene = large_scene(seed);
        const std::vector<Scene> parts = scene_parts(scene);
        ASSERT_GT(parts.size(), 2u);
        const FieldEvaluator whole(scene);
        std::vector<FieldEvaluator> evaluators(parts.begin(), parts.end());
        for (int i = 0; i < 300; ++i) {
            const glm::vec3 p(place(random), place(random), place(random));
            const auto nearest = std::min_element(
                evaluators.begin(), evaluators.end(),
                [&](const FieldEvaluator& a, const FieldEvaluator& b) { return a.distance(p) < b.distance(p); });
            ASSERT_EQ(nearest->distance(p), whole.distance(p)) << "seed " << seed;
            const auto ties = std::count_if(evaluators.begin(), evaluators.end(), [&](const FieldEvaluator& e) {
                return e.distance(p) == whole.distance(p);
            });
            if (ties > 1) continue;
            ASSERT_EQ(nearest->owner(p), whole.owner(p)) << "seed " << seed;
        }
    }
}

TEST(SceneParts, AnInsertedOrRemovedNodeChangesNoPartsButItsOwn) {
    std::mt19937 random(5);
    int all = 0, all_changed = 0;
    for (unsigned seed = 1; seed <= 12; ++seed) {
        const Scene before = large_scene(seed);
        const std::vector<std::string> known = keys(before);
        for (int i = 0; i < 6; ++i) {
            Scene scene = before;
            const std::vector<Node>& children = before.root.children;
            const int place = static_cast<int>(random() % (children.size() + 1));
            if (i % 2 == 0)
                apply(scene, InsertNode{before.root.id, place, make_node(NodeKind::sphere)});
            else
                apply(scene, RemoveNode{children[random() % children.size()].id});
            const std::vector<std::string> now = keys(scene);
            const auto changed = std::count_if(now.begin(), now.end(), [&](const std::string& key) {
                return std::find(known.begin(), known.end(), key) == known.end();
            });
            all += static_cast<int>(now.size());
            all_changed += static_cast<int>(changed);
        }
    }
    EXPECT_LT(all_changed, 2 * 12 * 6) << "of " << all;  // now and then what overflows moves the next end
}

TEST(SceneParts, NumbersDoNotMoveTheirEnds) {
    std::mt19937 random(7);
    Scene scene = large_scene(2);
    const std::vector<std::string> before = keys(scene);
    for (const Id id : all_ids(scene)) {
        const Node* node = find_node(scene, id);
        apply(scene, SetValue{{ObjectType::node, id}, "translate", glm::vec3(0.5f, -0.25f, 0.125f)});
        if (node->kind == NodeKind::sphere) apply(scene, SetValue{{ObjectType::node, id}, "radius", glm::vec3(0.4f)});
    }
    EXPECT_EQ(keys(scene), before);
}

TEST(SceneParts, WhatBlendsOrIsBentStaysTogether) {
    for (const NodeKind kind : {NodeKind::twist, NodeKind::mirror, NodeKind::intersect, NodeKind::columns_union}) {
        Scene scene;
        const Id group = apply(scene, InsertNode{scene.root.id, 0, make_node(kind)});
        for (int i = 0; i < 100; ++i) apply(scene, InsertNode{group, 0, make_node(NodeKind::box)});
        EXPECT_EQ(scene_parts(scene).size(), 1u) << info(kind).key;
    }
    Scene scene;
    for (int i = 0; i < 100; ++i) apply(scene, InsertNode{scene.root.id, 0, make_node(NodeKind::box)});
    EXPECT_GE(scene_parts(scene).size(), 3u);
    apply(scene, SetValue{{ObjectType::node, scene.root.id}, "radius", glm::vec3(0.1f)});
    EXPECT_EQ(scene_parts(scene).size(), 1u);
}

TEST(SceneParts, HiddenAndEmptyPartsAreLeftOut) {
    Scene scene;
    for (int i = 0; i < 100; ++i) apply(scene, InsertNode{scene.root.id, 0, make_node(NodeKind::union_)});
    EXPECT_EQ(scene_parts(scene).size(), 1u);
    EXPECT_FALSE(FieldTree(scene_parts(scene)[0]).root);
}

}  // namespace
}  // namespace farfield
