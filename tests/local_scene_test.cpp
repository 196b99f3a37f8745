// Far from the origin: the numbers that programs are made of count from the camera.
#include "sdf/local_scene.h"

#include "sdf/codegen.h"
#include "sdf/evaluate.h"
#include "sdf/pick.h"
#include "sdf/scene_file.h"
#include "tests/test_support.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace farfield {
namespace {

/// All of the scene in one group that stands there, camera and lights with it.
Scene moved_as_group(const Scene& scene, glm::vec3 by) {
    Scene far = scene;
    far.root.children.clear();
    Node group = make_node(NodeKind::union_);
    group.id = far.new_id();
    group.transform.translate = by;
    group.children = scene.root.children;
    far.root.children = {group};
    for (Light& light : far.lights) light.position += by;
    far.camera.position += by;
    far.camera.target += by;
    return far;
}

glm::vec3 point(std::mt19937& random) {
    const auto coordinate = [&] { return 3.0f * (static_cast<float>(random() >> 8) * 0x1p-23f - 1.0f); };
    const float x = coordinate(), y = coordinate();
    return {x, y, coordinate()};
}

TEST(LocalScene, IsTheSceneItselfNearTheOrigin) {
    for (const auto& file : bundled_scenes()) {
        const Scene scene = load_scene(file);
        EXPECT_EQ(local_origin(scene.camera), glm::vec3(0.0f)) << file;
        EXPECT_EQ(to_text(local_scene(scene)), to_text(scene)) << file;
    }
}

TEST(LocalScene, OriginMovesRarely) {
    Camera camera;
    camera.position = {1e5f, 20.0f, 3.0f};
    int changes = 0;
    for (int i = 0; i < 1000; ++i) {
        const glm::vec3 before = local_origin(camera);
        camera.position.x += 0.25f;
        camera.target = camera.position + glm::vec3(0.0f, 0.0f, -5.0f - 0.01f * static_cast<float>(i));
        changes += local_origin(camera) != before;
        EXPECT_LT(glm::distance(local_origin(camera), camera.position), 250.0f);
    }
    EXPECT_LE(changes, 2);
}

TEST(LocalScene, OriginIsFiniteWhateverTheCamera) {
    for (const float v : {0.0f, 1e-30f, 1e6f, -1e6f, 1e30f, INFINITY, NAN})
        for (const float w : {0.0f, 1e6f, NAN}) {
            const glm::vec3 origin = local_origin({{v, w, v}, {w, v, 0.0f}, 40.0f});
            if (std::isfinite(v) && std::isfinite(w)) {
                EXPECT_TRUE(std::isfinite(origin.x + origin.y + origin.z)) << v << " " << w;
            } else {
                EXPECT_EQ(origin, glm::vec3(0.0f)) << v << " " << w;
            }
        }
}

/// A hundred kilometres off, distances are those at the origin to a few of the floats' steps there, 2e-5 m; without,
/// they are a centimetre off.
TEST(LocalScene, KeepsDistancesOfWhatIsFar) {
    constexpr float far = 131072.0f;
    for (unsigned seed = 0; seed < 30; ++seed) {
        Scene here = random_scene(seed);
        here.camera = {{2.0f, 1.0f, 4.0f}, {0.0f, 0.0f, 0.0f}, 40.0f};
        const Scene there = moved_as_group(here, {far, -far, 2.0f * far});
        const glm::vec3 origin = local_origin(there.camera);
        ASSERT_NE(origin, glm::vec3(0.0f));
        const glm::vec3 rest = glm::vec3(far, -far, 2.0f * far) - origin;
        const FieldEvaluator a(here), b(local_scene(there));
        std::mt19937 random(seed);
        for (int i = 0; i < 200; ++i) {
            const glm::vec3 p = point(random);
            const float expected = a.distance(p);
            // Repetitions without end and folded space make more of what a place is off.
            EXPECT_NEAR(b.distance(p + rest), expected, 1e-3f + 1e-4f * std::abs(expected)) << seed;
        }
    }
}

/// While a hand moves a far node, its numbers alone may change.
TEST(LocalScene, TunedNodeKeepsWhatIsAboveIt) {
    Scene scene;
    const glm::vec3 far(1e5f, 0.0f, 0.0f);
    scene.camera.position += far;
    scene.camera.target += far;
    Node group = make_node(NodeKind::union_);
    group.transform.translate = far;
    group.children = {make_node(NodeKind::sphere), make_node(NodeKind::box)};
    group.children[1].transform.translate = {1.0f, 0.0f, 0.0f};
    const Id id = apply(scene, InsertNode{scene.root.id, -1, group});
    const GeneratedScene before = generate(local_scene(scene, id), Tier::specialised, id);
    apply(scene, SetValue{{ObjectType::node, id}, "translate", far + glm::vec3(2.0f, 1.0f, 0.0f)});
    const GeneratedScene after = generate(local_scene(scene, id), Tier::specialised, id);
    EXPECT_EQ(before.key, after.key);
    EXPECT_NE(before.parameters, after.parameters);
    // And no program is needed at all where every number is live.
    EXPECT_EQ(generate(local_scene(scene), Tier::live).key, generate(scene, Tier::live).key);
}

TEST(LocalScene, PicksWhatIsFar) {
    Scene scene;
    const glm::vec3 far(1e5f, 5e4f, -1e5f);
    Node ball = make_node(NodeKind::sphere);
    ball.transform.translate = far;
    const Id id = apply(scene, InsertNode{scene.root.id, -1, ball});
    scene.camera.position = far + glm::vec3(0.0f, 0.0f, 4.0f);
    scene.camera.target = far;
    const auto hit = pick(scene, scene.camera.position, {0.0f, 0.0f, -1.0f});
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->node, id);
    EXPECT_NEAR(hit->distance, 3.5f, 2e-3f);
}

}  // namespace
}  // namespace farfield
