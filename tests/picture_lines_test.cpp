// The outline of what is selected and the grid on the ground, without a window.
#include "app/picture_lines.h"

#include "sdf/edit.h"
#include "sdf/scene_file.h"
#include "tests/test_support.h"

#include <gtest/gtest.h>

#include <cmath>

namespace farfield {
namespace {

using glm::vec2;
using glm::vec3;

const auto never = [] { return false; };

Node ball(vec3 centre, float radius) {
    Node node = make_node(NodeKind::sphere);
    node.values[0].x = radius;
    node.transform.translate = centre;
    return node;
}

PictureView view_of(const Scene& scene) { return {scene.camera, {40.0f, 20.0f}, {640.0f, 480.0f}}; }

Scene looking_along_z() {
    Scene scene;
    scene.camera.position = {0, 0, 6};
    scene.camera.target = {0, 0, 0};
    return scene;
}

std::vector<Segment> outline(const Scene& scene, Id node) {
    const FieldEvaluator field(scene);
    return outline_of(field, view_of(scene), shapes_of(scene, node), world_bounds(field.tree(), node), 5000, never);
}

float length(const std::vector<Segment>& segments) {
    float sum = 0.0f;
    for (const auto& [a, b] : segments) sum += glm::distance(a, b);
    return sum;
}

TEST(Outline, OfASphereIsItsCircleToHalfAPixel) {
    Scene scene = looking_along_z();
    const Id id = apply(scene, InsertNode{scene.root.id, -1, ball({}, 1.0f)});
    const PictureView view = view_of(scene);
    // A sphere of radius r at distance d is seen within an angle whose sine is r / d.
    const float radius = std::tan(std::asin(1.0f / 6.0f)) / view.basis.half_height * 240.0f;
    const std::vector<Segment> segments = outline(scene, id);
    ASSERT_GT(segments.size(), 50u);
    for (const auto& [a, b] : segments)
        for (const vec2 p : {a, b}) EXPECT_NEAR(glm::distance(p, vec2(360, 260)), radius, 0.5f);
    EXPECT_NEAR(length(segments), 6.2832f * radius, 0.05f * radius);
}

TEST(Outline, IsOfWhatIsToBeSeen) {
    Scene scene = looking_along_z();
    const Id front = apply(scene, InsertNode{scene.root.id, -1, ball({0.0f, 0.0f, 2.0f}, 0.7f)});
    const Id behind = apply(scene, InsertNode{scene.root.id, -1, ball({0.0f, 0.0f, -2.0f}, 0.5f)});
    EXPECT_FALSE(outline(scene, front).empty());
    EXPECT_TRUE(outline(scene, behind).empty()) << "hidden";
    const Id beside = apply(scene, InsertNode{scene.root.id, -1, ball({0.5f, 0.0f, 0.0f}, 0.7f)});
    const FieldEvaluator field(scene);
    for (const auto& [a, b] : outline(scene, beside)) {
        const vec2 middle = 0.5f * (a + b) - vec2(360, 260);
        EXPECT_GT(glm::length(middle), 0.7f / 4.0f * 0.9f / view_of(scene).basis.half_height * 240.0f)
            << "not across what is in front";
    }
    apply(scene, RemoveNode{beside});
    EXPECT_TRUE(outline(scene, 0).empty());
    EXPECT_TRUE(outline(scene, 9999).empty());
}

TEST(Outline, StopsWhenAskedTo) {
    Scene scene = looking_along_z();
    const Id id = apply(scene, InsertNode{scene.root.id, -1, ball({}, 1.0f)});
    const FieldEvaluator field(scene);
    EXPECT_TRUE(outline_of(field, view_of(scene), shapes_of(scene, id), {}, 5000, [] { return true; }).empty());
}

TEST(Outline, OfAnyNodeOfTheBundledScenesLiesInThePicture) {
    for (const auto& file : bundled_scenes()) {
        const Scene scene = load_scene(file);
        const FieldEvaluator field(scene);
        const PictureView view(scene.camera, {0, 0}, {96, 64});
        for (const Node& child : scene.root.children)
            for (const auto& [a, b] :
                 outline_of(field, view, shapes_of(scene, child.id), world_bounds(field.tree(), child.id), 500, never))
                for (const vec2 p : {a, b})
                    EXPECT_TRUE(p.x >= 0.0f && p.y >= 0.0f && p.x <= 96.0f && p.y <= 64.0f)
                        << file << ' ' << child.name;
    }
}

TEST(ShapesOf, AreThoseBelowANodeAndTheInstancesThatShowADefinition) {
    const Scene scene = parse_scene(R"({"farfield": 1,
        "definitions": [
            {"kind": "union", "name": "inner", "children": [{"kind": "sphere"}]},
            {"kind": "union", "name": "outer", "children": [{"kind": "instance", "of": "inner"}, {"kind": "box"}]}],
        "root": {"kind": "union", "children": [
            {"kind": "union", "children": [{"kind": "sphere"}, {"kind": "instance", "of": "inner"}]},
            {"kind": "instance", "of": "outer"}, {"kind": "box"}]}})",
                                    "test");
    const auto& children = scene.root.children;
    const auto& group = children[0].children;
    EXPECT_EQ(shapes_of(scene, children[0].id), (std::set<Id>{group[0].id, group[1].id}));
    EXPECT_EQ(shapes_of(scene, children[2].id), std::set<Id>{children[2].id});
    EXPECT_EQ(shapes_of(scene, children[1].id), std::set<Id>{children[1].id});
    const Id ball_of_inner = scene.definitions[0].children[0].id, box_of_outer = scene.definitions[1].children[1].id;
    EXPECT_EQ(shapes_of(scene, ball_of_inner), (std::set<Id>{group[1].id, children[1].id}));
    EXPECT_EQ(shapes_of(scene, box_of_outer), std::set<Id>{children[1].id});
    EXPECT_TRUE(shapes_of(scene, 9999).empty());
}

