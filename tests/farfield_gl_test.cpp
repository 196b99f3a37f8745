// The consistent near/far estimator (renderer/METHOD.md): closed forms, energy, convergence and edges.
#include "renderer/context.h"
#include "renderer/renderer.h"
#include "sdf/edit.h"
#include "sdf/scene_file.h"
#include "tests/test_support.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace farfield {
namespace {

Scene bundled(const std::string& name) { return load_scene(std::filesystem::path(FARFIELD_SCENES) / (name + ".json")); }

class Farfield : public testing::Test {
protected:
    Farfield() : context_(make_headless_context(ContextKind::automatic)) {
        context_->make_current();
        renderer_.emplace();
    }
    ~Farfield() override {
        renderer_.reset();
        context_->release();
    }
    /// Accumulates up to `frames` frames since the last change of transport.
    void accumulate(const Scene& scene, int frames, std::uint32_t seed = 0) {
        options_.seed = seed;
        renderer_->update(scene, options_);
        while (renderer_->statistics().frames < frames) renderer_->render_frame();
    }
    /// What the accumulated samples say by another method, another number of blur levels.
    Image read(Scene scene, Method method, int blur_levels) {
        scene.settings.method = method;
        scene.settings.blur_levels = blur_levels;
        EXPECT_FALSE(renderer_->update(scene, options_)) << "samples were discarded";
        return renderer_->read(View::result);
    }
    /// Without direct light, whose edges are smooth after many frames only, whatever the method.
    Image read_indirect(const Scene& scene, Method method, int blur_levels) {
        Image image = read(scene, method, blur_levels);
        const Image direct = renderer_->read(View::direct);
        for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] -= direct.pixels[i];
        return image;
    }
    FrameOptions options_{.size = {64, 64}};
    std::unique_ptr<Context> context_;
    std::optional<Renderer> renderer_;
};

double mean(const Image& image) {
    double sum = 0.0;
    for (const float v : image.pixels) sum += v;
    return sum / static_cast<double>(image.pixels.size());
}

/// A plane of albedo 1 that fills the picture under a sky of radiance 1 has irradiance pi, so radiance 1, by every ray
/// but the few that graze the plane and count as met.
TEST_F(Farfield, PlaneUnderAConstantSkyHasIrradiancePi) {
    Scene scene;
    apply(scene, InsertNode{scene.root.id, -1, make_node(NodeKind::plane)});
    scene.materials[0].albedo = glm::vec3(1.0f);
    scene.sky = {glm::vec3(1.0f), glm::vec3(1.0f)};
    scene.camera.position = {0.0f, 2.0f, 0.5f};
    scene.camera.target = glm::vec3(0.0f);
    for (const int frames : {1, 2}) {
        accumulate(scene, frames);
        for (const int levels : {0, 1, 3, 6}) {
            const Image image = read(scene, Method::farfield, levels);
            EXPECT_NEAR(mean(image), 1.0, 0.002) << levels;
            EXPECT_LE(*std::max_element(image.pixels.begin(), image.pixels.end()), 1.0f + 1e-3f) << levels;
        }
    }
}

/// Inside a closed box that emits 1 and reflects half: 1.5 after one bounce, everywhere, whatever is near or far.
TEST_F(Farfield, FurnaceIsExactForEveryAoRadius) {
    Scene scene;
    const Id shell = apply(scene, InsertNode{scene.root.id, -1, make_node(NodeKind::shell)});
    Node box = make_node(NodeKind::box);
    box.values[0] = glm::vec3(2.0f);
    apply(scene, InsertNode{shell, -1, box});
    scene.materials[0].albedo = glm::vec3(0.5f);
    scene.materials[0].emission = glm::vec3(1.0f);
    scene.camera.position = {0.3f, 0.2f, 0.5f};
    scene.camera.target = {0.0f, 0.0f, -1.0f};
    for (const float radius : {0.1f, 1.0f, 10.0f}) {
        scene.settings.ao_radius = radius;
        accumulate(scene, renderer_->ready() ? renderer_->statistics().frames + 4 : 4);
        EXPECT_NEAR(mean(read(scene, Method::farfield, 0)), 1.5, 1e-4);
        // The openness in front has noise of its own, which the mean does not have.
        EXPECT_NEAR(mean(read(scene, Method::farfield, 3)), 1.5, 0.015) << radius;
    }
}

TEST_F(Farfield, WithoutBlurIsTheReferenceAndPaperIsUntouched) {
    const Scene scene = bundled("still_life");
    accumulate(scene, 2);
    const Image paper = read(scene, Method::paper, 3), reference = read(scene, Method::reference, 3);
    const Image farfield = read(scene, Method::farfield, 0);
    for (std::size_t i = 0; i < reference.pixels.size(); ++i)
        ASSERT_NEAR(farfield.pixels[i], reference.pixels[i], 1e-4 * (1.0 + reference.pixels[i]));
    EXPECT_EQ(read(scene, Method::paper, 3).pixels, paper.pixels);
    EXPECT_EQ(read(scene, Method::reference, 0).pixels, reference.pixels);
}

