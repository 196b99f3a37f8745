// What dragging the handles over the picture comes to, without a window.
#include "app/gizmo_math.h"

#include "sdf/scene_file.h"

#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace farfield {
namespace {

using glm::vec2;
using glm::vec3;

constexpr float length = 84.0f;

PictureView view_from(vec3 position, vec3 target = vec3(0.0f)) {
    Camera camera;
    camera.position = position;
    camera.target = target;
    return {camera, {100.0f, 50.0f}, {800.0f, 600.0f}};
}

bool is_valid(const Transform& t) {
    for (int i = 0; i < 3; ++i)
        if (!std::isfinite(t.translate[i]) || !std::isfinite(t.rotate[i]) || std::abs(t.translate[i]) > largest_value ||
            std::abs(t.rotate[i]) > 36000.0f)
            return false;
    return t.scale >= 1e-4f && t.scale <= 1e4f;
}

TEST(PictureView, ProjectsWhatItsRaysGoThrough) {
    const PictureView view = view_from({3, 2, 5});
    for (const vec2 pixel : {vec2(500, 350), vec2(100, 50), vec2(890, 640)}) {
        const Ray ray = view.ray(pixel);
        const auto back = view.project(ray.origin + 4.0f * ray.direction);
        ASSERT_TRUE(back);
        EXPECT_LT(glm::distance(*back, pixel), 0.01f);
    }
    EXPECT_FALSE(view.project(view.eye - view.basis.forward)) << "behind the camera";
    EXPECT_FALSE(view.project(view.eye));
}

TEST(Rays, MeetAxesAndPlanesOrSayThatTheyDoNot) {
    const Ray ray{{0, 1, 5}, {0, 0, -1}};
    EXPECT_NEAR(along_axis(ray, {0, 0, 0}, {0, 1, 0}).value(), 1.0f, 1e-6f);
    EXPECT_NEAR(along_axis(ray, {2, 0, 0}, {1, 0, 0}).value(), -2.0f, 1e-6f);
    EXPECT_FALSE(along_axis(ray, {0, 0, 0}, {0, 0, 1})) << "parallel";
    EXPECT_FALSE(along_axis(ray, {0, 0, 9}, {0, 1, 0})) << "behind the eye";
    EXPECT_NEAR(on_plane(ray, {7, 7, 2}, {0, 0, 1}).value().z, 2.0f, 1e-6f);
    EXPECT_FALSE(on_plane(ray, {0, 0, 0}, {0, 1, 0})) << "parallel";
    EXPECT_FALSE(on_plane(ray, {0, 0, 6}, {0, 0, 1})) << "behind the eye";
}

TEST(Snapping, KeepsToMultiplesAndLeavesTheRestAlone) {
    EXPECT_FLOAT_EQ(snapped(0.26f, 0.1f), 0.3f);
    EXPECT_FLOAT_EQ(snapped(-22.0f, 15.0f), -15.0f);
    EXPECT_EQ(snapped(0.26f, 0.0f), 0.26f);
    EXPECT_EQ(snapped(0.26f, -1.0f), 0.26f);
    Camera camera;
    for (const auto& [distance, step] : {std::pair(5.0f, 1.0f), {40.0f, 10.0f}, {0.5f, 0.1f}}) {
        camera.position = camera.target + vec3(0, 0, distance);
        EXPECT_FLOAT_EQ(grid_step(camera), step) << distance;
    }
    camera.position = camera.target;
    EXPECT_EQ(grid_step(camera), 1.0f);
}

TEST(EulerAngles, GiveBackTheRotationNearestToWhatWas) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> angle(-400.0f, 400.0f);
    for (int i = 0; i < 500; ++i) {
        Transform t;
        t.rotate = {angle(random), i % 5 == 0 ? 90.0f : angle(random), angle(random)};
        const glm::mat3 rotation = rotation_matrix(t);
        const vec3 near = t.rotate + vec3(3.0f, i % 5 == 0 ? 0.0f : -2.0f, 1.0f);
        Transform back;
        back.rotate = euler_angles(rotation, near);
        for (int column = 0; column < 3; ++column)
            EXPECT_LT(glm::distance(rotation_matrix(back)[column], rotation[column]), 2e-3f) << i;
        if (i % 5 != 0) {
            EXPECT_LT(glm::distance(back.rotate, t.rotate), 0.5f) << i;
        }
    }
}

TEST(GizmoShape, HasTheSameSizeHoweverFarItIs) {
    for (const float distance : {0.01f, 1.0f, 50.0f, 2000.0f}) {
        const PictureView view = view_from({0, 0, distance});
        const GizmoShape shape(view, Tool::move, {}, length);
        ASSERT_TRUE(shape.visible());
        const auto line = shape.outline({Handle::Part::axis, 0});
        ASSERT_EQ(line.size(), 2u);
        EXPECT_NEAR(glm::distance(line[1], shape.centre()), length, 0.5f) << distance;
    }
}

