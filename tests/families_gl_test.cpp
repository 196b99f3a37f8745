// A scene in families gives the picture of the whole, and what moves in them needs no new program.
#include "sdf/families.h"

#include "renderer/context.h"
#include "renderer/renderer.h"
#include "sdf/edit.h"
#include "sdf/scene_file.h"
#include "tests/gl_test.h"
#include "tests/test_support.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace farfield {
namespace {

constexpr FrameOptions small{.size = {96, 64}, .counting = true};

/// The same scene below an operation that changes nothing, which is not taken apart.
Scene whole(Scene scene) {
    Node round = make_node(NodeKind::round);
    round.id = scene.new_id();
    round.values[0] = glm::vec3(0.0f);
    round.children = std::move(scene.root.children);
    scene.root.children.assign(1, std::move(round));
    return scene;
}

/// `count` of each of some kinds, of many sizes, in many places: by themselves, in a subtraction, through instances.
Scene crowd(int count, unsigned seed) {
    Scene scene = parse_scene(R"({"farfield": 1,
        "camera": {"position": [0, 3, 9], "target": [0, 1, 0]},
        "sky": {"horizon": [0.6, 0.7, 0.8], "zenith": [0.3, 0.4, 0.6]},
        "materials": {"white": {"albedo": [0.8, 0.8, 0.8]}, "red": {"albedo": [0.8, 0.2, 0.1]},
                      "lamp": {"emission": [2, 2, 1]}},
        "lights": {"sun": {"kind": "directional", "direction": [-1, -2, -1], "intensity": [2, 2, 2]}},
        "definitions": [{"kind": "union", "name": "mushroom", "radius": 0.1, "children": [
            {"kind": "sphere", "radius": 0.3, "translate": [0, 0.5, 0], "material": "red"},
            {"kind": "capsule", "radius": 0.1}]}],
        "root": {"kind": "union", "children": [{"kind": "plane"}]}})",
                              "crowd");
    std::mt19937 random(seed);
    const auto number = [&](float low, float high) {
        return low + (high - low) * static_cast<float>(random() % 4096) / 4096.0f;
    };
    for (int i = 0; i < 3 * count; ++i) {
        Node node = i % 3 == 0   ? make_node(NodeKind::rounded_box)
                    : i % 3 == 1 ? make_instance(scene.definitions[0])
                                 : make_node(NodeKind::subtract);
        if (i % 3 == 2) {
            node.children = {make_node(NodeKind::sphere), make_node(NodeKind::box)};
            node.children[0].values[0] = glm::vec3(number(0.4f, 0.6f));
            node.children[1].transform.translate = {number(0.1f, 0.3f), 0.2f, 0.3f};
        }
        node.transform.translate = {number(-5, 5), number(0, 3), number(-5, 4)};
        if (i % 2) node.transform.rotate = {number(-90, 90), number(-90, 90), 0.0f};
        if (i % 5 == 0) node.material = scene.materials[random() % 3].id;
        const Id id = apply(scene, InsertNode{scene.root.id, -1, node});
        if (i % 4 == 0) apply(scene, SetValue{{ObjectType::node, id}, "scale", glm::vec3(number(0.5f, 1.2f))});
    }
    return scene;
}

class FamiliesOnGpu : public GlTest {
protected:
    static Image picture(Renderer& renderer, const Scene& scene, View view, FrameOptions options = small) {
        renderer.update(scene, options);
        renderer.render_frame();
        return renderer.read(view);
    }
};

TEST_F(FamiliesOnGpu, GiveThePictureOfTheWhole) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
        const Scene scene = crowd(44, seed);
        FamilyFinder finder;
        ASSERT_GE(finder.find(scene).size(), 3u);
        for (const View view : {View::depth, View::normals, View::direct, View::result}) {
            Renderer apart, together;
            // Members are met where they are, the whole within its tolerance.
            FrameOptions fine = small;
            fine.minimum_step = 0.1f;
            const Image a = picture(apart, scene, view, fine), b = picture(together, whole(scene), view, fine);
            EXPECT_EQ(count_invalid(a), 0u);
            // Rounding differs: a few rays that graze an edge meet it in one of the two, and a few go to another
            // emitter.
            const bool result = view == View::result;
            EXPECT_LE(differing_pixels(a, b, result ? 0.1f : 0.02f), result ? 80u : 25u)
                << seed << " of 6144, view " << static_cast<int>(view);
            const auto rays = static_cast<double>(together.statistics().rays);
            EXPECT_NEAR(static_cast<double>(apart.statistics().rays), rays, 0.005 * rays);
            EXPECT_EQ(apart.statistics().exhausted_rays, 0u);
        }
    }
}

