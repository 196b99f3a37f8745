// The reference against answers that are known exactly. Each scene is chosen so that the answer holds at every point of
// the picture; with k bounces the series is cut after k terms, so there is nothing left to be wrong but the renderer.
//
// Tolerance: 0.5 % of the answer. The pictures are small and take a quarter to half a million paths, so that the
// standard error of their mean is at most 0.2 %, and less where the first ray is stratified.
#include "renderer/renderer.h"
#include "sdf/edit.h"
#include "tests/gl_test.h"

#include <cmath>
#include <numbers>
#include <optional>

namespace farfield {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double tolerance = 0.005;

/// 1 + q + ... + q^(terms - 1).
double series(double q, int terms) { return (1.0 - std::pow(q, terms)) / (1.0 - q); }

class ClosedForms : public GlTest {
protected:
    void SetUp() override {
        GlTest::SetUp();
        renderer_.emplace();
        scene_.settings.method = Method::reference;
        scene_.settings.samples = 16;
        scene_.materials[0].albedo = glm::vec3(0.5f);
    }
    void TearDown() override {
        renderer_.reset();
        GlTest::TearDown();
    }
    Id add(Node node, glm::vec3 at = glm::vec3(0.0f), Id parent = 0) {
        node.transform.translate = at;
        return apply(scene_, InsertNode{parent > 0 ? parent : scene_.root.id, -1, node});
    }
    static Node sphere(float radius) {
        Node node = make_node(NodeKind::sphere);
        node.values[0].x = radius;
        return node;
    }
    static Node plane(float turned_about_z = 0.0f) {
        Node node = make_node(NodeKind::plane);
        node.transform.rotate.z = turned_about_z;
        return node;
    }
    /// A closed sphere of radius 1 seen from inside.
    void hollow_sphere() {
        const Id cut = add(make_node(NodeKind::subtract));
        add(sphere(1.5f), {}, cut);
        add(sphere(1.0f), {}, cut);
        scene_.camera.position = {0.3f, 0.2f, 0.5f};
        scene_.camera.target = {0.0f, 0.0f, -1.0f};
    }
    Id add_material(glm::vec3 albedo, glm::vec3 emission) {
        Material material;
        const Id id = apply(scene_, AddMaterial{material});
        Material& added = scene_.materials.back();
        added.albedo = albedo;
        added.emission = emission;
        return id;
    }
    void look_at_patch(glm::vec3 target, glm::vec3 from) {
        scene_.camera.position = from;
        scene_.camera.target = target;
        scene_.camera.field_of_view = 1.0f;
    }
    Image render(View view, int frames) {
        FrameOptions options;
        options.size = {64, 64};
        renderer_->update(scene_, options);
        while (renderer_->statistics().frames < frames) renderer_->render_frame();
        return renderer_->read(view);
    }
    double mean(View view, int frames) {
        const Image image = render(view, frames);
        double sum = 0.0;
        for (const float v : image.pixels) sum += v;
        return sum / static_cast<double>(image.pixels.size());
    }
    void expect(double found, double answer, const std::string& what = "") {
        EXPECT_NEAR(found / answer, 1.0, tolerance) << what;
    }
    Scene scene_;
    std::optional<Renderer> renderer_;
};

/// All surfaces emit 1 and reflect half: without roulette every path finds the same.
TEST_F(ClosedForms, Furnace) {
    hollow_sphere();
    scene_.materials[0].emission = glm::vec3(1.0f);
    for (const int bounces : {1, 2, 4, 5, 8}) {
        scene_.settings.bounces = bounces;
        const double answer = series(0.5, bounces + 1);
        expect(mean(View::result, 1), answer, std::to_string(bounces));
        if (bounces > 4) continue;
        for (const float v : render(View::result, 1).pixels) ASSERT_NEAR(v, answer, 1e-4);
    }
}

/// After the fourth bounce paths end by chance. Here every path finds the same light, so noise can come from nothing
/// else: it is there, and the mean of each colour stays.
TEST_F(ClosedForms, RussianRouletteKeepsTheMean) {
    hollow_sphere();
    const glm::vec3 albedo(0.9f, 0.5f, 0.2f);
    scene_.materials[0].albedo = albedo;
    scene_.materials[0].emission = glm::vec3(1.0f);
    for (const int bounces : {4, 5, 8}) {
        scene_.settings.bounces = bounces;
        const Image image = render(View::coarse, 4);
        for (std::size_t c = 0; c < 3; ++c) {
            double sum = 0.0, squares = 0.0;
            for (std::size_t i = c; i < image.pixels.size(); i += 3) {
                sum += image.pixels[i];
                squares += static_cast<double>(image.pixels[i]) * image.pixels[i];
            }
            const double n = static_cast<double>(image.pixels.size()) / 3.0, mean = sum / n;
            expect(mean, series(albedo[static_cast<int>(c)], bounces), std::to_string(bounces));
            const double deviation = std::sqrt(std::max(squares / n - mean * mean, 0.0));
            EXPECT_EQ(deviation > 1e-4, bounces > 4) << deviation;
        }
    }
}

/// From every point of a sphere every other looks equally large, so indirect light is the same everywhere.
TEST_F(ClosedForms, PointLightInsideASphere) {
    hollow_sphere();
    apply(scene_, AddLight{Light{}});
    scene_.lights[0].intensity = glm::vec3(2.0f);
    for (const glm::vec3 at : {glm::vec3(0.0f), glm::vec3(0.3f, -0.4f, 0.1f)})
        for (const int bounces : {1, 8}) {
            scene_.lights[0].position = at;
            scene_.settings.bounces = bounces;
            expect(pi * mean(View::coarse, at.x == 0.0f ? 1 : 8), 2.0 * 0.5 * series(0.5, bounces),
                   std::to_string(bounces));
        }
}

TEST_F(ClosedForms, DiffuseSphereAroundAPointLight) {
    hollow_sphere();
    apply(scene_, AddLight{Light{}});
    scene_.lights[0].position = glm::vec3(0.0f);
    scene_.lights[0].intensity = glm::vec3(static_cast<float>(pi));
    scene_.settings.bounces = 8;
    expect(mean(View::direct, 1), 0.5, "direct");
    expect(mean(View::result, 1), 1.0 - std::pow(0.5, 9), "result");
}

/// In the mirror direction of a directional light Phong's cosine is 1.
TEST_F(ClosedForms, PhongHighlightInTheMirrorDirection) {
    add(plane());
    apply(scene_, AddLight{Light{}});
    scene_.lights[0].kind = LightKind::directional;
    scene_.lights[0].direction = {-1.0f, -1.0f, 0.0f};
    scene_.lights[0].intensity = glm::vec3(2.0f);
    look_at_patch({0.0f, 0.0f, 0.0f}, {-1.0f, 1.0f, 0.0f});
    for (const float exponent : {1.0f, 32.0f}) {
        scene_.materials[0].specular = 0.3f;
        scene_.materials[0].exponent = exponent;
        const double irradiance = 2.0 * std::sqrt(0.5);
        expect(mean(View::direct, 1), irradiance * (0.5 / pi + 0.3 * (exponent + 2.0) / (2.0 * pi)));
    }
}

/// Half space minus a sphere of radius 1 whose centre lies h deep.
TEST_F(ClosedForms, SphericalPitUnderASky) {
    const double h = 0.5, f = 0.5 * (1.0 - h);
    const Id cut = add(make_node(NodeKind::subtract));
    add(plane(), {}, cut);
    add(sphere(1.0f), {0.0f, static_cast<float>(-h), 0.0f}, cut);
    scene_.sky = {glm::vec3(1.0f), glm::vec3(1.0f)};
    for (const glm::vec3 at : {glm::vec3(0.0f, -1.5f, 0.0f), glm::vec3(0.8f, -1.1f, 0.0f)})
        for (const int bounces : {1, 8}) {
            scene_.settings.bounces = bounces;
            look_at_patch(at, at + glm::vec3(-0.3f, 0.8f, 0.02f));
            expect(mean(View::coarse, 8), f * series(0.5 * (1.0 - f), bounces), std::to_string(bounces));
        }
}

/// Two half planes at an angle beta: similar to itself at every scale, so the same at every distance from the edge.
TEST_F(ClosedForms, InfiniteWedgeUnderASky) {
    scene_.sky = {glm::vec3(1.0f), glm::vec3(1.0f)};
    add(plane());
    const Id wall = add(plane());
    for (const float beta : {60.0f, 90.0f, 135.0f}) {
        apply(scene_, SetValue{{ObjectType::node, wall}, "rotate", {0.0f, 0.0f, beta - 180.0f}});
        const double f = 0.5 * (1.0 + std::cos(beta * pi / 180.0));
        for (const int bounces : {1, 8}) {
            scene_.settings.bounces = bounces;
            look_at_patch({1.0f, 0.0f, 0.0f}, {1.2f, 0.2f, 0.01f});
            expect(mean(View::coarse, bounces == 1 ? 8 : 4), (1.0 - f) * series(0.5 * f, bounces),
                   std::to_string(beta) + " " + std::to_string(bounces));
        }
    }
}

/// On a floor at distance a from a wall, the share of cosine-weighted directions that meet the wall within radius r is
/// [acos c - c sqrt(1 - c²)] / pi with c = a / r.
TEST_F(ClosedForms, AmbientOcclusionBesideAWall) {
    add(plane());
    add(plane(-90.0f));
    scene_.settings.method = Method::paper;  // farfield weighs what it meets by distance
    for (const double c : {0.02, 0.2, 0.5, 0.8}) {
        const float a = static_cast<float>(c) * scene_.settings.ao_radius;
        look_at_patch({a, 0.0f, 0.0f}, {a, 0.2f, 0.01f});
        expect(mean(View::occlusion, 4), 1.0 - (std::acos(c) - c * std::sqrt(1.0 - c * c)) / pi, std::to_string(c));
    }
}

/// What a sphere over a floor hides of a sky, seen from a point of the floor.
TEST_F(ClosedForms, SphereOverAPlane) {
    const double r = 0.5, h = 0.7;
    add(plane());
    add(sphere(static_cast<float>(r)), {0.0f, static_cast<float>(h), 0.0f});
    scene_.materials[0].albedo = glm::vec3(0.0f);
    scene_.sky = {glm::vec3(1.0f), glm::vec3(1.0f)};
    scene_.settings.ao_radius = 100.0f;
    scene_.settings.method = Method::paper;
    for (const double x : {0.0, 0.3, 1.0}) {
        const float at = static_cast<float>(x);
        look_at_patch({at, 0.0f, 0.0f}, {at + 0.1f, 0.1f, 0.01f});
        const double answer = 1.0 - h * r * r / std::pow(x * x + h * h, 1.5);
        expect(mean(View::coarse, 16), answer, "sky");
        expect(mean(View::occlusion, 16), answer, "occlusion");
    }
}

/// Two planes without end face each other, and the lower one emits.
TEST_F(ClosedForms, ParallelPlanes) {
    add(plane());
    Node upper = plane(180.0f);
    upper.material = add_material(glm::vec3(0.3f), glm::vec3(0.0f));
    add(upper, {0.0f, 1.0f, 0.0f});
    scene_.materials[0].emission = glm::vec3(1.0f);
    for (const int bounces : {2, 8}) {
        scene_.settings.bounces = bounces;
        const double b1 = series(0.5 * 0.3, bounces / 2 + 1), b2 = 0.3 * series(0.5 * 0.3, bounces / 2);
        look_at_patch({0.0f, 0.0f, 0.0f}, {0.1f, 0.5f, 0.0f});
        expect(mean(View::result, bounces == 2 ? 4 : 2), b1, "lower " + std::to_string(bounces));
        look_at_patch({0.0f, 1.0f, 0.0f}, {0.1f, 0.5f, 0.0f});
        expect(mean(View::result, bounces == 2 ? 4 : 2), b2, "upper " + std::to_string(bounces));
    }
}

TEST_F(ClosedForms, CoaxialDisc) {
    const double r = 0.5;
    add(plane());
    Node disc = make_node(NodeKind::capped_cylinder);
    disc.material = add_material(glm::vec3(0.0f), glm::vec3(1.0f));
    const float half = 0.01f;
    disc.values[0].x = static_cast<float>(r);
    disc.values[1].x = half;
    const Id id = add(disc);
    for (const double h : {0.1, 0.5, 1.0}) {
        apply(scene_, SetValue{{ObjectType::node, id}, "translate", {0.0f, static_cast<float>(h) + half, 0.0f}});
        look_at_patch({0.0f, 0.0f, 0.0f}, {0.05f, 0.05f, 0.01f});
        expect(mean(View::coarse, 16), r * r / (r * r + h * h), std::to_string(h));
    }
}

/// Spheres that few of the rays would meet by chance: one of 156 cosine-distributed ones comes to the first. So the
/// pixels of 16 samples would deviate by three times their mean.
TEST_F(ClosedForms, SmallSpheresOfLight) {
    add(plane());
    Node lamp = sphere(0.2f);
    lamp.material = add_material(glm::vec3(0.0f), glm::vec3(3.0f));
    double answer = 0.0;
    for (const glm::dvec3 at : {glm::dvec3(0.0, 2.5, 0.0), glm::dvec3(2.0, 1.0, 1.0), glm::dvec3(-5.0, 3.0, 2.0)}) {
        add(lamp, at);
        answer += 3.0 * 0.2 * 0.2 * at.y / std::pow(glm::length(at), 3.0);
        look_at_patch({0.0f, 0.0f, 0.0f}, {0.05f, 0.05f, 0.01f});
        expect(mean(View::coarse, 8), answer);
        renderer_->discard();
        const Image image = render(View::coarse, 1);
        double squares = 0.0;
        for (const float v : image.pixels) squares += (v - answer) * (v - answer);
        EXPECT_LT(std::sqrt(squares / static_cast<double>(image.pixels.size())) / answer, 0.6);
    }
}

}  // namespace
}  // namespace farfield
