// A hidden node counts as not there, in all that is made of a scene.
#include "sdf/audit.h"
#include "sdf/codegen.h"
#include "sdf/edit.h"
#include "sdf/evaluate.h"
#include "sdf/scene_file.h"
#include "tests/test_support.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace farfield {
namespace {

/// The scene without its hidden nodes.
void remove_hidden(Node& node) {
    std::erase_if(node.children, [](const Node& child) { return child.hidden; });
    for (Node& child : node.children) remove_hidden(child);
}

TEST(Hidden, CodeAndParametersAreThoseOfASceneWithoutTheNodes) {
    int hidden = 0;
    for (unsigned seed = 1; seed <= 40; ++seed) {
        std::mt19937 random(seed);
        Scene scene = random_scene(seed, 24);
        for (const Id id : all_ids(scene))
            if (id != scene.root.id && !find_definition(scene, id) && random() % 4 == 0)
                apply(scene, SetHidden{id, true}), ++hidden;
        Scene without = scene;
        remove_hidden(without.root);
        for (Node& definition : without.definitions) remove_hidden(definition);
        for (const Tier tier : {Tier::live, Tier::specialised}) {
            const GeneratedScene a = generate(scene, tier), b = generate(without, tier);
            ASSERT_EQ(a.text, b.text) << "seed " << seed;
            ASSERT_EQ(a.parameters, b.parameters) << "seed " << seed;
        }
        ASSERT_EQ(expanded_node_count(scene), expanded_node_count(without)) << "seed " << seed;
        const FieldEvaluator a(scene), b(without);
        for (int i = 0; i < 20; ++i) {
            glm::vec3 p;
            for (int axis = 0; axis < 3; ++axis) p[axis] = 4.0f * static_cast<float>(random()) / 4294967296.0f - 2.0f;
            ASSERT_EQ(a.distance(p), b.distance(p));
            ASSERT_EQ(a.material(p), b.material(p));
            ASSERT_EQ(a.owner(p), b.owner(p));
        }
    }
    EXPECT_GT(hidden, 100);
}

TEST(Hidden, ADefinitionHidesAllOfItsInstances) {
    Scene scene;
    const Id ball = apply(scene, InsertNode{scene.root.id, -1, make_node(NodeKind::sphere)});
    const Id instance = apply(scene, MakeDefinition{ball});
    EXPECT_FALSE(is_empty(scene, scene.root));
    apply(scene, SetHidden{ball, true});
    EXPECT_TRUE(is_empty(scene, scene.root));
    apply(scene, SetHidden{ball, false});
    apply(scene, SetHidden{instance, true});
    EXPECT_TRUE(is_empty(scene, scene.root));
    EXPECT_EQ(FieldEvaluator(scene).distance(glm::vec3(0.0f)), empty_distance);
}

TEST(Hidden, WhatIsHiddenIsNoMistake) {
    Scene scene;
    const Id group = apply(scene, InsertNode{scene.root.id, -1, make_node(NodeKind::subtract)});
    const Id inner = apply(scene, InsertNode{group, -1, make_node(NodeKind::mirror)});
    apply(scene, InsertNode{group, -1, make_node(NodeKind::sphere)});
    AuditOptions quick;
    quick.samples = 0;
    EXPECT_FALSE(audit(scene, quick).findings.empty());
    for (const Id id : {inner, group}) {
        Scene hidden = scene;
        apply(hidden, SetHidden{id, true});
        EXPECT_TRUE(audit(hidden, quick).findings.empty()) << audit(hidden, quick).findings[0].message;
    }
}

TEST(Hidden, FilesKeepWhatIsHiddenAndLocked) {
    Scene scene = random_scene(3, 12);
    const std::string plain = to_text(scene);
    const Id node = scene.root.children[0].id;
    apply(scene, SetHidden{node, true});
    apply(scene, SetLocked{node, true});
    const Scene read = parse_scene(to_text(scene), "memory");
    EXPECT_TRUE(read.root.children[0].hidden);
    EXPECT_TRUE(read.root.children[0].locked);
    EXPECT_EQ(to_text(read), to_text(scene));
    apply(scene, SetHidden{node, false});
    apply(scene, SetLocked{node, false});
    EXPECT_EQ(to_text(scene), plain);
    try {
        parse_scene("{\"farfield\": 1, \"root\": {\"kind\": \"union\",\n \"hidden\": 1}}", "a.json");
        FAIL() << "no error";
    } catch (const SceneFileError& error) {
        EXPECT_STREQ(error.what(), "a.json:2: root/hidden: found 1, expected true or false");
    }
}

TEST(Hidden, ShowOnlyShowsTheNodesAndWhatTheyAreIn) {
    for (unsigned seed = 1; seed <= 30; ++seed) {
        std::mt19937 random(seed);
        Scene scene = random_scene(seed, 20);
        const std::vector<Id> ids = all_ids(scene.root);
        for (const Id id : ids)
            if (random() % 3 == 0) apply(scene, SetHidden{id, true});
        const std::vector<Id> wanted{ids[random() % ids.size()], ids[random() % ids.size()]};
        const auto is_in = [&](Id id, Id other) {
            const std::vector<Id> below = all_ids(*find_node(scene, other));
            return std::find(below.begin(), below.end(), id) != below.end();
        };
        const Scene before = scene;
        apply(scene, ShowOnly{wanted});
        for (const Id id : ids) {
            const bool chosen = std::find(wanted.begin(), wanted.end(), id) != wanted.end();
            const bool inside =
                std::any_of(wanted.begin(), wanted.end(), [&](Id w) { return w != id && is_in(id, w); });
            const bool around =
                std::any_of(wanted.begin(), wanted.end(), [&](Id w) { return w != id && is_in(w, id); });
            bool out_of_sight = false;
            for (const Node* n = find_parent(scene, id); n; n = find_parent(scene, n->id)) out_of_sight |= n->hidden;
            const bool now = find_node(scene, id)->hidden;
            if (chosen || (around && id != scene.root.id)) {
                EXPECT_FALSE(now) << seed;
            } else if (inside) {
                EXPECT_EQ(now, find_node(before, id)->hidden) << "what is in it stays as it is";
            } else if (id != scene.root.id && !out_of_sight) {
                EXPECT_TRUE(now) << seed;
            }
        }
    }
}

}  // namespace
}  // namespace farfield
