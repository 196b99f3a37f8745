// Definitions and their instances: the same shape as copies, by one function; edits, files and limits.
#include "sdf/codegen.h"
#include "sdf/history.h"
#include "sdf/evaluate.h"
#include "sdf/scene_file.h"
#include "tests/test_support.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <random>

namespace farfield {
namespace {

/// A column of a shaft and a ring, shown twice; the ring has a material of its own.
struct Columns {
    Scene scene;
    Id gold, column, shaft, ring, first, second;

    Columns() {
        gold = apply(scene, AddMaterial{{0, "gold"}});
        Node top = make_node(NodeKind::union_), cylinder = make_node(NodeKind::capped_cylinder),
             torus = make_node(NodeKind::torus);
        top.name = "column";
        top.transform.translate = {1.0f, 0.0f, 0.0f};
        cylinder.name = "shaft";
        torus.name = "ring";
        torus.material = gold;
        top.children = {cylinder, torus};
        column = apply(scene, InsertNode{scene.root.id, -1, top});
        shaft = find_node(scene, column)->children[0].id;
        ring = find_node(scene, column)->children[1].id;
        first = apply(scene, MakeDefinition{column});
        Node instance = make_instance(scene.definitions[0]);
        instance.transform.translate = {-1.0f, 0.0f, 0.0f};
        instance.transform.scale = 0.5f;
        second = apply(scene, InsertNode{scene.root.id, -1, instance});
    }
};

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
}

glm::vec3 random_point(std::mt19937& random, float extent) {
    std::uniform_real_distribution<float> uniform(-extent, extent);
    const float x = uniform(random), y = uniform(random), z = uniform(random);
    return {x, y, z};
}

/// Distances agree but for rounding; where they are made safe by the bounds of the content, which are a little wider
/// for instances, to a few hundredths, and on the surface. Materials agree wherever they are no matter of that.
void expect_same_field(const Scene& a, const Scene& b) {
    const FieldEvaluator field_a(a), field_b(b);
    std::mt19937 random(1);
    const std::vector<Id> ids = all_ids(a);
    const bool bounded =
        std::any_of(ids.begin(), ids.end(), [&](Id id) { return info(find_node(a, id)->kind).stretch; });
    const float relative = bounded ? 0.03f : 0.0f;
    int other_material = 0;
    for (int i = 0; i < 2000; ++i) {
        const glm::vec3 p = random_point(random, 4.0f);
        const float d = field_a.distance(p);
        ASSERT_NEAR(d, field_b.distance(p), 1e-4f + relative * std::abs(d)) << p.x << " " << p.y << " " << p.z;
        other_material += field_a.material(p) != field_b.material(p);
    }
    EXPECT_LE(other_material, 20);
}

TEST(Instances, AreTheSameShapeAndMaterialAsCopies) {
    int instances = 0;
    for (unsigned seed = 0; seed < 60; ++seed) {
        SCOPED_TRACE(fmt::format("seed {}", seed));
        const Scene scene = random_scene(seed, 12);
        for (const Node& definition : scene.definitions) instances += count_uses(scene, definition.id);
        const Scene copies = expanded(scene);
        EXPECT_LE(static_cast<std::uint64_t>(count_nodes(copies)), 2 * expanded_node_count(scene));
        expect_same_field(scene, copies);
    }
    EXPECT_GT(instances, 30);
}

TEST(Instances, BoundsHoldWhatCopiesFill) {
    for (unsigned seed = 0; seed < 60; ++seed) {
        const Scene scene = random_scene(seed, 12);
        const Box box = FieldTree(scene).bounds(), of_copies = FieldTree(expanded(scene)).bounds();
        const FieldEvaluator field(scene);
        std::mt19937 random(seed);
        for (int i = 0; i < 3000; ++i) {
            const glm::vec3 p = random_point(random, 8.0f);
            if (field.distance(p) > 0.0f) continue;
            for (int axis = 0; axis < 3; ++axis) ASSERT_TRUE(p[axis] >= box.low[axis] && p[axis] <= box.high[axis]);
        }
        // Levels are rounded up by at most an eighth, margins add for each instance.
        for (int axis = 0; axis < 3; ++axis)
            if (of_copies.is_bounded(axis)) {
                EXPECT_LE(box.size()[axis], 1.15f * of_copies.size()[axis] + 1e-3f) << seed;
            }
    }
}

TEST(Instances, OwnMaterialShowsWhereTheDefinitionLeavesItOpen) {
    Columns c;
    const Id red = apply(c.scene, AddMaterial{{0, "red"}});
    apply(c.scene, SetMaterial{c.second, red});
    const auto material = [&](glm::vec3 p) { return FieldEvaluator(c.scene).material(p); };
    const glm::vec3 on_top{0.0f, 0.5f, 0.0f}, on_ring{0.65f, 0.0f, 0.0f};
    EXPECT_EQ(material(glm::vec3(1, 0, 0) + on_top), 0u);
    EXPECT_EQ(material(glm::vec3(1, 0, 0) + on_ring), 1u);
    EXPECT_EQ(material(glm::vec3(-1, 0, 0) + 0.5f * on_top), 2u);
    EXPECT_EQ(material(glm::vec3(-1, 0, 0) + 0.5f * on_ring), 1u);
    apply(c.scene, SetMaterial{c.scene.root.id, c.gold});
    EXPECT_EQ(material(glm::vec3(1, 0, 0) + on_top), 1u) << "inherited through the instance";
}

TEST(Instances, OfADefinitionWithoutShapeAreNothing) {
    Columns c;
    apply(c.scene, RemoveNode{c.shaft});
    EXPECT_FALSE(is_empty(c.scene, c.scene.root));
    apply(c.scene, RemoveNode{c.ring});
    EXPECT_TRUE(is_empty(c.scene, c.scene.root));
    EXPECT_NE(generate(c.scene, Tier::specialised).text.find("return 1000000000.0;"), std::string::npos);
}

TEST(Instances, ShareOneFunction) {
    Columns c;
    const GeneratedScene generated = generate(c.scene, Tier::specialised);
    EXPECT_EQ(count(generated.text, "float column_distance(vec3 p) {"), 1u) << generated.text;
    EXPECT_EQ(count(generated.text, "float column_surface(vec3 p, uint inherited, out uint material) {"), 1u);
    EXPECT_EQ(count(generated.text, "column_distance(p - vec3(1.0, 0.0, 0.0))"), 1u) << generated.text;
    EXPECT_EQ(count(generated.text, "0.5 * column_distance((p - vec3(-1.0, 0.0, 0.0)) / 0.5)"), 1u);
    EXPECT_EQ(count(generated.text, "float capped_cylinder("), 1u);
    EXPECT_EQ(count(generated.text, "capped_cylinder(p"), 2u) << "once for the distance, once with materials";

    // With one material all over, the distance is enough.
    apply(c.scene, SetMaterial{c.ring, 0});
    const std::string text = generate(c.scene, Tier::specialised).text;
    EXPECT_EQ(count(text, "column_surface"), 0u) << text;
    EXPECT_EQ(count(text, "material = 0u;"), 1u) << text;
}

TEST(Instances, OfEachOtherAreWrittenInOrderAndUnusedOnesNotAtAll) {
    Columns c;
    // "pair" comes later in the list and uses "column"; then "column" is made to use "bead", which comes last.
    Node group = make_node(NodeKind::union_);
    group.name = "pair";
    group.children = {make_instance(c.scene.definitions[0]), make_instance(c.scene.definitions[0])};
    const Id pair = apply(c.scene, InsertNode{c.scene.root.id, -1, group});
    apply(c.scene, MakeDefinition{pair});
    Node ball = make_node(NodeKind::sphere);
    ball.name = "bead";
    apply(c.scene, MakeDefinition{apply(c.scene, InsertNode{c.column, -1, ball})});
    Node unused = make_node(NodeKind::octahedron);
    unused.name = "unused";
    const Id instance = apply(c.scene, MakeDefinition{apply(c.scene, InsertNode{c.scene.root.id, -1, unused})});
    apply(c.scene, RemoveNode{instance});
    ASSERT_EQ(c.scene.definitions.size(), 4u);
    for (const Tier tier : {Tier::specialised, Tier::live}) {
        const std::string text = generate(c.scene, tier).text;
        const auto at = [&](const char* part) { return text.find(part); };
        EXPECT_LT(at("float bead_distance("), at("float column_distance("));
        EXPECT_LT(at("float column_distance("), at("float pair_distance("));
        EXPECT_LT(at("float pair_distance("), at("float scene_distance("));
        EXPECT_EQ(count(text, "unused"), 0u);
        EXPECT_EQ(count(text, "octahedron"), 0u);
    }
}

TEST(Instances, NamesMakeDifferentIdentifiersAndNoKey) {
    Columns c;
    Scene named = c.scene;
    const std::vector<std::string> names = {"scene",
                                            "twist",
                                            "no",
                                            "gl_Position",
                                            "3rd part",
                                            "säule / №1",
                                            "___",
                                            "column",
                                            "column 2",
                                            "Column",
                                            "COLUMN-2",
                                            std::string(500, 'x'),
                                            std::string(499, 'x'),
                                            "a__b",
                                            "@0",
                                            "\\"};
    for (const std::string& name : names) {
        Node ball = make_node(NodeKind::sphere);
        ball.name = name;
        apply(named, MakeDefinition{apply(named, InsertNode{named.root.id, -1, ball})});
    }
    const GeneratedScene generated = generate(named, Tier::specialised);
    std::set<std::string> functions;
    int found = 0;
    for (std::size_t at = generated.text.find("\nfloat "); at != std::string::npos;
         at = generated.text.find("\nfloat ", at + 1)) {
        const std::size_t start = at + 7, end = generated.text.find('(', start);
        const std::string function = generated.text.substr(start, end - start);
        EXPECT_TRUE(functions.insert(function).second) << function;
        EXPECT_EQ(function.find("__"), std::string::npos) << function;
        EXPECT_FALSE(function.starts_with("gl_"));
        EXPECT_FALSE(std::isdigit(static_cast<unsigned char>(function[0])));
        EXPECT_TRUE(std::all_of(function.begin(), function.end(),
                                [](unsigned char ch) { return ch < 128 && (std::isalnum(ch) || ch == '_'); }));
        ++found;
    }
    EXPECT_GE(found, static_cast<int>(names.size()));

    Scene renamed = c.scene;
    apply(renamed, SetName{{ObjectType::node, c.column}, "pillar"});
    for (const Tier tier : {Tier::specialised, Tier::live}) {
        const GeneratedScene before = generate(c.scene, tier), after = generate(renamed, tier);
        EXPECT_NE(before.text, after.text);
        EXPECT_EQ(before.key, after.key);
    }
}

TEST(Instances, LinesOfTheFunctionBelongToTheDefinition) {
    const Columns c;
    const GeneratedScene generated = generate(c.scene, Tier::specialised);
    ASSERT_EQ(generated.line_nodes.size(), count(generated.text, "\n"));
    std::size_t line = 0, start = 0, seen = 0;
    while (start < generated.text.size()) {
        const std::size_t end = generated.text.find('\n', start);
        const std::string text = generated.text.substr(start, end - start);
        const auto expect = [&](const char* part, Id id) {
            if (text.find(part) == std::string::npos) return;
            EXPECT_EQ(generated.line_nodes[line], id) << text;
            ++seen;
        };
        expect("float column_distance(", c.column);
        expect("vec2 column_march(", c.column);
        expect("capped_cylinder_along(p,", c.shaft);
        expect("capped_cylinder(p,", c.shaft);
        expect("torus(p,", c.ring);
        expect("column_distance(p - vec3(1.0", c.first);
        expect("column_march(p - vec3(1.0", c.first);
        expect("/ 0.5", c.second);
        start = end + 1;
        ++line;
    }
    EXPECT_EQ(seen, 2u + 1u + 2u + 3u + 2u + 3u);
}

TEST(Instances, TunedNodesMoveTheBlockAloneThroughTheirInstances) {
    // In a definition that is twisted and repeated where it is shown: what follows from its size is live there too.
    Columns c;
    Node twist = make_node(NodeKind::twist), repeat = make_node(NodeKind::repeat);
    twist.children = {make_instance(c.scene.definitions[0])};
    twist.children[0].transform.translate = {0.3f, 0.0f, 0.0f};
    repeat.children = {twist};
    repeat.values[0] = {5.0f, 0.0f, 0.0f};
    apply(c.scene, InsertNode{c.scene.root.id, -1, repeat});
    for (const Id tuned : {c.shaft, c.column, c.first, c.second}) {
        Scene moved = c.scene;
        const ObjectRef object{ObjectType::node, tuned};
        apply(moved, SetValue{object, "translate", {0.1f, 0.2f, 0.3f}});
        apply(moved, SetValue{object, "rotate", {10.0f, 20.0f, 30.0f}});
        apply(moved, SetValue{object, "scale", {1.5f, 0.0f, 0.0f}});
        const GeneratedScene before = generate(c.scene, Tier::specialised, tuned),
                             after = generate(moved, Tier::specialised, tuned);
        EXPECT_EQ(before.key, after.key);
        EXPECT_NE(before.parameters, after.parameters);
        EXPECT_EQ(before.parameters.size(), after.parameters.size());
    }
    // One set of values however many instances: translation, rotation, scale, two radii, material; then what follows
    // of one repetition (cells, centre, region) and one twist (reach, region).
    EXPECT_EQ(generate(c.scene, Tier::specialised, c.shaft).parameters.size(), 16u + 12u + 1u + 6u);
}

TEST(Instances, LiveMaterialsChangeTheBlockAlone) {
    Columns c;
    for (const Id node : {c.shaft, c.ring, c.column, c.first}) {
        for (const bool live : {false, true}) {
            if (!live && node == c.column) continue;  // a group's material is that of its children: theirs, not its own
            const auto made = [&](const Scene& scene) {
                return live ? generate(scene, Tier::live) : generate(scene, Tier::specialised, node);
            };
            Scene other = c.scene;
            apply(other, SetMaterial{node, find_node(other, node)->material ? 0 : c.gold});
            EXPECT_EQ(made(c.scene).key, made(other).key);
        }
    }
}

TEST(Instances, OfThirtyDefinitionsThatDoubleAreInstant) {
    // Different scales, placements and blends, so that no level of one instance is that of another.
    Scene scene;
    Id last = 0;
    for (int i = 0; i < 30; ++i) {
        Node group = make_node(NodeKind::union_);
        group.values[0].x = 0.01f * static_cast<float>(i + 1);
        for (int k = 0; k < 2; ++k) {
            Node child = last ? make_instance(*find_definition(scene, last)) : make_node(NodeKind::sphere);
            child.transform.translate = {0.3f * static_cast<float>(k), 0.1f, 0.0f};
            child.transform.scale = k ? 0.97f : 0.89f;
            group.children.push_back(child);
        }
        const Id made = apply(scene, InsertNode{scene.root.id, -1, group});
        const Id instance = apply(scene, MakeDefinition{made});
        if (i < 29) apply(scene, RemoveNode{instance});
        last = made;
    }
    EXPECT_EQ(expanded_node_count(scene), 3 * (std::uint64_t{1} << 30) - 1);
    EXPECT_TRUE(FieldTree(scene).bounds().is_bounded());
    EXPECT_LT(FieldTree(scene).bounds().size().x, 100.0f);
    for (const Tier tier : {Tier::live, Tier::specialised}) EXPECT_LT(generate(scene, tier).text.size(), 60'000u);
    EXPECT_EQ(to_text(parse_scene(to_text(scene), "a.json")), to_text(scene));

    // And 30 that are all empty.
    apply(scene, SetKind{scene.definitions[0].id, NodeKind::union_});
    while (!scene.definitions[0].children.empty()) apply(scene, RemoveNode{scene.definitions[0].children[0].id});
    EXPECT_TRUE(is_empty(scene, scene.root));
}

TEST(Instances, ExpandedCountSaturates) {
    std::string definitions = R"({"kind": "sphere", "name": "d0"})";
    for (int i = 1; i < 200; ++i)
        definitions +=
            fmt::format(R"(, {{"kind": "union", "name": "d{}", "children": [{{"kind": "instance", "of": "d{}"}},
                                       {{"kind": "instance", "of": "d{}"}}]}})",
                        i, i - 1, i - 1);
    const Scene scene =
        parse_scene(R"({"farfield": 1, "definitions": [)" + definitions +
                        R"(], "root": {"kind": "union", "children": [{"kind": "instance", "of": "d199"}]}})",
                    "a.json");
    EXPECT_EQ(expanded_node_count(scene), std::numeric_limits<std::uint64_t>::max());
    EXPECT_EQ(expanded_node_count(Scene()), 1u);
}

