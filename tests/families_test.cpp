// What is alike in a large scene becomes one program with a table, and the boxes around it a tree.
#include "sdf/families.h"

#include "sdf/box_tree.h"
#include "sdf/code_lines.h"
#include "sdf/edit.h"
#include "sdf/field_tree.h"
#include "tests/test_support.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

namespace farfield {
namespace {

std::string replaced(const std::string& text, const std::regex& pattern,
                     const std::function<std::string(const std::smatch&)>& by) {
    std::string result;
    auto from = text.begin();
    for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match) {
        result.append(from, text.begin() + match->position()).append(by(*match));
        from = text.begin() + match->position() + match->length();
    }
    return result.append(from, text.end());
}

/// The code with every vector of one number written as one of three.
std::string with_whole_vectors(const std::string& code) {
    static const std::regex one(R"(vec3\((-?[0-9.e+-]+)\))");
    return replaced(code, one, [](const std::smatch& m) { return fmt::format("vec3({0}, {0}, {0})", m.str(1)); });
}

/// The family's code as member `index` has it.
std::string code_of(const Family& family, std::size_t index) {
    static const std::regex read(R"((uint\()?member([0-9]+)\.([xyzw])(\))?)");
    return replaced(family.code.key, read, [&](const std::smatch& m) {
        const std::size_t at = 4 * static_cast<std::size_t>(std::stoi(m.str(2))) + std::string("xyzw").find(m.str(3));
        const float number = family.numbers[4 * family.code.member_vectors * index + at];
        if (m[1].matched) return fmt::format("{}u", static_cast<unsigned>(number));
        return literal(number) + (m[4].matched ? ")" : "");
    });
}

/// What stands at the beginning of the functions, and the code without it.
std::string take_placement(std::string& code) {
    static const std::regex placement(R"( p = [^;]*;( v = [^;]*;)?)");
    std::smatch match;
    const std::size_t from = code.find("float scene_distance(");
    const std::string own = code.substr(from);
    EXPECT_TRUE(std::regex_search(own, match, placement));
    const std::string found = match.str();
    code = code.substr(0, from) + std::regex_replace(own, placement, "");
    return found;
}

Scene scene_with_families(unsigned seed, int kinds, int members) {
    std::mt19937 random(seed);
    Scene scene;
    for (int i = 0; i < 3; ++i) apply(scene, AddMaterial{});
    const Id group = apply(scene, InsertNode{scene.root.id, 0, make_node(NodeKind::union_)});
    apply(scene, SetValue{{ObjectType::node, group}, "rotate", glm::vec3(10.0f, 20.0f, 30.0f)});
    apply(scene, SetValue{{ObjectType::node, group}, "scale", glm::vec3(1.5f)});
    for (int i = 0; i < kinds; ++i) {
        const Node first = random_tree(static_cast<int>(random() % 3), random);
        for (int k = 0; k < members; ++k) {
            const Id id = apply(scene, InsertNode{random() % 2 ? group : scene.root.id, -1, first});
            const ObjectRef node{ObjectType::node, id};
            const auto number = [&] { return static_cast<float>(random() % 1000) / 100.0f - 5.0f; };
            apply(scene, SetValue{node, "translate", {number(), number(), number()}});
            if (random() % 2) apply(scene, SetValue{node, "rotate", {number(), number(), 0.0f}});
            if (random() % 2) apply(scene, SetMaterial{id, scene.materials[random() % scene.materials.size()].id});
            for (const Parameter& parameter : info(first.kind).parameters)
                if (random() % 2) apply(scene, SetValue{node, parameter.key, random_value(parameter, random)});
        }
    }
    return scene;
}

TEST(Families, EachMemberHasItsOwnCode) {
    std::size_t members = 0;
    for (unsigned seed = 1; seed <= 20; ++seed) {
        const Scene scene = scene_with_families(seed, 3, 50);
        std::vector<FieldTree> all = united(FieldTree(scene));
        FamilyFinder finder;
        for (const Family& family : finder.find(scene)) {
            ASSERT_EQ(family.bounds.size(), family.members.size());
            ASSERT_EQ(family.numbers.size(), 4 * family.code.member_vectors * family.members.size());
            for (std::size_t i = 0; i < family.members.size(); ++i, ++members) {
                FieldTree& tree = *std::find_if(all.begin(), all.end(),
                                                [&](const FieldTree& t) { return t.root->id == family.members[i]; });
                const FieldNode placed = *tree.root;
                EXPECT_EQ(family.bounds[i].low, placed.extent.box.low);
                move(*tree.root, glm::vec3(0.0f), glm::mat3(1.0f));
                std::string code = with_whole_vectors(code_of(family, i));
                const std::string place = take_placement(code);
                ASSERT_EQ(code, with_whole_vectors(generate(tree, Tier::specialised, 0, false).key)) << "seed " << seed;
                const std::string moved =
                    with_whole_vectors("(p - vec3(" + literal(placed.translate.x) + ", " + literal(placed.translate.y) +
                                       ", " + literal(placed.translate.z) + "))");
                EXPECT_NE(place.find(moved), std::string::npos) << place << " for " << moved;
                const bool turned = place.find("mat3") != std::string::npos;
                EXPECT_TRUE(turned || placed.to_own == glm::mat3(1.0f));
                if (turned) {
                    EXPECT_NE(place.find(literal(placed.to_own)), std::string::npos) << place;
                }
            }
        }
    }
    EXPECT_GT(members, 1000u);
}

Scene spheres(int count) {
    Scene scene;
    for (int i = 0; i < count; ++i) {
        const Id id = apply(scene, InsertNode{scene.root.id, -1, make_node(NodeKind::sphere)});
        apply(scene, SetValue{{ObjectType::node, id},
                              "translate",
                              {2.0f * static_cast<float>(i % 10), 0.5f, 2.0f * static_cast<float>(i / 10)}});
    }
    return scene;
}

TEST(Families, WhatIsTheSameStandsInTheCodeAndWhatDiffersInTheTable) {
    FamilyFinder finder;
    const std::vector<Family> families = finder.find(spheres(100));
    ASSERT_EQ(families.size(), 1u);
    EXPECT_EQ(families[0].members.size(), 100u);
    EXPECT_EQ(families[0].code.member_vectors, 1u);
    EXPECT_NE(families[0].code.text.find("p = (p - vec3(member0.x, 0.5, member0.y));"), std::string::npos);
    EXPECT_EQ(families[0].numbers[4 * 99], 18.0f);
    EXPECT_EQ(families[0].code.bounds.high.x, families[0].bounds[99].high.x);
    EXPECT_EQ(std::count(families[0].code.text.begin(), families[0].code.text.end(), '\n'),
              static_cast<std::ptrdiff_t>(families[0].code.line_nodes.size()));
}

TEST(Families, AnEditNeedsANewProgramOnlyWhenANumberDiffersForTheFirstTime) {
    FamilyFinder finder;
    Scene scene = spheres(100);
    const ObjectRef one{ObjectType::node, scene.root.children[7].id};
    const auto key = [&] { return finder.find(scene).at(0).code.key; };
    const std::string first = key();
    apply(scene, SetValue{one, "translate", {-3.0f, 0.5f, 1.0f}});
    EXPECT_EQ(key(), first);
    apply(scene, SetValue{one, "translate", {-3.0f, 0.6f, 1.0f}});
    const std::string higher = key();
    EXPECT_NE(higher, first);
    apply(scene, SetValue{one, "translate", {-3.0f, 0.7f, 1.0f}});
    EXPECT_EQ(key(), higher);
    apply(scene, SetValue{one, "translate", {-3.0f, 0.5f, 1.0f}});
    EXPECT_EQ(key(), higher);  // what stood in the table stays there
    apply(scene, RemoveNode{one.id});
    EXPECT_EQ(key(), higher);
    apply(scene, SetName{{ObjectType::node, scene.root.children[0].id}, "first"});
    EXPECT_EQ(key(), higher);
}

TEST(Families, WhatHasNoEndAndWhatIsTunedIsInNone) {
    Scene scene = spheres(100);
    for (int i = 0; i < 40; ++i) {
        const Id id = apply(scene, InsertNode{scene.root.id, -1, make_node(NodeKind::infinite_cylinder)});
        apply(scene, SetValue{{ObjectType::node, id}, "translate", glm::vec3(static_cast<float>(i))});
    }
    FamilyFinder finder;
    ASSERT_EQ(finder.find(scene).size(), 1u);
    const Id tuned = scene.root.children[0].id;
    const std::vector<Family> rest = finder.find(scene, tuned);
    EXPECT_EQ(rest.at(0).members.size(), 99u);
    EXPECT_EQ(std::count(rest[0].members.begin(), rest[0].members.end(), tuned), 0);
    EXPECT_TRUE(finder.find(spheres(31)).empty()) << "literals are faster";
    EXPECT_TRUE(finder.find(Scene()).empty());
}

/// The boxes whose leaves a ray comes to, in that order.
std::vector<std::int32_t> walk(const BoxTree& tree, glm::vec3 origin, glm::vec3 direction) {
    const std::size_t octant =
        (direction.x < 0.0f ? 1u : 0u) + (direction.y < 0.0f ? 2u : 0u) + (direction.z < 0.0f ? 4u : 0u);
    std::vector<std::int32_t> found;
    for (std::size_t at = 0; at < tree.size;) {
        const BoxTree::Node& node = tree.nodes.at(octant * tree.size + at);
        const glm::vec3 a = (node.low - origin) / direction, b = (node.high - origin) / direction;
        const glm::vec3 enter = glm::min(a, b), leave = glm::max(a, b);
        const bool meets = std::max({0.0f, enter.x, enter.y, enter.z}) <= std::min({leave.x, leave.y, leave.z});
        if (meets && node.box >= 0) found.push_back(node.box);
        const std::size_t next = meets ? at + 1 : static_cast<std::size_t>(node.next);
        EXPECT_GT(next, at);
        at = next;
    }
    return found;
}

TEST(BoxTree, ARayComesToAllBoxesThatItMeetsAndToNoOthersTheNearerFirst) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    const auto point = [&] { return glm::vec3(uniform(random), uniform(random), uniform(random)); };
    for (const int count : {1, 2, 7, 100, 1000}) {
        std::vector<Box> boxes;
        for (int i = 0; i < count; ++i) {
            const glm::vec3 p = 10.0f * point();
            boxes.push_back(Box{p, p}.grown(0.3f * std::abs(uniform(random))));
        }
        const BoxTree tree = make_box_tree(boxes);
        EXPECT_EQ(tree.size, 2u * boxes.size() - 1u);
        EXPECT_EQ(tree.nodes.size(), 8 * tree.size);
        int in_order = 0, pairs = 0;
        for (int i = 0; i < 300; ++i) {
            const glm::vec3 origin = 12.0f * point(), direction = point();
            std::vector<std::int32_t> found = walk(tree, origin, direction);
            for (std::size_t k = 1; k < found.size(); ++k, ++pairs)
                in_order += glm::dot(boxes[static_cast<std::size_t>(found[k])].centre() -
                                         boxes[static_cast<std::size_t>(found[k - 1])].centre(),
                                     direction) > 0.0f;
            std::sort(found.begin(), found.end());
            std::vector<std::int32_t> expected;
            for (std::size_t k = 0; k < boxes.size(); ++k)
                if (!walk(make_box_tree(std::span(boxes).subspan(k, 1)), origin, direction).empty())
                    expected.push_back(static_cast<std::int32_t>(k));
            ASSERT_EQ(found, expected);
            EXPECT_LE(found.size(), tree.longest_walk);
        }
        EXPECT_TRUE(pairs < 100 || in_order > 0.8 * pairs) << in_order << " of " << pairs;
    }
}

TEST(BoxTree, BoxesAtOnePlaceAndWithoutExtent) {
    const std::vector<Box> same(500, Box{glm::vec3(1.0f), glm::vec3(2.0f)}),
        points(500, Box{glm::vec3(1.0f), glm::vec3(1.0f)});
    for (const auto& boxes : {same, points}) {
        const BoxTree tree = make_box_tree(boxes);
        EXPECT_EQ(tree.size, 999u);
        EXPECT_EQ(walk(tree, glm::vec3(0.0f), glm::vec3(1.0f)).size(), 500u);
    }
    EXPECT_EQ(make_box_tree(same).longest_walk, 999u + 4u * 500u);
}

}  // namespace
}  // namespace farfield