TEST(GroundGrid, LiesOnWholeStepsAboutTheTargetAndIsHiddenByWhatIsInFront) {
    Scene scene;
    scene.camera.position = {0, 4, 8};
    scene.camera.target = {7.4f, 0, -3.2f};
    const GroundGrid grid(scene.camera);
    EXPECT_EQ(grid.step, 1.0f);
    const vec3 middle = grid.point(0, GroundGrid::lines / 2, GroundGrid::points / 2);
    EXPECT_EQ(middle, vec3(7, 0, -3));
    EXPECT_EQ(grid.point(0, 3, 5), grid.point(1, 5, 3));

    scene.camera.target = vec3(0.0f);
    const GroundGrid about(scene.camera);
    const auto seen_at = [&](vec3 p) {
        const std::vector<bool> seen = seen_points(FieldEvaluator(scene), view_of(scene), about, never);
        for (int k = 0; k < GroundGrid::lines; ++k)
            for (int i = 0; i < GroundGrid::points; ++i)
                if (about.point(0, k, i) == p) return static_cast<bool>(seen[GroundGrid::index(0, k, i)]);
        ADD_FAILURE() << "no such point";
        return false;
    };
    EXPECT_TRUE(seen_at({0, 0, 0}));
    apply(scene, InsertNode{scene.root.id, -1, make_node(NodeKind::plane)});
    EXPECT_TRUE(seen_at({0, 0, 0})) << "a floor on the ground";
    apply(scene, InsertNode{scene.root.id, -1, ball({0, 2, 4}, 0.5f)});
    EXPECT_FALSE(seen_at({0, 0, 0})) << "behind the ball";
    EXPECT_TRUE(seen_at({2, 0, 0}));
}

TEST(GroundGrid, IsMadeOfNumbersWhereverTheCameraIs) {
    Camera camera;
    for (const float far : {0.0f, 1e-6f, 1.0f, 1e6f}) {
        camera.position = vec3(far);
        camera.target = vec3(-far, 0, far);
        const GroundGrid grid(camera);
        EXPECT_GT(grid.step, 0.0f);
        EXPECT_TRUE(std::isfinite(grid.point(1, 30, 30).x)) << far;
    }
}

}  // namespace
}  // namespace farfield
