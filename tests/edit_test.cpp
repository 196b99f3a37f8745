// The properties of edits: all or nothing, names and ids, and what undo brings back.
#include "sdf/history.h"
#include "sdf/scene_file.h"
#include "tests/test_support.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>

namespace farfield {
namespace {

struct Small {
    Scene scene;
    Id group, sphere, box;

    Small() {
        const Id root = scene.root.id;
        group = apply(scene, InsertNode{root, -1, named(NodeKind::union_, "group")});
        sphere = apply(scene, InsertNode{group, -1, named(NodeKind::sphere, "ball")});
        box = apply(scene, InsertNode{root, -1, named(NodeKind::box, "crate")});
    }

    static Node named(NodeKind kind, const char* name) {
        Node node = make_node(kind);
        node.name = name;
        return node;
    }
    ObjectRef node(Id id) const { return {ObjectType::node, id}; }
};

TEST(Edit, SetsAValue) {
    Small s;
    EXPECT_EQ(apply(s.scene, SetValue{s.node(s.sphere), "radius", glm::vec3(2.0f, 0, 0)}), 0u);
    EXPECT_EQ(value(s.scene, s.node(s.sphere), "radius").x, 2.0f);
}

/// Whole ones store it one below their minimum, others as 0, and nothing lies between.
TEST(Edit, AWordIsAValueBelowTheOthers) {
    const ObjectRef settings{ObjectType::settings, 0};
    Scene scene;
    for (const auto& [key, word, lowest] :
         {std::tuple("blur_levels", -1.0f, 0.0f), {"bounces", 0.0f, 1.0f}, {"noise", 0.0f, 0.1f}}) {
        for (const float v : {word, lowest}) {
            apply(scene, SetValue{settings, key, glm::vec3(v, 0.0f, 0.0f)});
            EXPECT_EQ(value(scene, settings, key).x, v) << key;
        }
        for (const float v : {word - 0.01f, 0.5f * (word + lowest), -1000.0f})
            EXPECT_THROW(apply(scene, SetValue{settings, key, glm::vec3(v, 0.0f, 0.0f)}), EditError) << key;
        for (const Parameter& parameter : parameters(scene, settings)) {
            if (parameter.key != std::string_view(key)) continue;
            EXPECT_EQ(clamped(parameter, glm::vec3(-1000.0f)).x, word) << key;
            EXPECT_EQ(clamped(parameter, glm::vec3(word + 0.9f * (lowest - word))).x, lowest) << key;
            EXPECT_TRUE(parameter.is_word(word) && !parameter.is_word(lowest)) << key;
        }
    }
}

TEST(Edit, LeavesTheSceneUntouchedOnError) {
    Small s;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    Node broken = make_node(NodeKind::torus);
    broken.values.pop_back();
    Node parent_primitive = make_node(NodeKind::box);
    parent_primitive.children.push_back(make_node(NodeKind::sphere));
    Node unknown_material = make_node(NodeKind::sphere);
    unknown_material.material = 4242;
    Light without_direction;
    without_direction.kind = LightKind::directional;
    without_direction.direction = glm::vec3(0.0f);
    const Id root = s.scene.root.id;
    const Edit refused[] = {
        SetValue{s.node(s.sphere), "radius", glm::vec3(-1.0f)},
        SetValue{s.node(s.sphere), "radius", glm::vec3(nan)},
        SetValue{s.node(s.sphere), "colour", glm::vec3(1.0f)},
        SetValue{s.node(4242), "radius", glm::vec3(1.0f)},
        SetName{s.node(s.sphere), "crate"},
        SetName{s.node(s.sphere), "a\nb"},
        SetName{{ObjectType::material, s.scene.materials[0].id}, ""},
        SetName{{ObjectType::sky}, "sky"},
        SetKind{s.group, NodeKind::sphere},
        SetKind{root, NodeKind::subtract},
        SetLightKind{4242, LightKind::point},
        SetMaterial{s.sphere, 4242},
        InsertNode{s.sphere, -1, make_node(NodeKind::box)},
        InsertNode{root, 7, make_node(NodeKind::box)},
        InsertNode{root, -1, broken},
        InsertNode{root, -1, parent_primitive},
        InsertNode{root, -1, unknown_material},
        RemoveNode{root},
        RemoveNode{4242},
        MoveNode{root, s.group, -1},
        MoveNode{s.group, s.group, -1},
        MoveNode{s.sphere, s.box, -1},
        MoveNode{s.box, s.group, 5},
        RemoveMaterial{s.scene.materials[0].id},
        AddLight{without_direction},
        RemoveLight{4242},
        AddBookmark{{0, "wide", {.field_of_view = 171.0f}}},
        RemoveBookmark{4242},
        MoveBookmark{4242, 0},
    };
    const std::string before = to_text(s.scene);
    const Id next = s.scene.next_id;
    for (const Edit& edit : refused) {
        EXPECT_THROW(apply(s.scene, edit), EditError) << describe(s.scene, edit);
        EXPECT_EQ(to_text(s.scene), before) << describe(s.scene, edit);
        EXPECT_EQ(s.scene.next_id, next) << describe(s.scene, edit);
    }
}

TEST(Edit, BookmarksAreAddedRenamedUpdatedMovedAndDeleted) {
    Scene scene;
    Camera wide;
    wide.field_of_view = 90.0f;
    const Id first = apply(scene, AddBookmark{}), second = apply(scene, AddBookmark{{0, "", wide}}),
             third = apply(scene, AddBookmark{{0, "door", wide}});
    const auto order = [&] {
        std::vector<Id> ids;
        for (const Bookmark& bookmark : scene.bookmarks) ids.push_back(bookmark.id);
        return ids;
    };
    EXPECT_EQ(order(), (std::vector<Id>{first, second, third}));
    EXPECT_EQ(find_bookmark(scene, second)->name, "view 2");
    EXPECT_EQ(find_bookmark(scene, second)->camera, wide);
    EXPECT_EQ(scene.camera, Camera{});

    const ObjectRef door{ObjectType::bookmark, third};
    EXPECT_THROW(apply(scene, SetName{door, "view"}), EditError);
    EXPECT_THROW(apply(scene, SetName{door, ""}), EditError);
    apply(scene, SetName{door, "window"});
    apply(scene, SetValue{door, "field_of_view", glm::vec3(20.0f, 0.0f, 0.0f)});
    EXPECT_THROW(apply(scene, SetValue{door, "field_of_view", glm::vec3(0.0f)}), EditError);
    EXPECT_EQ(find_bookmark(scene, third)->name, "window");
    EXPECT_EQ(find_bookmark(scene, third)->camera.field_of_view, 20.0f);

    apply(scene, MoveBookmark{third, 0});
    EXPECT_EQ(order(), (std::vector<Id>{third, first, second}));
    apply(scene, MoveBookmark{third, 1});
    EXPECT_EQ(order(), (std::vector<Id>{first, third, second}));
    for (const int index : {-1, 3}) EXPECT_THROW(apply(scene, MoveBookmark{third, index}), EditError);
    apply(scene, RemoveBookmark{first});
    EXPECT_EQ(order(), (std::vector<Id>{third, second}));
}

TEST(Edit, RefusesToMoveANodeBelowItself) {
    Small s;
    const Id inner = apply(s.scene, InsertNode{s.group, -1, make_node(NodeKind::subtract)});
    const Id innermost = apply(s.scene, InsertNode{inner, -1, make_node(NodeKind::mirror)});
    for (const Id target : {s.group, inner, innermost})
        EXPECT_THROW(apply(s.scene, MoveNode{s.group, target, -1}), EditError);
}

TEST(Edit, MoveIndexCountsBeforeTheNodeIsTakenOut) {
    Small s;
    const Id root = s.scene.root.id;
    const Id last = apply(s.scene, InsertNode{root, -1, make_node(NodeKind::torus)});
    const auto order = [&] {
        std::vector<Id> ids;
        for (const Node& child : s.scene.root.children) ids.push_back(child.id);
        return ids;
    };
    ASSERT_EQ(order(), (std::vector<Id>{s.group, s.box, last}));
    apply(s.scene, MoveNode{s.group, root, 2});
    EXPECT_EQ(order(), (std::vector<Id>{s.box, s.group, last}));
    apply(s.scene, MoveNode{last, root, 0});
    EXPECT_EQ(order(), (std::vector<Id>{last, s.box, s.group}));
    apply(s.scene, MoveNode{s.box, root, 1});
    apply(s.scene, MoveNode{s.box, root, 2});
    EXPECT_EQ(order(), (std::vector<Id>{last, s.box, s.group})) << "before and after itself a node stays where it is";
    apply(s.scene, MoveNode{last, root, -1});
    EXPECT_EQ(order(), (std::vector<Id>{s.box, s.group, last}));
}

TEST(Edit, MovesIntoALaterSibling) {
    Small s;
    const Id root = s.scene.root.id;
    apply(s.scene, MoveNode{s.box, root, 0});
    apply(s.scene, MoveNode{s.box, s.group, 0});
    ASSERT_EQ(s.scene.root.children.size(), 1u);
    const Node* group = find_node(s.scene, s.group);
    ASSERT_EQ(group->children.size(), 2u);
    EXPECT_EQ(group->children[0].id, s.box);
    EXPECT_EQ(group->children[1].id, s.sphere);
}

TEST(Edit, ChangeOfKindKeepsSharedValues) {
    Small s;
    apply(s.scene, SetValue{s.node(s.sphere), "radius", glm::vec3(3.0f, 0, 0)});
    apply(s.scene, SetKind{s.sphere, NodeKind::capsule});
    EXPECT_EQ(value(s.scene, s.node(s.sphere), "radius").x, 3.0f);
    EXPECT_EQ(value(s.scene, s.node(s.sphere), "half_height"), make_node(NodeKind::capsule).values[1]);
    EXPECT_EQ(find_node(s.scene, s.sphere)->name, "ball");
}

TEST(Edit, InsertedSubtreesGetFreeNames) {
    Small s;
    const Node copy = *find_node(s.scene, s.group);
    const Id second = apply(s.scene, InsertNode{s.scene.root.id, 0, copy});
    const Id third = apply(s.scene, InsertNode{s.scene.root.id, 0, *find_node(s.scene, second)});
    EXPECT_EQ(find_node(s.scene, second)->name, "group 2");
    EXPECT_EQ(find_node(s.scene, second)->children[0].name, "ball 2");
    EXPECT_EQ(find_node(s.scene, third)->name, "group 3");
    EXPECT_NE(find_node(s.scene, second)->children[0].id, s.sphere);
}

TEST(Edit, NodesOfARemovedMaterialInherit) {
    Small s;
    const Id red = apply(s.scene, AddMaterial{{0, "red"}});
    apply(s.scene, SetMaterial{s.sphere, red});
    apply(s.scene, RemoveMaterial{red});
    EXPECT_EQ(find_node(s.scene, s.sphere)->material, 0u);
}

TEST(Edit, EveryResultIsAValidScene) {
    // What the file reader accepts is valid: unique names, values in range, references to what exists.
    std::mt19937 random(7);
    Scene scene = random_scene(1, 12);
    int carried_out = 0;
    for (int i = 0; i < 3000; ++i) {
        const std::string before = to_text(scene);
        try {
            farfield::apply(scene, random_edit(scene, random));
            ++carried_out;
        } catch (const EditError&) {
            ASSERT_EQ(to_text(scene), before);
        }
        if (i % 10 == 0) {
            ASSERT_NO_THROW(parse_scene(to_text(scene), "memory")) << to_text(scene);
        }
        if (count_nodes(scene) > 60) scene = random_scene(static_cast<unsigned>(i), 12);
    }
    EXPECT_GT(carried_out, 1000);
}

TEST(History, UndoAllRestoresTheStartAndRedoAllTheEnd) {
    std::mt19937 random(11);
    History history(random_scene(3, 12));
    const std::string start = to_text(history.scene());
    int carried_out = 0;
    for (int i = 0; i < 400; ++i) {
        try {
            history.apply(random_edit(history.scene(), random), static_cast<unsigned>(random() % 3));
            ++carried_out;
        } catch (const EditError&) {}
    }
    ASSERT_GT(carried_out, 100);
    const std::string end = to_text(history.scene());
    while (history.can_undo()) history.undo();
    EXPECT_EQ(to_text(history.scene()), start);
    while (history.can_redo()) history.redo();
    EXPECT_EQ(to_text(history.scene()), end);
}

TEST(History, IdsAreNeverReused) {
    History history;
    std::set<Id> seen;
    for (const Id id : all_ids(history.scene())) seen.insert(id);
    for (int i = 0; i < 20; ++i) {
        const Id id = history.apply(InsertNode{history.scene().root.id, -1, make_node(NodeKind::sphere)});
        EXPECT_TRUE(seen.insert(id).second) << "id " << id;
        history.undo();
        if (i % 3 == 0) history.redo();
    }
}

TEST(History, OneGestureIsOneStep) {
    Small s;
    History history(s.scene);
    const ObjectRef ball = s.node(s.sphere);
    for (int i = 1; i <= 30; ++i)
        history.apply(SetValue{ball, "radius", glm::vec3(0.1f * static_cast<float>(i), 0, 0)}, 5);
    history.apply(SetValue{ball, "radius", glm::vec3(9.0f, 0, 0)}, 6);
    history.apply(SetValue{ball, "radius", glm::vec3(8.0f, 0, 0)});
    history.apply(SetValue{ball, "radius", glm::vec3(7.0f, 0, 0)});
    EXPECT_EQ(history.steps(), std::vector<std::string>(4, "radius of ball"));
    history.undo();
    history.undo();
    history.undo();
    EXPECT_EQ(value(history.scene(), ball, "radius").x, 0.1f * 30.0f);
    history.undo();
    EXPECT_EQ(value(history.scene(), ball, "radius").x, 0.5f);
    EXPECT_FALSE(history.can_undo());
}

TEST(History, AnEditAfterUndoForgetsWhatWasUndone) {
    Small s;
    History history(s.scene);
    history.apply(RemoveNode{s.box});
    history.undo();
    history.apply(RemoveNode{s.group});
    EXPECT_FALSE(history.can_redo());
    EXPECT_EQ(history.steps(), std::vector<std::string>{"delete group"});
}

TEST(History, ARefusedEditIsNoStep) {
    Small s;
    History history(s.scene);
    history.apply(RemoveNode{s.box});
    history.undo();
    const auto revision = history.revision();
    EXPECT_THROW(history.apply(RemoveNode{4242}), EditError);
    EXPECT_TRUE(history.can_redo());
    EXPECT_EQ(history.revision(), revision);
}

TEST(History, EqualRevisionsMeanEqualScenes) {
    std::mt19937 random(5);
    History history(random_scene(9, 8));
    std::map<std::uint64_t, std::string> texts;
    for (int i = 0; i < 600; ++i) {
        switch (random() % 4) {
            case 0:
                history.undo();
                break;
            case 1:
                history.redo();
                break;
            default:
                try {
                    history.apply(random_edit(history.scene(), random), static_cast<unsigned>(random() % 4));
                } catch (const EditError&) {}
        }
        const std::string text = to_text(history.scene());
        const auto [entry, fresh] = texts.try_emplace(history.revision(), text);
        ASSERT_EQ(entry->second, text) << "revision " << history.revision();
    }
    history.replace(random_scene(9, 8));
    EXPECT_FALSE(texts.contains(history.revision()));
}

}  // namespace
}  // namespace farfield
