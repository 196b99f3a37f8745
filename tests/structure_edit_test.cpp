// Edits that rearrange the tree keep the picture; locks keep nodes from being moved and deleted.
#include "sdf/evaluate.h"
#include "sdf/placement.h"
#include "sdf/scene_file.h"
#include "tests/test_support.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>

namespace farfield {
namespace {

float uniform(std::mt19937& random, float low, float high) {
    return low + (high - low) * static_cast<float>(random() >> 8) * 0x1p-24f;
}

Transform random_transform(std::mt19937& random) {
    Transform t;
    for (int i = 0; i < 3; ++i) {
        if (random() % 4) t.translate[i] = uniform(random, -1.0f, 1.0f);
        if (random() % 3) t.rotate[i] = random() % 4 ? uniform(random, -180.0f, 180.0f) : 90.0f;
    }
    if (random() % 2) t.scale = uniform(random, 0.5f, 2.0f);
    return t;
}

glm::vec3 placed(const Transform& t, glm::vec3 p) { return rotation_matrix(t) * (t.scale * p) + t.translate; }

TEST(Placement, CompositionIsOneAfterTheOther) {
    std::mt19937 random(3);
    for (int i = 0; i < 2000; ++i) {
        const Transform a = random_transform(random), b = random_transform(random);
        const glm::vec3 p(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
        // Angles are rounded to 1e-4 degrees, 1.7e-6 rad; lengths are at most a few metres.
        EXPECT_LT(glm::distance(placed(composed(a, b), p), placed(a, placed(b, p))), 5e-5f);
        EXPECT_LT(glm::distance(placed(composed(a, relative_to(a, b)), p), placed(b, p)), 5e-5f);
    }
}

TEST(Placement, WithoutTurnsNumbersStayAsTheyWereTyped) {
    const Transform group{{1.0f, 2.0f, 3.0f}, {0.0f, 0.0f, 0.0f}, 1.0f},
        child{{0.1f, 0.2f, 0.3f}, {10.0f, 20.0f, 30.0f}, 0.7f};
    EXPECT_EQ(composed(group, child).rotate, child.rotate);
    EXPECT_EQ(composed({}, child), child);
    EXPECT_EQ(relative_to({}, child), child);
}

/// Unions of shapes inside each other, some with materials.
Scene scene_of_unions(unsigned seed) {
    std::mt19937 random(seed);
    Scene scene;
    const Id red = apply(scene, AddMaterial{{0, "red"}}), blue = apply(scene, AddMaterial{{0, "blue"}});
    std::vector<Id> groups{scene.root.id};
    for (int i = 0; i < 14; ++i) {
        Node node = make_node(random() % 3 == 0 ? NodeKind::union_ : random() % 2 ? NodeKind::box : NodeKind::sphere);
        node.transform = random_transform(random);
        node.material = random() % 3 == 0 ? red : random() % 3 == 0 ? blue : 0;
        const bool group = node.kind == NodeKind::union_;
        const Id id = apply(scene, InsertNode{groups[random() % groups.size()], -1, std::move(node)});
        if (group) groups.push_back(id);
    }
    return scene;
}

void expect_same_picture(const Scene& a, const Scene& b, std::mt19937& random) {
    const FieldEvaluator before(a), after(b);
    for (int i = 0; i < 50; ++i) {
        const glm::vec3 p(uniform(random, -3, 3), uniform(random, -3, 3), uniform(random, -3, 3));
        // Placement is exact to 5e-5 m for each of at most four groups, the last of which may scale by 16.
        ASSERT_NEAR(before.distance(p), after.distance(p), 1e-3f);
        // Close to where two shapes are equally near, rounding decides between their materials.
        const auto owner = before.owner(p);
        if (owner == after.owner(p)) {
            ASSERT_EQ(before.material(p), after.material(p));
        }
    }
}

TEST(WrapNodes, AGroupOfNodesOfAnyGroupsKeepsThePicture) {
    int wrapped = 0;
    for (unsigned seed = 1; seed <= 60; ++seed) {
        std::mt19937 random(seed);
        Scene scene = scene_of_unions(seed);
        const Scene before = scene;
        const std::vector<Id> ids = all_ids(scene.root);
        std::vector<Id> nodes;
        for (int i = 0; i < 3; ++i) nodes.push_back(ids[1 + random() % (ids.size() - 1)]);
        nodes = topmost(scene, nodes);
        const Id group = apply(scene, WrapNodes{nodes, NodeKind::union_, "group"});
        ++wrapped;
        const Node& made = *find_node(scene, group);
        std::vector<Id> inside;
        for (const Node& child : made.children) inside.push_back(child.id);
        EXPECT_EQ(inside, nodes);
        EXPECT_EQ(find_parent(scene, group)->id, find_parent(before, nodes[0])->id);
        expect_same_picture(before, scene, random);
        apply(scene, DissolveNode{group});
        expect_same_picture(before, scene, random);
    }
    EXPECT_EQ(wrapped, 60);
}

TEST(DissolveNode, KeepsThePictureAndTheMaterials) {
    int dissolved = 0;
    for (unsigned seed = 1; seed <= 60; ++seed) {
        std::mt19937 random(seed);
        Scene scene = scene_of_unions(seed);
        const Scene before = scene;
        for (const Id id : all_ids(scene.root))
            if (id != scene.root.id && find_node(scene, id)->kind == NodeKind::union_) {
                apply(scene, DissolveNode{id});
                ++dissolved;
            }
        expect_same_picture(before, scene, random);
        EXPECT_EQ(scene.root.children.size() + 1, all_ids(scene.root).size());
    }
    EXPECT_GT(dissolved, 100);
}

TEST(DissolveNode, WhatAHiddenGroupHeldStaysHidden) {
    Scene scene;
    const Id group = apply(scene, InsertNode{scene.root.id, -1, make_node(NodeKind::union_)});
    const Id ball = apply(scene, InsertNode{group, -1, make_node(NodeKind::sphere)});
    apply(scene, SetHidden{group, true});
    apply(scene, DissolveNode{group});
    EXPECT_TRUE(find_node(scene, ball)->hidden);
}

TEST(WrapNodes, RefusesWhatCannotBe) {
    Scene scene;
    const Id root = scene.root.id;
    const Id group = apply(scene, InsertNode{root, -1, make_node(NodeKind::union_)});
    const Id ball = apply(scene, InsertNode{group, -1, make_node(NodeKind::sphere)});
    const Id box = apply(scene, InsertNode{root, -1, make_node(NodeKind::box)});
    const Id instance = apply(scene, MakeDefinition{box});
    const std::string before = to_text(scene);
    const Edit refused[] = {
        WrapNodes{{}, NodeKind::union_, ""},
        WrapNodes{{ball}, NodeKind::sphere, ""},
        WrapNodes{{ball}, NodeKind::instance, ""},
        WrapNodes{{root}, NodeKind::union_, ""},
        WrapNodes{{group, ball}, NodeKind::union_, ""},
        WrapNodes{{ball, ball}, NodeKind::union_, ""},
        WrapNodes{{box}, NodeKind::union_, ""},
        WrapNodes{{ball, 4242}, NodeKind::union_, ""},
        WrapNodes{{ball}, NodeKind::union_, "a\nb"},
        DissolveNode{root},
        DissolveNode{ball},
        DissolveNode{box},
        DissolveNode{instance},
        DissolveNode{4242},
    };
    for (const Edit& edit : refused) {
        EXPECT_THROW(apply(scene, edit), EditError) << describe(scene, edit);
        EXPECT_EQ(to_text(scene), before) << describe(scene, edit);
    }
}

TEST(Locked, NodesStayWithAllThatIsInThem) {
    Scene scene;
    const Id root = scene.root.id;
    const Id outer = apply(scene, InsertNode{root, -1, make_node(NodeKind::union_)});
    const Id group = apply(scene, InsertNode{outer, -1, make_node(NodeKind::union_)});
    const Id ball = apply(scene, InsertNode{group, -1, make_node(NodeKind::sphere)});
    apply(scene, SetLocked{group, true});
    const std::string before = to_text(scene);
    const auto translate = [](Id id) { return SetValue{{ObjectType::node, id}, "translate", glm::vec3(1.0f)}; };
    const Edit refused[] = {
        RemoveNode{ball},         RemoveNode{group},   RemoveNode{outer},
        MoveNode{ball, root, -1}, translate(ball),     translate(group),
        MoveNode{group, root, 0}, DissolveNode{group}, WrapNodes{{outer, ball}, NodeKind::union_, ""}};
    for (const Edit& edit : refused) {
        EXPECT_THROW(apply(scene, edit), EditError) << describe(scene, edit);
        EXPECT_EQ(to_text(scene), before) << describe(scene, edit);
    }
    apply(scene, translate(outer));  // what holds it may move
    apply(scene, SetValue{{ObjectType::node, ball}, "radius", glm::vec3(2.0f)});
    apply(scene, SetLocked{group, false});
    EXPECT_NO_THROW(apply(scene, translate(ball)));
    EXPECT_NO_THROW(apply(scene, RemoveNode{group}));
}

TEST(Edits, AreCarriedOutTogetherOrNotAtAll) {
    Scene scene;
    const Id ball = apply(scene, InsertNode{scene.root.id, -1, make_node(NodeKind::sphere)});
    const std::string before = to_text(scene);
    const Edits edits{SetName{{ObjectType::node, ball}, "ball"}, RemoveNode{ball}, RemoveNode{ball}};
    EXPECT_THROW(apply_all(scene, edits), EditError);
    EXPECT_EQ(to_text(scene), before);
    EXPECT_EQ(describe(scene, Edits{RemoveNode{ball}, RemoveNode{ball}, RemoveNode{ball}}), "delete Sphere and 2 more");
}

}  // namespace
}  // namespace farfield