TEST(InstanceEdits, DefiningAndFreeingKeepThePictureAndAreUndone) {
    for (unsigned seed = 0; seed < 30; ++seed) {
        SCOPED_TRACE(fmt::format("seed {}", seed));
        History history(random_scene(seed, 10));
        const Scene start = history.scene();
        const std::string text = to_text(start);
        std::mt19937 random(seed);
        const std::vector<Id> ids = all_ids(start);
        for (int i = 0; i < 5; ++i) {
            const Id id = ids[random() % ids.size()];
            const Node* node = find_node(history.scene(), id);
            if (!node || !find_parent(history.scene(), id)) continue;
            const bool instance = node->kind == NodeKind::instance;
            const Id made = history.apply(instance ? Edit{MakeIndependent{id}} : Edit{MakeDefinition{id}});
            EXPECT_NE(find_node(history.scene(), made), nullptr);
            if (!instance)
                history.apply(MakeIndependent{history.apply(
                    InsertNode{history.scene().root.id, -1, make_instance(*find_definition(history.scene(), id))})}),
                    history.undo(), history.undo();
            expect_same_field(start, history.scene());
        }
        while (history.can_undo()) history.undo();
        EXPECT_EQ(to_text(history.scene()), text);
    }
}

TEST(InstanceEdits, DefinitionTakesTheNameAndTheInstanceThePlace) {
    const Columns c;
    const Node& instance = *find_node(c.scene, c.first);
    EXPECT_EQ(find_definition(c.scene, c.column)->transform.translate, glm::vec3(0.0f));
    EXPECT_EQ(instance.transform.translate, glm::vec3(1.0f, 0.0f, 0.0f));
    EXPECT_EQ(display_name(c.scene, instance), "instance of column");
    EXPECT_EQ(count_uses(c.scene, c.column), 2);

    Scene scene = c.scene;
    const Id copy = apply(scene, MakeIndependent{c.second});
    EXPECT_EQ(find_node(scene, copy)->name, "column 2");
    EXPECT_EQ(find_node(scene, copy)->children[0].name, "shaft 2");
    EXPECT_EQ(find_node(scene, copy)->transform.scale, 0.5f);
    EXPECT_EQ(find_node(scene, c.second), nullptr);
}

