#include "sdf/codegen.h"

#include "sdf/custom_code.h"
#include "sdf/edit.h"
#include "sdf/scene_file.h"
#include "tests/test_support.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace farfield {
namespace {

Scene ring_on_box() {
    Scene scene;
    Node ring = make_node(NodeKind::torus);
    ring.name = "ring";
    ring.transform.translate = {0.0f, 1.0f, 0.0f};
    apply(scene, InsertNode{scene.root.id, -1, make_node(NodeKind::box)});
    apply(scene, InsertNode{scene.root.id, -1, ring});
    return scene;
}

Id first_child(const Scene& scene) { return scene.root.children.at(0).id; }

TEST(Codegen, ReadsLikeHandWrittenCode) {
    const std::string text = generate(ring_on_box(), Tier::specialised).text;
    EXPECT_NE(text.find("float scene_distance(vec3 p) {\n"
                        "    // scene (union)\n"
                        "    float d0 = box(p, vec3(0.5));"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("    d0 = min(d0, torus(p - vec3(0.0, 1.0, 0.0), 0.5, 0.15));"), std::string::npos) << text;
    EXPECT_NE(text.find("// ring\n"), std::string::npos) << text;
}

TEST(Codegen, HoldsOnlyTheShapesThatTheSceneUses) {
    const std::string text = generate(ring_on_box(), Tier::specialised).text;
    for (const KindInfo& kind : node_kinds()) {
        if (kind.role == Role::instance) continue;
        const bool used = kind.kind == NodeKind::box || kind.kind == NodeKind::torus;
        if (!kind.function) continue;
        EXPECT_EQ(text.find(std::string(kind.function) + "(vec3 p") != std::string::npos, used) << kind.key;
    }
}

TEST(Codegen, RenamingChangesTheTextAndNotTheKey) {
    Scene scene = ring_on_box();
    for (const Tier tier : {Tier::live, Tier::specialised}) {
        const GeneratedScene before = generate(scene, tier);
        Scene renamed = scene;
        apply(renamed, SetName{{ObjectType::node, first_child(scene)}, "block"});
        const GeneratedScene after = generate(renamed, tier);
        EXPECT_NE(before.text, after.text);
        EXPECT_EQ(before.key, after.key);
    }
}

TEST(Codegen, NoNameReachesTheCode) {
    Scene scene = ring_on_box();
    apply(scene, SetName{{ObjectType::node, first_child(scene)}, "back\\slash \\"});
    const GeneratedScene generated = generate(scene, Tier::specialised);
    EXPECT_EQ(generated.text.find('\\'), std::string::npos);
    EXPECT_NE(generated.text.find("// back/slash /\n"), std::string::npos);
}

TEST(Codegen, NoParameterEditChangesTheLiveKey) {
    std::mt19937 random(1);
    for (unsigned seed = 0; seed < 20; ++seed) {
        Scene scene = random_scene(seed, 30);
        const GeneratedScene before = generate(scene, Tier::live);
        const std::vector<Id> ids = all_ids(scene);
        for (int edit = 0; edit < 100; ++edit) {
            const ObjectRef node{ObjectType::node, ids[random() % ids.size()]};
            const std::vector<Parameter> all = parameters(scene, node);
            const Parameter& parameter = all[random() % all.size()];
            apply(scene, SetValue{node, parameter.key, random_value(parameter, random)});
        }
        const GeneratedScene after = generate(scene, Tier::live);
        EXPECT_EQ(before.key, after.key);
        EXPECT_EQ(before.parameters.size(), after.parameters.size());
        EXPECT_NE(before.parameters, after.parameters);
    }
}

TEST(Codegen, MovingTheTunedNodeChangesTheBlockAlone) {
    Scene scene = ring_on_box();
    const Id ring = scene.root.children.at(1).id;
    const GeneratedScene before = generate(scene, Tier::specialised, ring);
    apply(scene, SetValue{{ObjectType::node, ring}, "major_radius", {0.7f, 0.0f, 0.0f}});
    apply(scene, SetValue{{ObjectType::node, ring}, "rotate", {10.0f, 20.0f, 30.0f}});
    const GeneratedScene after = generate(scene, Tier::specialised, ring);
    EXPECT_EQ(before.key, after.key);
    EXPECT_NE(before.parameters, after.parameters);
    // Translation, rotation, scale, two radii and the material of one node, nothing of the other.
    EXPECT_EQ(after.parameters.size(), 3u + 9u + 1u + 2u + 1u);
}

TEST(Codegen, StructuralEditsChangeTheLiveKey) {
    const Scene scene = ring_on_box();
    const std::string key = generate(scene, Tier::live).key;
    const Id box = first_child(scene);
    for (const Edit& edit : {Edit{RemoveNode{box}}, Edit{SetKind{box, NodeKind::sphere}},
                             Edit{InsertNode{scene.root.id, 0, make_node(NodeKind::sphere)}}}) {
        Scene edited = scene;
        apply(edited, edit);
        EXPECT_NE(generate(edited, Tier::live).key, key);
    }
}

/// Whether rays can share an invocation depends on it.
TEST(Codegen, CountsTheTurnsOfAllLoops) {
    for (const KindInfo& kind : node_kinds()) {
        if (kind.role == Role::instance) continue;
        Node node = make_node(kind.kind);
        if (kind.role != Role::primitive) node.children = {make_node(NodeKind::sphere), make_node(NodeKind::box)};
        Scene scene;
        const Id id = apply(scene, InsertNode{scene.root.id, -1, node});
        for (const Parameter& parameter : kind.parameters)
            if (kind.role == Role::repeat && parameter.type == ParameterType::integer)
                apply(scene, SetValue{{ObjectType::node, id}, parameter.key, glm::vec3(9.0f)});
        for (const Tier tier : {Tier::live, Tier::specialised}) {
            const GeneratedScene generated = generate(scene, tier);
            const std::string march =
                generated.text.substr(0, generated.surface_at) + generated.text.substr(generated.march_at);
            EXPECT_EQ(march.find("for (") != std::string::npos, generated.loop_turns > 0) << kind.key;
        }
    }
    Scene scene;
    Node bulb = make_node(NodeKind::mandelbulb);
    bulb.values[2].x = 10.0f;
    apply(scene, InsertNode{scene.root.id, -1, bulb});
    EXPECT_EQ(generate(scene, Tier::specialised).loop_turns, 2u * (10u + 2u));
    Node custom = make_node(NodeKind::custom);
    custom.code = CustomCode::parse(
                      "float sdf(vec3 p) {\n"
                      "    float d = 1.0;\n"
                      "    for (int i = 0; i < 8; ++i) d = min(d, length(p) - float(i));\n"
                      "    return d;\n"
                      "}\n")
                      .code;
    ASSERT_TRUE(custom.code);
    custom.values.resize(1);  // it has no uniforms
    apply(scene, InsertNode{scene.root.id, -1, custom});
    EXPECT_GE(generate(scene, Tier::specialised).loop_turns, 2u * (10u + 2u + 8u + 1u));
}

TEST(Codegen, EveryLineOfANodeNamesIt) {
    const Scene scene = ring_on_box();
    const GeneratedScene generated = generate(scene, Tier::specialised);
    EXPECT_EQ(generated.line_nodes.size(),
              static_cast<std::size_t>(std::count(generated.text.begin(), generated.text.end(), '\n')));
    std::size_t line = 0, start = 0;
    while (start < generated.text.size()) {
        const std::size_t end = generated.text.find('\n', start);
        const std::string text = generated.text.substr(start, end - start);
        if (text.find("torus(p -") != std::string::npos) {
            EXPECT_EQ(generated.line_nodes[line], scene.root.children[1].id) << text;
        }
        start = end + 1;
        ++line;
    }
}

TEST(Codegen, WhatALineCrossesInClosedFormIsCastAndTheRestMarched) {
    const auto subtraction = [](int cuts) {
        Node node = make_node(NodeKind::subtract);
        node.children.assign(static_cast<std::size_t>(cuts) + 1, make_node(NodeKind::sphere));
        return node;
    };
    Scene scene;
    const auto made = [&](Id tuned = 0) { return generate(scene, Tier::specialised, tuned); };
    apply(scene, InsertNode{scene.root.id, -1, make_node(NodeKind::plane)});
    apply(scene, InsertNode{scene.root.id, -1, subtraction(5)});
    EXPECT_TRUE(made().casts && !made().marches);
    EXPECT_EQ(made().text.find("scene_march("), std::string::npos);

    // A blend is marched, and so is what too many are taken away from; not the plane, so that the march has an end.
    Node blend = make_node(NodeKind::union_);
    blend.values[0].x = 0.1f;
    blend.children = {make_node(NodeKind::capsule), make_node(NodeKind::cone)};
    apply(scene, InsertNode{scene.root.id, -1, blend});
    apply(scene, InsertNode{scene.root.id, -1, subtraction(6)});
    const GeneratedScene both = made();
    EXPECT_TRUE(both.casts && both.marches);
    EXPECT_FALSE(both.bounds.is_bounded());
    EXPECT_TRUE(both.marched_bounds.is_bounded());
    EXPECT_EQ(both.text.find("plane_along("), std::string::npos);

    // Whether a live union has hard edges is not known. A live primitive is what it is.
    EXPECT_FALSE(made(scene.root.id).casts);
    EXPECT_TRUE(made(first_child(scene)).casts);
    EXPECT_FALSE(generate(scene, Tier::live).casts);
    EXPECT_FALSE(generate(scene, Tier::specialised, 0, true).casts);
}

TEST(Codegen, AnEmptySceneIsFarFromEverything) {
    EXPECT_NE(generate(Scene(), Tier::specialised).text.find("return 1000000000.0;"), std::string::npos);
    Scene scene;  // nothing minus a box is nothing
    const Id subtract = apply(scene, InsertNode{scene.root.id, -1, make_node(NodeKind::subtract)});
    apply(scene, InsertNode{subtract, -1, make_node(NodeKind::union_)});
    apply(scene, InsertNode{subtract, -1, make_node(NodeKind::box)});
    EXPECT_NE(generate(scene, Tier::specialised).text.find("return 1000000000.0;"), std::string::npos);
}

}  // namespace
}  // namespace farfield
