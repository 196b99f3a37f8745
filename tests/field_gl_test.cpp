// The generated function on the GPU against the same shapes on the CPU.
#include "sdf/codegen.h"
#include "sdf/edit.h"
#include "sdf/evaluate.h"
#include "sdf/scene_file.h"
#include "tests/gl_test.h"
#include "tests/test_support.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace farfield {
namespace {

/// The largest difference relative to the size of the numbers involved: coordinates are subtracted from points, so
/// float rounding is relative to the coordinates, not to the distance.
void expect_agreement(const Scene& scene, unsigned seed, const std::string& name) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-8.0f, 8.0f);
    std::vector<glm::vec4> points(10'000);
    for (glm::vec4& p : points) p = {uniform(random), uniform(random), uniform(random), 0.0f};
    const FieldEvaluator field(scene);
    for (const Tier tier : {Tier::specialised, Tier::live}) {
        if (tier == Tier::live && expanded_node_count(scene) > 32) continue;  // takes seconds, and is never made
        const GeneratedScene generated = generate(scene, tier);
        const std::vector<float> gpu = gpu_values(generated.text, "scene_distance", points, generated.parameters);
        double worst = 0.0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const glm::vec3 p(points[i]);
            const float cpu = field.distance(p);
            const double scale = std::max({1.0f, std::abs(cpu), std::abs(p.x), std::abs(p.y), std::abs(p.z)});
            worst = std::max(worst, std::abs(static_cast<double>(cpu) - gpu[i]) / scale);
        }
        EXPECT_LE(worst, 1e-5) << name << (tier == Tier::live ? ", live" : ", specialised");
    }
}

using FieldOnGpu = GlTest;

TEST_F(FieldOnGpu, AgreesWithTheCpuOnBundledScenes) {
    for (const auto& file : bundled_scenes()) expect_agreement(load_scene(file), 1, file.filename().string());
}

TEST_F(FieldOnGpu, AgreesWithTheCpuOnEveryKind) {
    for (const KindInfo& kind : node_kinds()) {
        if (kind.role == Role::instance) continue;
        Scene scene;
        const Id id = apply(scene, InsertNode{scene.root.id, -1, make_node(kind.kind)});
        if (kind.takes_children()) {
            Node ball = make_node(NodeKind::sphere);
            ball.transform.translate = {0.4f, 0.3f, 0.1f};
            apply(scene, InsertNode{id, -1, make_node(NodeKind::box)});
            apply(scene, InsertNode{id, -1, ball});
        }
        expect_agreement(scene, 1, kind.key);
    }
}

TEST_F(FieldOnGpu, AgreesWithTheCpuOnCopiesThatAreCutOff) {
    for (const Scene& scene : scenes_with_cut_copies()) expect_agreement(scene, 1, "copies that are cut off");
}

/// Several nodes with the same code and other values, names that meet the library's, and what is no number.
TEST_F(FieldOnGpu, AgreesWithTheCpuOnCustomCode) {
    const char* const texts[] = {
        "uniform float radius = 0.5; // [0, 1]\nconst float count = 0.0;\n"
        "float sphere(vec3 p) { return length(p) - radius; }\nfloat sdf(vec3 p) { return sphere(p); }",
        "uniform bvec3 axes = bvec3(true, false, true);\nuniform int n = 3; // [1, 5]\nconst float lipschitz = 2.0;\n"
        "float sdf(vec3 p) { for (int i = 0; i < n; ++i) p = mix(p, abs(p) - 0.2, axes); return box(p, vec3(0.2)); }",
        "float sdf(vec3 p) { return p.x > 0.2 ? sqrt(-1.0 - p.x) : p.y > 0.2 ? 1.0 / max(-p.x, 0.0) : length(p) - 0.3; "
        "}"};
    Scene scene;
    for (int i = 0; i < 6; ++i) {
        const Id id = apply(scene, InsertNode{scene.root.id, -1, make_node(NodeKind::custom)});
        const ObjectRef node{ObjectType::node, id};
        apply(scene, SetCode{id, texts[i % 3]});
        if (i % 2) apply(scene, SetName{node, i == 1 ? "torus" : i == 3 ? "surface" : "place"});
        apply(scene, SetValue{node, "translate", glm::vec3(2.0f * static_cast<float>(i) - 5.0f, 0.0f, 0.5f)});
        apply(scene, SetValue{node, "bounds", i < 3 ? glm::vec3(1.0f) : glm::vec3(0.25f, 0.0f, 0.5f)});
        if (i % 3 == 0) apply(scene, SetValue{node, "radius", glm::vec3(0.2f + 0.1f * static_cast<float>(i))});
        if (i % 3 == 1) apply(scene, SetValue{node, "n", glm::vec3(static_cast<float>(i))});
    }
    expect_agreement(scene, 1, "custom code");
}

TEST_F(FieldOnGpu, AgreesWithTheCpuOnRandomScenes) {
    for (unsigned seed = 0; seed < 8; ++seed)
        expect_agreement(random_scene(seed, 12), seed, fmt::format("random scene {}", seed));
}

}  // namespace
}  // namespace farfield
