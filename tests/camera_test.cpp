// What frames of the camera show, without a window.
#include "app/camera_control.h"
#include "sdf/pick.h"
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

/// Where a point is to the camera: right, up and forward.
glm::vec3 seen(const Camera& camera, glm::vec3 p) {
    const CameraBasis basis(camera);
    const glm::vec3 o = p - camera.position;
    return {glm::dot(o, basis.right), glm::dot(o, basis.up), glm::dot(o, basis.forward)};
}

TEST(OrbitedCamera, KeepsThePivotWhereItIsInThePictureAndTheTargetAsFarOff) {
    Camera camera;
    for (const glm::vec3 pivot : {glm::vec3(0.0f), glm::vec3(1, 0.3f, 2), glm::vec3(-2, 5, 0)}) {
        const Camera moved = orbited(camera, pivot, {130.0f, -40.0f}, 600.0f);
        EXPECT_LT(glm::distance(seen(moved, pivot), seen(camera, pivot)), 1e-4f);
        EXPECT_NEAR(glm::distance(moved.position, moved.target), glm::distance(camera.position, camera.target), 1e-4f);
        EXPECT_GT(glm::distance(moved.position, camera.position), 0.1f);
    }
    Camera above = orbited(camera, camera.target, {0.0f, 5000.0f}, 600.0f);
    EXPECT_LT(CameraBasis(above).forward.y, -0.99f) << "as good as straight down";
    EXPECT_GT(std::abs(CameraBasis(above).right.x) + std::abs(CameraBasis(above).right.z), 0.9f);
    EXPECT_GT(glm::distance(above.position, orbited(above, above.target, {100.0f, 0.0f}, 600.0f).position), 1e-3f);
}

TEST(PannedCamera, KeepsWhatIsHeldUnderTheMouse) {
    const Camera camera;
    const glm::vec3 held(0.4f, 0.2f, 1.0f);
    const glm::vec3 before = seen(camera, held), after = seen(panned(camera, held, {60.0f, -30.0f}, 600.0f), held);
    const float pixel = 2.0f * before.z * CameraBasis(camera).half_height / 600.0f;
    EXPECT_NEAR(after.x - before.x, 60.0f * pixel, 1e-4f);
    EXPECT_NEAR(after.y - before.y, 30.0f * pixel, 1e-4f);
}

TEST(ZoomedCamera, ComesNearerToWhatIsUnderTheMouseWhichKeepsItsPlace) {
    const Camera camera;
    const glm::vec3 about(1.0f, 0.2f, 0.5f);
    const Camera nearer = zoomed(camera, about, 3.0f);
    const glm::vec3 before = seen(camera, about), after = seen(nearer, about);
    EXPECT_LT(after.z, 0.75f * before.z);
    EXPECT_NEAR(after.x / after.z, before.x / before.z, 1e-4f);
    EXPECT_NEAR(after.y / after.z, before.y / before.z, 1e-4f);
    const Camera back = zoomed(nearer, about, -3.0f);
    EXPECT_LT(glm::distance(back.position, camera.position), 1e-4f);
    const Camera close = zoomed(camera, about, 1e4f);
    EXPECT_GT(glm::distance(close.position, close.target), 1e-3f);
}

TEST(FlownCamera, GoesWhereItLooksAndTurnsItsEyes) {
    const Camera camera;
    const CameraBasis basis(camera);
    const Camera ahead = flown(camera, {0.0f, 0.0f, 2.0f}, {}, 600.0f);
    EXPECT_LT(glm::distance(ahead.position, camera.position + 2.0f * basis.forward), 1e-5f);
    EXPECT_LT(glm::distance(ahead.target, camera.target + 2.0f * basis.forward), 1e-5f);
    const Camera turned = flown(camera, {}, {60.0f, 30.0f}, 600.0f);
    EXPECT_EQ(turned.position, camera.position);
    EXPECT_GT(glm::dot(CameraBasis(turned).forward, basis.right), 0.05f) << "to the right";
    EXPECT_LT(CameraBasis(turned).forward.y, basis.forward.y) << "down";
}

TEST(LookingCamera, SeesTheTargetFromAsFarAlongTheAxis) {
    const Camera camera;
    const Camera top = looking(camera, {0, -1, 0});
    EXPECT_LT(glm::distance(CameraBasis(top).forward, glm::vec3(0, -1, 0)), 1e-5f);
    EXPECT_EQ(top.target, camera.target);
    EXPECT_NEAR(glm::distance(top.position, top.target), glm::distance(camera.position, camera.target), 1e-4f);
    Camera nowhere;
    nowhere.position = nowhere.target;
    EXPECT_GT(glm::distance(looking(nowhere, {0, 0, -1}).position, nowhere.target), 1e-3f);
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