TEST(InstanceEdits, ADefinitionWithAPlacementKeepsItInTheCopy) {
    Columns c;
    apply(c.scene, SetValue{{ObjectType::node, c.column}, "translate", {0.0f, 0.5f, 0.0f}});
    apply(c.scene, SetMaterial{c.column, c.gold});
    Scene copies = c.scene;
    apply(copies, MakeIndependent{c.first});
    apply(copies, MakeIndependent{c.second});
    expect_same_field(c.scene, copies);
}

/// The message of an edit that is refused and leaves the scene as it was.
std::string refusal(Scene& scene, const Edit& edit) {
    const std::string before = to_text(scene);
    const Id next = scene.next_id;
    try {
        apply(scene, edit);
    } catch (const EditError& error) {
        EXPECT_EQ(to_text(scene), before);
        EXPECT_EQ(scene.next_id, next);
        return error.what();
    }
    return "carried out: " + describe(scene, edit);
}

TEST(InstanceEdits, RefusalsSayWhy) {
    Columns c;
    Scene& scene = c.scene;
    const Id group = apply(scene, InsertNode{scene.root.id, -1, make_node(NodeKind::union_)});
    EXPECT_EQ(refusal(scene, RemoveNode{c.column}),
              "column is shown by 2 instances: delete them first or make them independent");
    EXPECT_EQ(refusal(scene, InsertNode{c.column, -1, make_instance(scene.definitions[0])}),
              "column cannot contain an instance of itself");
    EXPECT_EQ(refusal(scene, MoveNode{c.second, c.column, 0}), "column cannot contain an instance of itself");
    EXPECT_EQ(refusal(scene, MoveNode{c.column, scene.root.id, -1}),
              "a definition stays where it is: add an instance of it");
    EXPECT_EQ(refusal(scene, SetName{{ObjectType::node, c.column}, ""}), "a definition needs a name");
    EXPECT_EQ(refusal(scene, MakeDefinition{c.column}), "column is a definition already");
    EXPECT_EQ(refusal(scene, MakeDefinition{c.first}), "instance of column shows a definition already");
    EXPECT_EQ(refusal(scene, MakeDefinition{scene.root.id}), "the root cannot become a definition");
    EXPECT_EQ(refusal(scene, MakeIndependent{c.shaft}), "shaft is no instance");
    EXPECT_EQ(refusal(scene, SetKind{c.shaft, NodeKind::instance}),
              "shaft cannot become an instance: add an instance of a definition instead");
    EXPECT_EQ(refusal(scene, InsertNode{group, -1, make_node(NodeKind::instance)}),
              "Instance: an instance shows a definition, and nothing else does");
    EXPECT_EQ(refusal(scene, SetDefinition{c.first, c.shaft}), fmt::format("there is no definition {}", c.shaft));

    // Through a second definition.
    apply(scene, MoveNode{c.second, group, -1});
    apply(scene, MakeDefinition{group});
    const Id inner = apply(scene, InsertNode{c.column, -1, make_node(NodeKind::union_)});
    EXPECT_EQ(refusal(scene, InsertNode{inner, -1, make_instance(*find_definition(scene, group))}),
              "column cannot contain an instance of itself");
    EXPECT_EQ(refusal(scene, SetDefinition{c.second, group}), "Union cannot contain an instance of itself");

    apply(scene, RemoveNode{c.first});
    EXPECT_EQ(refusal(scene, RemoveNode{c.column}),
              "column is shown by 1 instance: delete it first or make it independent");
    apply(scene, RemoveNode{c.second});
    apply(scene, RemoveNode{c.column});
    EXPECT_EQ(find_node(scene, c.shaft), nullptr);
}

