// What frames of the camera show, without a window.
#include "app/camera_control.h"
#include "sdf/scene_file.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace farfield {
namespace {

/// How much of half the picture's height and width the corners of the box reach at most.
glm::vec2 filled(const Camera& camera, const Box& box, float aspect) {
    const glm::vec3 forward = glm::normalize(camera.target - camera.position);
    const glm::vec3 right = glm::normalize(glm::cross(forward, glm::vec3(0.0f, 1.0f, 0.0f)));
    const glm::vec3 up = glm::cross(right, forward);
    const float slope = std::tan(glm::radians(0.5f * camera.field_of_view));
    glm::vec2 most(0.0f);
    for (int i = 0; i < 8; ++i) {
        const glm::vec3 corner{i & 1 ? box.low.x : box.high.x, i & 2 ? box.low.y : box.high.y,
                               i & 4 ? box.low.z : box.high.z};
        const glm::vec3 o = corner - camera.position;
        const float depth = glm::dot(o, forward) * slope;
        EXPECT_GT(depth, 0.0f) << "behind the camera";
        most = glm::max(most, glm::abs(glm::vec2(glm::dot(o, right) / aspect, glm::dot(o, up))) / depth);
    }
    return most;
}

TEST(FramedCamera, SeesTheWholeBoxAtSeventyPerCentInTheSameDirection) {
    for (const glm::vec3 direction :
         {glm::vec3(0.0f, 0.0f, 5.0f), glm::vec3(3.0f, 2.5f, 5.0f), glm::vec3(-1.0f, 4.0f, 0.2f)})
        for (const Box& box :
             {Box{{-1, -1, -1}, {1, 1, 1}}, Box{{9, 0, 3}, {10, 5, 4}}, Box{{-8, -0.1f, -8}, {8, 0, 8}}})
            for (const float aspect : {0.6f, 1.5f}) {
                Camera camera;
                camera.target = {1.0f, 2.0f, 3.0f};
                camera.position = camera.target + direction;
                const Camera moved = framed(camera, box, aspect);
                const glm::vec3 before = glm::normalize(camera.target - camera.position);
                EXPECT_GT(glm::dot(before, glm::normalize(moved.target - moved.position)), 0.9999f);
                const glm::vec2 most = filled(moved, box, aspect);
                EXPECT_NEAR(std::max(most.x, most.y), 0.7f, 1e-3f);
            }
}

TEST(FramedCamera, KeepsADistanceFromAPoint) {
    const Camera moved = framed({}, {glm::vec3(2.0f), glm::vec3(2.0f)}, 1.5f);
    EXPECT_EQ(moved.target, glm::vec3(2.0f));
    EXPECT_GT(glm::distance(moved.position, moved.target), 0.02f);
}

Scene scene_of(const char* nodes) {
    return parse_scene(std::string(R"({"farfield": 1, "camera": {"target": [5, 1, 5]}, "lights": {"lamp": {"kind":
        "point", "position": [0, 9, 0]}}, "root": {"kind": "union", "children": [)") +
                           nodes + "]}}",
                       "test");
}

TEST(FramedBox, IsOfTheObjectWithoutTheGroundAndNeverWithoutEnd) {
    const Scene scene =
        scene_of(R"({"kind": "plane"}, {"kind": "sphere", "translate": [4, 2, 0]}, {"kind": "sphere"})");
    const ObjectRef everything{ObjectType::node, scene.root.id}, ball{ObjectType::node, scene.root.children[1].id};
    EXPECT_NEAR(framed_box(scene, everything).size().x, 5.0f, 1e-3f);
    EXPECT_NEAR(framed_box(scene, ball).size().x, 1.0f, 1e-3f);
    EXPECT_NEAR(framed_box(scene, ball).centre().y, 2.0f, 1e-3f);
    EXPECT_NEAR(framed_box(scene, {ObjectType::light, scene.lights[0].id}).centre().y, 9.0f, 1e-3f);
    for (const ObjectRef other : {ObjectRef{ObjectType::node, scene.root.children[0].id}, ObjectRef{ObjectType::sky, 0},
                                  ObjectRef{ObjectType::material, scene.materials[0].id}})
        EXPECT_NEAR(framed_box(scene, other).size().x, 5.0f, 1e-3f) << "has no place: all that has one";

    const Scene pillar = scene_of(R"({"kind": "infinite_cylinder", "radius": 2})");
    const Box box = framed_box(pillar, {ObjectType::node, pillar.root.id});
    EXPECT_TRUE(box.is_bounded());
    EXPECT_NEAR(box.size().x, 4.0f, 1e-3f);
    EXPECT_NEAR(box.centre().y, 1.0f, 1e-3f) << "where the camera looks";
    for (const char* nodes : {"", R"({"kind": "plane"})"}) {
        const Scene empty = scene_of(nodes);
        EXPECT_TRUE(framed_box(empty, {ObjectType::node, empty.root.id}).is_bounded()) << nodes;
    }
}

TEST(CameraEdits, LeadToTheOtherCamera) {
    Scene scene;
    const Camera to = framed(scene.camera, {{9, 0, 3}, {10, 5, 4}}, 1.5f);
    for (const Edit& edit : camera_edits(scene.camera, to)) apply(scene, edit);
    EXPECT_LT(glm::distance(scene.camera.position, to.position), 1e-3f);
    EXPECT_LT(glm::distance(scene.camera.target, to.target), 1e-3f);
}

}  // namespace
}  // namespace farfield