TEST(GizmoShape, TakesWhatIsUnderTheMouseAndNothingElse) {
    const PictureView view = view_from({3, 2, 5});
    for (const Tool tool : {Tool::move, Tool::rotate, Tool::scale}) {
        const GizmoShape shape(view, tool, {}, length);
        for (const Handle handle : handles(tool)) {
            const auto grip = shape.grip(handle);
            ASSERT_TRUE(grip);
            EXPECT_TRUE(shape.at(*grip) == handle)
                << static_cast<int>(tool) << ' ' << static_cast<int>(handle.part) << ' ' << handle.axis;
        }
        EXPECT_FALSE(shape.at(shape.centre() + vec2(0.0f, 2.0f * length)));
    }
    EXPECT_TRUE(handles(Tool::none).empty());
}

TEST(GizmoShape, AxesAtTheEyeAndPlanesOnEdgeCannotBeTaken) {
    const PictureView view = view_from({0, 0, 5});
    const GizmoShape shape(view, Tool::move, {}, length);
    EXPECT_EQ(shape.strength({Handle::Part::axis, 2}), 0.0f);
    EXPECT_EQ(shape.strength({Handle::Part::axis, 0}), 1.0f);
    EXPECT_EQ(shape.strength({Handle::Part::plane, 0}), 0.0f);
    EXPECT_EQ(shape.strength({Handle::Part::plane, 2}), 1.0f);
    EXPECT_TRUE(shape.at(shape.centre()) == (Handle{Handle::Part::view, 0}));
}

TEST(GizmoShape, IsNotThereBehindTheCameraOrAtNoPlace) {
    const PictureView view = view_from({0, 0, 5});
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const vec3 origin : {vec3(0, 0, 6), vec3(0, 0, 5), vec3(nan), vec3(1e30f, 0, 5)}) {
        const GizmoShape shape(view, Tool::move, {origin}, length);
        EXPECT_FALSE(shape.visible());
        EXPECT_FALSE(shape.at({500, 350}));
        EXPECT_TRUE(shape.outline({Handle::Part::axis, 0}).empty());
    }
}

TEST(GizmoDrag, MovesSoThatTheHandleStaysUnderTheMouse) {
    const PictureView view = view_from({3, 2, 5});
    const Pose pose{{0.3f, -0.2f, 0.1f}};
    for (const Handle handle : handles(Tool::move)) {
        const vec2 from = *GizmoShape(view, Tool::move, pose, length).grip(handle);
        GizmoDrag drag(view, Tool::move, handle, pose, from, length);
        EXPECT_EQ(drag.to(from, {}).shift, vec3(0.0f));
        const Motion motion = drag.to(from + vec2(40, -25), {});
        const vec2 now = *GizmoShape(view, Tool::move, {pose.origin + motion.shift}, length).grip(handle);
        const vec2 moved = now - from;
        if (handle.part == Handle::Part::axis) {
            EXPECT_EQ(motion.shift[(handle.axis + 1) % 3], 0.0f);
            const auto line = GizmoShape(view, Tool::move, pose, length).outline(handle);
            const vec2 along = glm::normalize(line[1] - line[0]);
            EXPECT_NEAR(glm::dot(moved, along), glm::dot(vec2(40, -25), along), 6.0f) << "but for perspective";
        } else {
            EXPECT_LT(glm::distance(moved, vec2(40, -25)), 6.0f);
            if (handle.part == Handle::Part::plane) {
                EXPECT_NEAR(motion.shift[handle.axis], 0.0f, 1e-6f);
            }
        }
        const Motion stepped = drag.to(from + vec2(40, -25), {0.1f, 15.0f, 0.1f});
        if (handle.part == Handle::Part::view) continue;
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(stepped.shift[i], std::round(stepped.shift[i] * 10.0f) / 10.0f, 1e-6f);
    }
}

TEST(GizmoDrag, ThrowsNothingBeyondTheHorizon) {
    const PictureView view = view_from({0, 1, 8});
    const Handle ground{Handle::Part::plane, 1};
    const vec2 from = GizmoShape(view, Tool::move, {}, length).centre();
    GizmoDrag drag(view, Tool::move, ground, {}, from, length);
    float largest = 0.0f;
    for (float y = 0.0f; y < 300.0f; y += 1.0f)
        largest = std::max(largest, glm::length(drag.to(from - vec2(0, y), {}).shift));
    EXPECT_GT(largest, 20.0f);
    EXPECT_LT(largest, 260.0f);
}

