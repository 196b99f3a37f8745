// Copy and paste as text: what is pasted is what was copied, in the same scene and in others.
#include "sdf/codegen.h"
#include "sdf/excerpt.h"
#include "sdf/scene_file.h"
#include "tests/test_support.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace farfield {
namespace {

Id paste(Scene& scene, const std::string& text, Id parent = 0) {
    return apply(scene, InsertExcerpt{parent ? parent : scene.root.id, -1, parse_excerpt(text)});
}

TEST(Excerpt, PastedIntoAnEmptySceneGivesTheSameShapes) {
    for (unsigned seed = 1; seed <= 40; ++seed) {
        const Scene scene = random_scene(seed, 20);
        std::vector<Id> nodes;
        for (const Node& node : scene.root.children) nodes.push_back(node.id);
        if (nodes.empty()) continue;
        Scene other;
        other.materials = scene.materials;  // the first one is for nodes without
        other.next_id = scene.next_id;
        other.root.material = scene.root.material;
        other.root.transform = scene.root.transform;
        other.root.values = scene.root.values;
        paste(other, to_text(excerpt(scene, nodes)));
        EXPECT_EQ(other.materials.size(), scene.materials.size());
        // Definitions are written in the order of their use in both.
        EXPECT_EQ(generate(other, Tier::specialised).text, generate(scene, Tier::specialised).text) << "seed " << seed;
    }
}

TEST(Excerpt, IsAWholeSceneFile) {
    for (const auto& file : bundled_scenes()) {
        const Scene scene = load_scene(file);
        for (const Node& node : scene.root.children)
            EXPECT_NO_THROW(parse_scene(to_text(excerpt(scene, {node.id})), "memory")) << file;
    }
}

TEST(Excerpt, MaterialsAndDefinitionsAreMatchedByNameAndContent) {
    Scene scene;
    const Id red = apply(scene, AddMaterial{{0, "red", glm::vec3(0.8f, 0.1f, 0.1f)}});
    Node ball = make_node(NodeKind::sphere);
    ball.material = red;
    ball.name = "ball";
    const Id id = apply(scene, InsertNode{scene.root.id, -1, ball});
    const Id instance = apply(scene, MakeDefinition{id});
    apply(scene, SetMaterial{id, red});
    const std::string copied = to_text(excerpt(scene, {instance}));
    const Id again = paste(scene, copied);
    EXPECT_EQ(scene.materials.size(), 2u);
    EXPECT_EQ(scene.definitions.size(), 1u);
    EXPECT_EQ(find_node(scene, again)->definition, id);

    apply(scene, SetValue{{ObjectType::material, red}, "albedo", glm::vec3(0.5f)});
    const Id other = paste(scene, copied);
    ASSERT_EQ(scene.materials.size(), 3u);
    EXPECT_EQ(scene.materials[2].name, "red 2");
    ASSERT_EQ(scene.definitions.size(), 2u);
    EXPECT_EQ(scene.definitions[1].name, "ball 2");
    EXPECT_EQ(scene.definitions[1].material, scene.materials[2].id);
    EXPECT_EQ(find_node(scene, other)->definition, scene.definitions[1].id);
    EXPECT_NO_THROW(parse_scene(to_text(scene), "memory"));
}

TEST(Excerpt, ADefinitionIsCopiedAsAnInstance) {
    Scene scene;
    const Id ball = apply(scene, InsertNode{scene.root.id, -1, make_node(NodeKind::sphere)});
    const Id instance = apply(scene, MakeDefinition{ball});
    const Scene part = excerpt(scene, {ball, instance});
    ASSERT_EQ(part.root.children.size(), 2u);
    EXPECT_EQ(part.root.children[1].kind, NodeKind::instance);
    EXPECT_NO_THROW(parse_scene(to_text(part), "memory"));
}

TEST(Excerpt, NodesOutOfAFileCanBePasted) {
    Scene scene;
    paste(scene, R"(
      {"kind": "sphere", "name": "a"},
      {"kind": "union", "children": [{"kind": "box"}]},
    )");
    ASSERT_EQ(scene.root.children.size(), 2u);
    EXPECT_EQ(scene.root.children[0].name, "a");
    EXPECT_EQ(scene.root.children[1].children[0].kind, NodeKind::box);
}

std::string problem_of(const std::string& text) {
    try {
        parse_excerpt(text);
    } catch (const EditError& error) {
        return error.what();
    }
    return "";
}

TEST(Excerpt, WhatIsNoSceneIsToldWithItsPlace) {
    EXPECT_EQ(problem_of(" \n"), "there is no text to paste");
    EXPECT_EQ(problem_of("hello"), "what was copied is no node: expected the text of a scene file, or nodes of one");
    EXPECT_EQ(problem_of("{\"kind\": \"sphere\",\n \"radius\": -1}"),
              "pasted text:2: root/children[0]/radius: found -1, expected a number at least 0 (and at most 1e+06)");
    EXPECT_NE(problem_of("{\"farfield\": 1,\n \"root\": }").find("pasted text:2: "), std::string::npos);
    EXPECT_NE(problem_of("{\"farfield\": 7, \"root\": {\"kind\": \"union\"}}").find("newer"), std::string::npos);
    EXPECT_NE(problem_of("{" + std::string(9'000'000, ' ') + "}").find("too large"), std::string::npos);
}

TEST(Excerpt, ARefusedPasteLeavesTheSceneAsItWas) {
    Scene scene;
    const Id ball = apply(scene, InsertNode{scene.root.id, -1, make_node(NodeKind::sphere)});
    const std::string before = to_text(scene);
    const auto good = parse_excerpt(R"({"kind": "box"})");
    EXPECT_THROW(apply(scene, InsertExcerpt{ball, -1, good}), EditError);
    EXPECT_THROW(apply(scene, InsertExcerpt{scene.root.id, 9, good}), EditError);
    EXPECT_THROW(apply(scene, InsertExcerpt{scene.root.id, -1, nullptr}), EditError);
    EXPECT_THROW(apply(scene, InsertExcerpt{scene.root.id, -1, std::make_shared<const Scene>()}), EditError);
    EXPECT_EQ(to_text(scene), before);
}

}  // namespace
}  // namespace farfield