TEST(InstanceEdits, NoEditNestsDeeperThanAFileCan) {
    Scene scene;
    Id top = scene.root.id;
    for (int i = 1; i < largest_depth - 1; ++i) top = apply(scene, InsertNode{top, -1, make_node(NodeKind::union_)});
    const Id ball = apply(scene, InsertNode{top, -1, make_node(NodeKind::sphere)});
    EXPECT_EQ(to_text(parse_scene(to_text(scene), "a.json")), to_text(scene));
    EXPECT_EQ(refusal(scene, MakeDefinition{ball}), "at most 499 nodes can be inside one another");
    const Id group = apply(scene, InsertNode{scene.root.id, -1, make_node(NodeKind::union_)});
    const Id part = apply(scene, InsertNode{group, -1, make_node(NodeKind::sphere)});
    apply(scene, MakeDefinition{part});
    EXPECT_EQ(refusal(scene, InsertNode{top, -1, make_instance(scene.definitions[0])}),
              "at most 499 nodes can be inside one another");
}

TEST(InstanceEdits, AreDescribed) {
    const Columns c;
    EXPECT_EQ(describe(c.scene, MakeDefinition{c.shaft}), "make shaft a definition");
    EXPECT_EQ(describe(c.scene, MakeIndependent{c.first}), "make instance of column independent");
    EXPECT_EQ(describe(c.scene, SetDefinition{c.first, c.column}), "let instance of column show column");
    EXPECT_EQ(describe(c.scene, InsertNode{c.scene.root.id, -1, make_instance(c.scene.definitions[0])}),
              "add instance of column");
}