TEST(GizmoDrag, TurnsWithTheMouseAroundTheRingAndPastHalfATurn) {
    const PictureView view = view_from({0, 0, 5});
    for (const Handle handle : {Handle{Handle::Part::axis, 2}, Handle{Handle::Part::view, 0}}) {
        const GizmoShape shape(view, Tool::rotate, {}, length);
        const auto at = [&](float degrees) {
            const float a = glm::radians(degrees);
            return shape.centre() + length * vec2(std::cos(a), -std::sin(a));
        };
        GizmoDrag drag(view, Tool::rotate, handle, {}, at(10), length);
        float turned = 0.0f;
        for (int degrees = 10; degrees <= 410; degrees += 20)
            turned = drag.to(at(static_cast<float>(degrees)), {}).angle;
        EXPECT_NEAR(turned, 400.0f, 0.1f);
        EXPECT_NEAR(drag.to(at(52), {0.0f, 15.0f, 0.0f}).angle, 405.0f, 1e-3f);
        Transform start;
        const Transform end = moved(start, {}, drag.to(at(40), {}), 0.01f, {0, 0, 380});
        EXPECT_NEAR(end.rotate.z, 390.0f, 0.2f) << "counter-clockwise, as seen from the camera";
    }
}

TEST(GizmoDrag, TurnsARingOnEdgeAlongItsLine) {
    const PictureView view = view_from({0, 0, 5});
    const vec2 centre = GizmoShape(view, Tool::rotate, {}, length).centre();
    GizmoDrag drag(view, Tool::rotate, {Handle::Part::axis, 1}, {}, centre, length);
    const float angle = drag.to(centre + vec2(0.92f * length, 0), {}).angle;
    EXPECT_NEAR(angle, glm::degrees(1.0f), 0.5f) << "what is in front goes to the right";
    EXPECT_EQ(drag.to(centre + vec2(0, 50), {}).angle, 0.0f);
}

TEST(GizmoDrag, ScalesByTheDistanceFromTheMiddle) {
    const PictureView view = view_from({0, 0, 5});
    const vec2 centre = GizmoShape(view, Tool::scale, {}, length).centre();
    GizmoDrag drag(view, Tool::scale, {}, {}, centre + vec2(100, 0), length);
    EXPECT_NEAR(drag.to(centre + vec2(0, 150), {}).factor, 1.5f, 1e-4f);
    EXPECT_NEAR(drag.to(centre + vec2(0, 134), {0, 0, 0.1f}).factor, 1.3f, 1e-4f);
    EXPECT_GT(drag.to(centre, {}).factor, 0.0f);
    EXPECT_GT(drag.to(centre, {0, 0, 0.1f}).factor, 0.0f);
    GizmoDrag from_middle(view, Tool::scale, {}, {}, centre, length);
    EXPECT_EQ(from_middle.to(centre + vec2(50, 0), {}).factor, 1.0f);
}

TEST(MovedTransform, IsAsInTheWorldWhateverStandsAbove) {
    Transform above;
    above.translate = {1, 2, 3};
    above.rotate = {20, -40, 70};
    above.scale = 2.5f;
    const Frame parent = Frame{}.placed(above);
    Transform start;
    start.translate = {0.5f, 0.25f, -1};
    start.rotate = {10, 20, 30};
    const Frame before = parent.placed(start);

    Motion shift;
    shift.shift = {0.3f, 0.0f, -0.4f};
    const Frame shifted = parent.placed(moved(start, parent, shift, 1e-4f, start.rotate));
    EXPECT_LT(glm::distance(shifted.origin, before.origin + shift.shift), 1e-3f);

    Motion turn;
    turn.axis = {0, 1, 0};
    turn.angle = 35.0f;
    const Transform turned = moved(start, parent, turn, 1e-4f, start.rotate);
    EXPECT_EQ(turned.translate, start.translate);
    Transform about;
    about.rotate = {0, 35, 0};
    for (int i = 0; i < 3; ++i)
        EXPECT_LT(glm::distance(parent.placed(turned).rotation[i], (rotation_matrix(about) * before.rotation)[i]),
                  1e-3f);

    Motion growth;
    growth.factor = 1.1f;
    EXPECT_FLOAT_EQ(moved(start, parent, growth, 1e-4f, start.rotate).scale, 1.1f);
}

