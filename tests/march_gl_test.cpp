// The tracer with its safe steps against a march in steps of 1e-4 m that looks at nothing but the field's sign.
#include "renderer/records.h"
#include "renderer/trace_program.h"
#include "sdf/codegen.h"
#include "sdf/edit.h"
#include "sdf/evaluate.h"
#include "tests/gl_test.h"
#include "tests/test_support.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

namespace farfield {
namespace {

/// As in shaders/common.glsl.
struct RayRecord {
    glm::vec3 origin;
    float reach;
    glm::vec3 direction;
    float footprint;
};
static_assert(sizeof(RayRecord) == ray_bytes);
struct HitRecord {
    float distance;
    std::uint32_t normal, material, steps;
};
static_assert(sizeof(HitRecord) == hit_bytes);

constexpr float smallest_step = 1e-4f;
constexpr float footprint = 2e-5f;  // the tracer's tolerance, for each metre: about 1e-4 m at these distances
constexpr int width = 64;

/// Rays of a camera that looks at the box from a corner.
std::vector<RayRecord> camera_rays(const Box& box) {
    const glm::vec3 target = box.centre();
    const float radius = 0.5f * glm::length(box.size());
    const glm::vec3 origin = target + 2.5f * radius * glm::normalize(glm::vec3(1.0f, 0.7f, 1.3f));
    const glm::vec3 forward = glm::normalize(target - origin);
    const glm::vec3 right = glm::normalize(glm::cross(forward, glm::vec3(0.0f, 1.0f, 0.0f)));
    const glm::vec3 up = glm::cross(right, forward);
    std::vector<RayRecord> rays;
    for (int y = 0; y < width; ++y)
        for (int x = 0; x < width; ++x) {
            const glm::vec2 at = (glm::vec2(x, y) + 0.5f) / (0.5f * width) - 1.0f;
            rays.push_back(
                {origin, 5.0f * radius, glm::normalize(forward + 0.4f * (at.x * right + at.y * up)), footprint});
        }
    return rays;
}

/// Where each ray meets the surface, -1 where it does not.
std::vector<float> traced(const Scene& scene, Tier tier, const std::vector<RayRecord>& rays) {
    TracePrograms tracer;
    gl::Buffer in("rays"), out("hits"), counters("counters");
    in.upload(std::span(rays));
    out.resize(rays.size() * sizeof(HitRecord));
    counters.resize(sizeof(CounterRecord));
    in.bind_storage(binding::rays);
    out.bind_storage(binding::hits);
    counters.bind_storage(binding::counters);
    tracer.select(scene, tier);
    tracer.trace(rays.size(), false, false);
    std::vector<HitRecord> hits(rays.size());
    out.read(hits.data(), hits.size() * sizeof(HitRecord));
    std::vector<float> distances;
    for (const HitRecord& hit : hits) distances.push_back(hit.distance);
    return distances;
}

/// The first change of sign in steps of 1e-4 m, made finer by bisection.
std::vector<float> marched(const Scene& scene, const std::vector<RayRecord>& rays) {
    const GeneratedScene generated = generate(scene, Tier::specialised);
    const std::string source = fmt::format(
        "#version 430 core\n"
        "layout(local_size_x = 64) in;\n"
        "{}"
        "struct Ray {{ vec3 origin; float reach; vec3 direction; float footprint; }};\n"
        "layout(std430, binding = 0) readonly buffer Rays {{ Ray rays[]; }};\n"
        "layout(std430, binding = 1) writeonly buffer Results {{ float results[]; }};\n"
        "uniform vec3 scene_low, scene_high;\n"
        "void main() {{\n"
        "    uint i = gl_GlobalInvocationID.x;\n"
        "    if (i >= uint(rays.length())) return;\n"
        "    vec3 a = (scene_low - rays[i].origin) / rays[i].direction, b = (scene_high - rays[i].origin) / "
        "rays[i].direction;\n"
        "    vec3 enter = min(a, b), leave = max(a, b);\n"
        "    float t = max(enter.x, max(enter.y, enter.z)) - {step};\n"
        "    float end = min(leave.x, min(leave.y, leave.z)) + {step};\n"
        "    float low = t, high = -1.0;\n"
        "    int halvings = 0;\n"
        "    while (t < end && halvings < 8) {{\n"
        "        bool inside = scene_distance(rays[i].origin + t * rays[i].direction) < 0.0;\n"
        "        if (inside) high = t; else low = t;\n"
        "        if (high >= 0.0) ++halvings;\n"
        "        t = high < 0.0 ? t + {step} : 0.5 * (low + high);\n"
        "    }}\n"
        "    results[i] = high;\n"
        "}}\n",
        generated.text, fmt::arg("step", smallest_step));
    const gl::Program program("march", source);
    gl::Buffer in("rays"), out("results");
    in.upload(std::span(rays));
    out.resize(rays.size() * sizeof(float));
    in.bind_storage(0);
    out.bind_storage(1);
    program.set("scene_low", generated.bounds.low);
    program.set("scene_high", generated.bounds.high);
    program.run(rays.size());
    std::vector<float> results(rays.size());
    out.read(results.data(), results.size() * sizeof(float));
    return results;
}

/// Whether there is surface within a millimetre of p, a twentieth of a pixel here: a point inside. The tracer stops
/// where the field is below its tolerance, which is further out where the field is flatter than the distance.
bool is_at_surface(const FieldEvaluator& field, glm::vec3 p, std::mt19937& random) {
    const auto uniform = [&] { return static_cast<float>(random() >> 8) * 0x1p-23f - 1.0f; };
    for (int i = 0; i < 3000; ++i) {
        const glm::vec3 offset(uniform(), uniform(), uniform());
        if (glm::length(offset) <= 1.0f && field.distance(p + 1e-3f * offset) < 0.0f) return true;
    }
    return false;
}

class March : public GlTest {
protected:
    /// `node` over a beam and a ball, which lie off all axes and symmetries.
    void expect_no_difference(Node node, const std::string& name, const char* code = nullptr) {
        Node beam = make_node(NodeKind::box), ball = make_node(NodeKind::sphere);
        beam.values[0] = {0.4f, 0.5f, 0.06f};
        beam.transform.rotate = {0.0f, 20.0f, 0.0f};
        ball.values[0].x = 0.2f;
        ball.transform.translate = {0.35f, 0.3f, 0.1f};
        if (info(node.kind).takes_children()) node.children = {beam, ball};
        Scene scene;
        const Id id = apply(scene, InsertNode{scene.root.id, -1, node});
        if (code) apply(scene, SetCode{id, code});

        const FieldEvaluator field(scene);
        Box box = field.tree().bounds();
        box = box.common({glm::vec3(-2.0f), glm::vec3(2.0f)});
        const std::vector<RayRecord> rays = camera_rays(box);
        const std::vector<float> expected = marched(scene, rays), found = traced(scene, Tier::specialised, rays);
        std::mt19937 random(1);
        int hits = 0, holes = 0, early = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const float tolerance = 2.0f * footprint * rays[i].reach;
            hits += expected[i] >= 0.0f;
            if (expected[i] >= 0.0f && (found[i] < 0.0f || found[i] > expected[i] + tolerance)) ++holes;
            if (found[i] >= 0.0f && (expected[i] < 0.0f || found[i] < expected[i] - tolerance) &&
                !is_at_surface(field, rays[i].origin + found[i] * rays[i].direction, random))
                ++early;
        }
        EXPECT_GT(hits, 50) << name;
        EXPECT_EQ(holes, 0) << name << ": rays went through the surface, of " << hits << " that meet it";
        EXPECT_EQ(early, 0) << name << ": rays met a surface that is not there, of " << rays.size();
    }
};

TEST_F(March, FindsWhatTinyStepsFind) {
    struct Case {
        NodeKind kind;
        std::vector<std::vector<glm::vec3>> values;  ///< beside the defaults
    };
    const auto x = [](float v) { return glm::vec3(v, 0.0f, 0.0f); };
    using K = NodeKind;
    const Case cases[] = {
        {K::twist, {{x(-40.0f)}, {x(700.0f)}, {x(3000.0f)}}},
        {K::bend, {{x(-120.0f)}, {x(400.0f)}}},
        {K::taper, {{x(1.9f)}, {x(-6.0f)}}},
        {K::stretch, {{{0.05f, 3.0f, 0.4f}}, {{0.3f, 4.0f, 0.08f}}}},
        {K::displace_sine, {{x(0.1f), x(0.08f)}, {x(0.3f), x(0.05f)}}},
        {K::displace_noise, {{x(0.1f), x(0.1f), x(8.0f)}, {x(0.02f), x(0.01f), x(2.0f)}}},
        {K::repeat, {{{0.3f, 0.0f, 0.21f}, {4.0f, 1.0f, 3.0f}}, {{0.7f, 0.9f, 0.8f}, {2.0f, 3.0f, 2.0f}}}},
        {K::polar_repeat, {{x(1.0f)}, {x(12.0f)}}},
        {K::mirror, {{glm::vec3(1.0f), x(0.3f)}}},
        {K::elongate, {{glm::vec3(0.4f)}}},
        {K::morph, {{x(0.05f)}}},
        {K::ellipsoid, {{{1.0f, 0.01f, 0.3f}}}},
        {K::menger_sponge, {}},
    };
    for (const Case& c : cases) {
        Node node = make_node(c.kind);
        const std::string name = info(c.kind).key;
        expect_no_difference(node, name + ", defaults");
        for (std::size_t i = 0; i < c.values.size(); ++i) {
            node.values = c.values[i];
            expect_no_difference(node, fmt::format("{}, extreme parameters {}", name, i));
        }
    }
}

TEST_F(March, FindsWhatTinyStepsFindOfCustomCode) {
    const std::pair<const char*, const char*> codes[] = {
        {"a gyroid",
         "const float lipschitz = 1.8;\nfloat sdf(vec3 p) { vec3 q = 9.0 * p; "
         "return abs(dot(sin(q), cos(q.yzx))) / 9.0 - 0.03; }"},
        {"a steep field", "const float lipschitz = 25.0;\nfloat sdf(vec3 p) { return 25.0 * (length(p) - 0.5); }"},
        {"a flat field", "float sdf(vec3 p) { return 0.1 * (length(p) - 0.5); }"},
        {"a fold",
         "uniform int n = 5; // [1, 8]\nconst float lipschitz = 1.0;\nfloat sdf(vec3 p) { for (int i = 0; i < n; ++i) "
         "{ p = abs(p) - 0.2; p = vec3(0.8 * p.x - 0.6 * p.z, p.y, 0.6 * p.x + 0.8 * p.z); } "
         "return box(p, vec3(0.11, 0.3, 0.02)); }"},
        {"a jump", "float sdf(vec3 p) { return p.x < 0.3 ? length(p) - 0.5 : max(length(p) - 0.5, 0.3 - p.x); }"},
        {"waves in the library's shapes",
         "const float lipschitz = 3.5;\nfloat sdf(vec3 p) { "
         "return torus(p, 0.6, 0.2) + 0.04 * sin(40.0 * p.x) * sin(40.0 * p.y) * sin(40.0 * p.z); }"}};
    for (const auto& [name, code] : codes) expect_no_difference(make_node(NodeKind::custom), name, code);
}

}  // namespace
}  // namespace farfield