const std::string small = R"({
  "farfield": 1,
  "materials": {
    "default": {}
  },
  "definitions": [
    {
      "kind": "union",
      "name": "a",
      "children": [
        {
          "kind": "instance",
          "of": "b"
        }
      ]
    },
    {
      "kind": "union",
      "name": "b"
    }
  ],
  "root": {
    "kind": "union",
    "children": [
      {
        "kind": "instance",
        "of": "a"
      }
    ]
  }
}
)";

void expect_error(std::string text, const std::string& from, const std::string& to, int line, const std::string& path,
                  const std::string& problem) {
    SCOPED_TRACE(to);
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    try {
        parse_scene(text, "a.json");
        ADD_FAILURE() << "no error; expected: " << problem;
    } catch (const SceneFileError& error) {
        EXPECT_EQ(error.line, line) << error.what();
        EXPECT_EQ(error.path, path);
        EXPECT_EQ(error.problem, problem);
    }
}

TEST(InstanceFiles, AreFixedPointsInAnyOrder) {
    const Scene scene = parse_scene(small, "a.json");
    EXPECT_EQ(to_text(scene), small);
    EXPECT_EQ(scene.definitions[0].children[0].definition, scene.definitions[1].id);
}

TEST(InstanceFiles, MistakesAreLocated) {
    expect_error(small, "\"of\": \"a\"", "\"of\": \"c\"", 27, "root/children[0]/of",
                 "there is no definition \"c\", expected one of a, b (perhaps a)");
    expect_error(small, "\"of\": \"a\"", "\"of\": 3", 27, "root/children[0]/of",
                 "found 3, expected the name of a definition");
    expect_error(small, ",\n        \"of\": \"a\"", "", 25, "root/children[0]",
                 "has no \"of\", expected the name of a definition");
    expect_error(small, "\"kind\": \"instance\",\n        \"of\"", "\"kind\": \"sphere\",\n        \"of\"", 27,
                 "root/children[0]/of",
                 "unknown key, expected one of kind, name, material, hidden, locked, radius, translate, rotate, scale");
    expect_error(small, "\"of\": \"a\"", "\"of\": \"a\", \"children\": []", 27, "root/children[0]/children",
                 "found an array of 0, expected none: an instance has no children");
    expect_error(small, "\"name\": \"b\"", "\"name\": \"a\"", 13, "definitions[0] \"a\"/children[0]/of",
                 "there is no definition \"b\", expected a");
    expect_error(small, "\"of\": \"b\"", "\"name\": \"b\", \"of\": \"b\"", 19, "definitions[1] \"b\"/name",
                 "found \"b\" again, expected a name of its own (the first is on line 13)");
    expect_error(small, "\"name\": \"a\",\n", "", 7, "definitions[0]",
                 "has no \"name\", expected one, by which instances refer to it");
    expect_error(small, "\"name\": \"b\"\n    }\n  ]", "\"name\": \"b\"\n    },\n    7\n  ]", 21, "definitions[2]",
                 "found 7, expected an object that describes a node");
    expect_error(small, "\"of\": \"b\"", "\"of\": \"a\"", 13, "definitions[0] \"a\"/children[0]/of",
                 "found \"a\", expected a definition that does not contain this instance itself");
    expect_error(small, "\"name\": \"b\"", "\"name\": \"b\", \"children\": [{\"kind\": \"instance\", \"of\": \"a\"}]",
                 19, "definitions[1] \"b\"/children[0]/of",
                 "found \"a\", expected a definition that does not contain this instance itself");
    expect_error(R"({"farfield": 1, "root": {"kind": "union", "children": [{"kind": "instance", "of": "a"}]}})", "", "",
                 1, "root/children[0]/of", "there is no definition \"a\": the file has no \"definitions\"");
    expect_error(R"({"farfield": 1, "root": {"kind": "union"}, "definitions": {}})", "", "", 1, "definitions",
                 "found an object, expected an array of nodes");
}