TEST(MovedTransform, HasCleanDecimalsAndLeavesOtherNumbersAlone) {
    Transform start;
    start.translate = {0.123456f, 2.0f / 3.0f, 0.0f};
    start.rotate = {12.3456f, 0, 0};
    Motion motion;
    motion.shift = {0.1f, 0.0f, 0.123456f};
    motion.angle = 0.0f;
    const Transform end = moved(start, {}, motion, 0.004f, start.rotate);
    EXPECT_EQ(end.translate.x, 0.223f);
    EXPECT_EQ(end.translate.y, 2.0f / 3.0f);
    EXPECT_EQ(end.translate.z, 0.123f);
    EXPECT_EQ(end.rotate, start.rotate);
    EXPECT_EQ(end.scale, 1.0f);
    EXPECT_EQ(moved(start, {}, {}, 0.004f, start.rotate).translate, start.translate);
    EXPECT_EQ(turned_direction({0, -2, 0}, {{}, {1, 0, 0}, 90.0f, 1.0f}), vec3(0, 0, -2));
    EXPECT_EQ(moved_point({1, 2, 3}, {{0.05f, 0, 0}}, 0.01f), vec3(1.05f, 2, 3));
}

TEST(MovedTransform, IsOneThatATransformTakesWhateverComes) {
    const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    const float wild[] = {0.0f, 1.0f, -1e-30f, 1e30f, -3e38f, inf, nan};
    for (const float a : wild)
        for (const float b : wild)
            for (const float scale : {1e-4f, 1.0f, 1e4f, 1e-30f, 1e30f}) {
                Frame parent;
                parent.scale = scale;
                Transform start;
                start.scale = scale > 1e-4f ? 1e4f : 1e-4f;
                const Motion motion{{a, b, 0}, {0, 1, 0}, b, a};
                EXPECT_TRUE(is_valid(moved(start, parent, motion, b, {a, b, 0}))) << a << ' ' << b << ' ' << scale;
                EXPECT_TRUE(std::isfinite(moved_point({1, 2, 3}, motion, a).x));
                EXPECT_GT(glm::length(turned_direction({0, -1, 0}, motion)), 0.0f);
            }
}

TEST(GizmoDrag, NeverAnswersWithNoNumberInDegenerateViews) {
    Camera camera;
    camera.field_of_view = 170.0f;
    for (const vec3 position : {vec3(0, 0, 1e-3f), vec3(0, 5, 0), vec3(0, 0, 5), vec3(1e6f, 1e6f, 1e6f)}) {
        camera.position = position;
        camera.target = vec3(0.0f);
        for (const vec2 size : {vec2(0, 0), vec2(1, 900), vec2(800, 600)}) {
            const PictureView view(camera, {0, 0}, size);
            for (const Tool tool : {Tool::move, Tool::rotate, Tool::scale})
                for (const Handle handle : handles(tool)) {
                    GizmoDrag drag(view, tool, handle, {}, {size.x / 2, size.y / 2}, length);
                    for (const vec2 to : {vec2(0, 0), vec2(1e5f, -1e5f), vec2(size.x, size.y / 2)}) {
                        const Motion m = drag.to(to, {});
                        EXPECT_TRUE(is_valid(moved({}, {}, m, view.metres_per_pixel(vec3(0.0f)), {})));
                    }
                }
        }
    }
}

TEST(ParentFrame, IsTheChainOfTransformsAboveAndOfTheFirstInstance) {
    Scene scene = parse_scene(R"({"farfield": 1,
        "definitions": [
            {"kind": "union", "name": "unused", "children": [{"kind": "sphere", "name": "lone"}]},
            {"kind": "union", "name": "column", "translate": [0, 1, 0], "children": [{"kind": "box", "name": "shaft"}]}],
        "root": {"kind": "union", "children": [
            {"kind": "mirror", "translate": [5, 0, 0], "children": [
                {"kind": "sphere", "name": "ball", "scale": 2, "translate": [1, 0, 0]}]},
            {"kind": "union", "rotate": [0, 90, 0], "scale": 2, "children": [
                {"kind": "instance", "of": "column", "translate": [0, 0, 3]}]},
            {"kind": "instance", "of": "column"}]}})",
                              "test");
    const auto origin_of = [&](const char* name) {
        const std::function<Id(const Node&)> find = [&](const Node& node) -> Id {
            if (node.name == name) return node.id;
            for (const Node& child : node.children)
                if (const Id id = find(child)) return id;
            return 0;
        };
        Id id = find(scene.root);
        for (const Node& definition : scene.definitions)
            if (id == 0) id = find(definition);
        return parent_frame(scene, id);
    };
    EXPECT_EQ(origin_of("ball").value().origin, vec3(5, 0, 0));
    EXPECT_EQ(origin_of("lone").value().origin, vec3(0));
    EXPECT_LT(glm::distance(origin_of("column").value().origin, vec3(6, 0, 0)), 1e-5f)
        << "as the first instance has it";
    EXPECT_LT(glm::distance(origin_of("shaft").value().origin, vec3(6, 2, 0)), 1e-5f);
    EXPECT_FLOAT_EQ(origin_of("shaft").value().scale, 2.0f);
    EXPECT_FALSE(parent_frame(scene, 99999));
}

}  // namespace
}  // namespace farfield