/// Error of indirect light against a reference of other samples falls, and the mean stays, for every AO radius.
TEST_F(Farfield, ConvergesToTheReferenceForEveryAoRadius) {
    options_.size = {48, 48};
    Scene scene = bundled("cornell");
    scene.settings.samples = 16;
    accumulate(scene, 64, 99);
    const Image truth = read_indirect(scene, Method::reference, 0);
    for (const float radius : {0.2f, 0.6f, 2.0f}) {
        scene.settings.ao_radius = radius;
        scene.settings.samples = 4;
        std::vector<double> errors;
        for (const int frames : {1, 4, 64}) {
            accumulate(scene, frames, static_cast<std::uint32_t>(10.0f * radius));
            const Image image = read_indirect(scene, Method::farfield, 3);
            EXPECT_EQ(count_invalid(image), 0u);
            errors.push_back(compare(image, truth).rmse);
            if (frames == 64) {
                EXPECT_NEAR(mean(image) / mean(truth), 1.0, 0.01) << radius;
            }
        }
        EXPECT_LT(errors[1], 0.8 * errors[0]) << radius;
        EXPECT_LT(errors[2], 0.6 * errors[1]) << radius;
        EXPECT_LT(errors[2], compare(read_indirect(scene, Method::paper, 3), truth).rmse) << radius;
    }
}

/// Two rooms of one floor, a lamp in the left one, a wall of few pixels between them, seen from above: the dark room
/// stays dark in the first frame and in every other.
TEST_F(Farfield, NothingLeaksAcrossAThinWall) {
    Scene scene;
    apply(scene, InsertNode{scene.root.id, -1, make_node(NodeKind::plane)});
    const auto add_box = [&](glm::vec3 half_size, glm::vec3 at) {
        Node box = make_node(NodeKind::box);
        box.values[0] = half_size;
        box.transform.translate = at;
        return apply(scene, InsertNode{scene.root.id, -1, box});
    };
    const Id wall = add_box({0.05f, 1.0f, 2.0f}, {0.0f, 1.0f, 0.0f});
    for (const float side : {-1.0f, 1.0f}) {
        add_box({0.05f, 1.0f, 2.0f}, {2.0f * side, 1.0f, 0.0f});
        add_box({2.0f, 1.0f, 0.05f}, {0.0f, 1.0f, 2.0f * side});
    }
    apply(scene, AddLight{Light{}});
    scene.lights[0].position = {-1.0f, 0.8f, 0.0f};
    scene.lights[0].intensity = glm::vec3(3.0f);
    scene.camera.position = {0.0f, 8.0f, 0.01f};
    scene.camera.target = glm::vec3(0.0f);
    scene.camera.field_of_view = 26.0f;
    scene.settings.blur_levels = 4;
    for (const float pixels : {1.0f, 2.0f, 4.0f, 8.0f}) {
        // 64 pixels show 3.7 m of the floor.
        apply(scene, SetValue{{ObjectType::node, wall}, "half_size", {0.5f * pixels * 3.7f / 64.0f, 1.0f, 2.0f}});
        accumulate(scene, 1);
        const Image image = read(scene, Method::farfield, 4);
        double bright = 0.0, dark = 0.0;
        for (int y = 16; y < 48; ++y)
            for (int x = 0; x < 64; ++x) {
                const float v = image.pixels[static_cast<std::size_t>(3 * (64 * y + x))];
                if (x >= 8 && x < 24) bright += v / (16.0 * 32.0);
                if (x >= 37 && x < 53) dark += v / (16.0 * 32.0);
            }
        EXPECT_GT(bright, 0.0);
        EXPECT_LT(dark, 1e-6 * bright) << pixels;  // 7e-5 without links
    }
}

TEST_F(Farfield, IsFiniteRepeatableAndSeedsMatter) {
    for (const auto& file : bundled_scenes()) {
        const Scene scene = load_scene(file);
        for (const View view : {View::result, View::filtered, View::direct_filtered, View::occlusion}) {
            accumulate(scene, 1);
            read(scene, Method::farfield, 3);
            EXPECT_EQ(count_invalid(renderer_->read(view)), 0u) << file;
        }
    }
    const Scene scene = bundled("cornell");
    accumulate(scene, 2);
    const Image first = read(scene, Method::farfield, 3);
    accumulate(scene, 2, 1);
    EXPECT_NE(read(scene, Method::farfield, 3).pixels, first.pixels);
    accumulate(scene, 2, 0);
    EXPECT_EQ(read(scene, Method::farfield, 3).pixels, first.pixels);
}

/// Another AO radius restarts the split alone: the reference and the coarse far light keep every sample, and the
/// picture right after stays near the one before.
TEST_F(Farfield, AnotherAoRadiusKeepsAllFarLight) {
    Scene scene = bundled("cornell");
    accumulate(scene, 16);
    const Image before = read(scene, Method::farfield, 3), reference = read(scene, Method::reference, 3);
    scene.settings.ao_radius = 0.1f;
    const Image after = read(scene, Method::farfield, 3);
    EXPECT_EQ(read(scene, Method::reference, 3).pixels, reference.pixels);
    EXPECT_LT(compare(before, after).rmse, 0.1 * mean(before));
    renderer_->render_frame();
    EXPECT_LT(compare(before, read(scene, Method::farfield, 3)).rmse, 0.1 * mean(before));
}

}  // namespace
}  // namespace farfield