TEST_F(FamiliesOnGpu, WhatMovesNeedsNoNewProgram) {
    Scene scene = crowd(44, 5);
    Renderer renderer;
    const Image before = picture(renderer, scene, View::depth);
    const auto compiles = [&] {
        return renderer.statistics().structural_compiles + renderer.statistics().specialisations;
    };
    const int all = compiles();
    FamilyFinder finder;
    for (const Family& family : finder.find(scene))
        for (const std::size_t i : {0u, 5u, 10u}) {
            const ObjectRef node{ObjectType::node, family.members.at(i)};
            apply(scene, SetValue{node, "translate", {0.2f * static_cast<float>(i) - 1.0f, 1.5f, 4.0f}});
            EXPECT_FALSE(renderer.needs_compile(scene, Tier::specialised)) << i;
        }
    const Image after = picture(renderer, scene, View::depth);
    EXPECT_EQ(compiles(), all);
    EXPECT_GT(differing_pixels(before, after, 0.1f), 100u);
    Renderer other;
    EXPECT_LE(differing_pixels(after, picture(other, whole(scene), View::depth), 0.02f), 25u);
}

TEST_F(FamiliesOnGpu, ARaysWorkHardlyGrowsWithTheScene) {
    std::vector<double> evaluations;
    for (const int count : {100, 1000}) {
        Scene scene = parse_scene(R"({"farfield": 1, "camera": {"position": [0, 0, 5], "target": [0, 0, 0]},
            "root": {"kind": "union", "children": [{"kind": "plane", "translate": [0, -1.2, 0]}]}})",
                                  "molecule");
        std::mt19937 random(1);
        const auto number = [&] { return static_cast<float>(random() % 2000) / 1000.0f - 1.0f; };
        while (static_cast<int>(scene.root.children.size()) <= count) {
            Node sphere = make_node(NodeKind::sphere);
            sphere.transform.translate = {number(), number(), number()};
            sphere.values[0] = glm::vec3(0.62f / std::cbrt(static_cast<float>(count)));
            apply(scene, InsertNode{scene.root.id, -1, sphere});
        }
        Renderer renderer;
        picture(renderer, scene, View::result);
        const Statistics& s = renderer.statistics();
        evaluations.push_back(static_cast<double>(s.evaluations) / static_cast<double>(s.rays));
    }
    EXPECT_LT(evaluations[1], 1.5 * evaluations[0]);  // of all thousand spheres by then, without families
}

/// All rays meet all members' boxes, which takes many turns of the tracer's loops.
TEST_F(FamiliesOnGpu, NoRayIsLostWhereAllMembersAreInTheWay) {
    for (const int count : {60, 300}) {
        std::string nodes;
        for (int i = 0; i < count; ++i)
            nodes +=
                fmt::format(R"({}{{"kind": "capped_torus", "major_radius": {}, "minor_radius": 0.01, "angle": 170}})",
                            i == 0 ? "" : ", ", 1.0 + 0.0003 * i);
        const Scene scene =
            parse_scene(fmt::format(R"({{"farfield": 1, "camera": {{"position": [0, 0, 4], "target": [0, 0, 0]}},
                "root": {{"kind": "union", "children": [{{"kind": "plane", "rotate": [90, 0, 0], "translate": [0, 0, -2]}}, {}]}}}})",
                                    nodes),
                        "tori");
        const FrameOptions options{.size = {128, 128}, .counting = true};
        Renderer renderer;
        const Image depth = picture(renderer, scene, View::depth, options);
        for (std::size_t i = 0; i < depth.pixels.size(); i += 3) ASSERT_GT(depth.pixels[i], 0.0f) << count;
        EXPECT_EQ(renderer.statistics().exhausted_rays, 0u);
    }
}

}  // namespace
}  // namespace farfield