/// Definitions d0 ... d(n-1), each with an instance of another, and an instance of d0 in the tree.
std::string chain(int n, int step) {
    std::string text = R"({"farfield":1,"definitions":[)";
    for (int i = 0; i < n; ++i) {
        const int next = i + step;
        text += fmt::format(R"({}{{"kind":"union","name":"d{}","children":[{{"kind":)", i ? ",\n" : "", i);
        text += next >= 0 && next < n ? fmt::format(R"("instance","of":"d{}"}}]}})", next) : R"("sphere"}]})";
    }
    return text + R"(],"root":{"kind":"union","children":[{"kind":"instance","of":"d0"}]}})";
}

TEST(InstanceFiles, LongChainsAreErrorsInEitherDirectionAndEndSoon) {
    for (const int step : {1, -1}) {
        EXPECT_NO_THROW(parse_scene(chain(240, step), "a.json"));
        for (const int n : {260, 60'000}) try {
                parse_scene(chain(n, step), "a.json");
                ADD_FAILURE();
            } catch (const SceneFileError& error) {
                EXPECT_EQ(error.problem,
                          "is too deep, expected at most 499 nodes inside one another, instances "
                          "counted with what they show");
                EXPECT_GE(error.line, 1);
            }
    }
    // Many definitions that are not nested, each used once.
    std::string text = R"({"farfield":1,"definitions":[{"kind":"sphere","name":"d"})", instances;
    for (int i = 0; i < 50'000; ++i) {
        text += fmt::format(R"(,{{"kind":"sphere","name":"d{}"}})", i);
        instances += fmt::format(R"({}{{"kind":"instance","of":"d{}"}})", i ? "," : "", i);
    }
    const Scene scene = parse_scene(text + R"(],"root":{"kind":"union","children":[)" + instances + "]}}", "a.json");
    EXPECT_EQ(expanded_node_count(scene), 100'001u);
    EXPECT_FALSE(is_empty(scene, scene.root));
    EXPECT_EQ(FieldTree(scene).definitions.size(), 50'000u);
}

}  // namespace
}  // namespace farfield
