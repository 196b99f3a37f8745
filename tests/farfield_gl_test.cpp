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

TEST_F(Farfield, AutomaticBlurLevelsGoByTheSizeOfThePicture) {
    EXPECT_EQ(blur_levels(3, {4096, 4096}), 3);
    EXPECT_EQ(blur_levels(0, {4096, 4096}), 0);
    for (const auto& [side, levels] : {std::pair(1, 1), {64, 1}, {128, 2}, {256, 3}, {512, 4}, {2160, 6}})
        EXPECT_EQ(blur_levels(-1, {2 * side, side}), levels) << side;
    const Scene scene = load_scene(std::filesystem::path(FARFIELD_SCENES) / "cornell.json");
    accumulate(scene, 1);
    for (const Method method : {Method::paper, Method::farfield})
        EXPECT_EQ(read(scene, method, -1).pixels, read(scene, method, 1).pixels);
}

/// In a furnace that emits 1 and reflects half bounce k adds 2^(1-k) to 2 - 2^(2-k).
TEST_F(Farfield, AutomaticBouncesStopWhereTheNextAddsLittle) {
    Scene scene;
    const Id shell = apply(scene, InsertNode{scene.root.id, -1, make_node(NodeKind::shell)});
    apply(scene, InsertNode{shell, -1, make_node(NodeKind::sphere)});
    scene.materials[0].albedo = glm::vec3(0.5f);
    scene.materials[0].emission = glm::vec3(1.0f);
    scene.camera.position = {0.1f, 0.0f, 0.2f};
    scene.camera.target = glm::vec3(0.0f);
    scene.settings.bounces = 0;
    accumulate(scene, 1);
    const std::vector<float> shares = renderer_->statistics().bounce_shares;
    ASSERT_EQ(shares.size(), 9u);
    for (int k = 2; k <= 9; ++k)
        EXPECT_NEAR(shares[static_cast<std::size_t>(k - 1)] * (2.0 - std::pow(2.0, 2 - k)), std::pow(2.0, 1 - k),
                    0.1 * std::pow(2.0, 1 - k))
            << k;
    EXPECT_EQ(renderer_->statistics().bounces, 7);
    EXPECT_EQ(bounces_text(renderer_->statistics()), "7 bounces; bounce 8 adds 0.4 %");
    const Image automatic = read(scene, Method::reference, 0);
    scene.settings.bounces = 7;
    accumulate(scene, 1);
    EXPECT_EQ(read(scene, Method::reference, 0).pixels, automatic.pixels);

    // While a hand moves things the last measurement goes on; a dark scene needs one bounce.
    scene.settings.bounces = 0;
    scene.materials[0].albedo = glm::vec3(0.0f);
    accumulate(scene, 1);
    EXPECT_EQ(renderer_->statistics().bounces, 7);
    options_.measure_bounces = true;
    EXPECT_FALSE(renderer_->update(scene, options_));
    while (renderer_->statistics().bounces != 1) renderer_->step();
    EXPECT_EQ(renderer_->statistics().samples, 0);  // of seven bounces
    options_.measure_bounces = false;
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

/// Two rooms of one floor, a lamp in the left one, a wall between them, seen from above. The dark room, which no light
/// reaches, stays dark in the first frame and in every other, up to the wall. In the first frame the camera rays pass
/// the thinnest wall on both sides: nothing but the light itself tells the rooms apart there.
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
    for (const float pixels : {0.5f, 1.0f, 2.0f, 4.0f, 8.0f}) {
        // 64 pixels show 3.7 m of the floor; the wall's top is nearer to the camera and looks 8 / 6 as thick.
        apply(scene, SetValue{{ObjectType::node, wall}, "half_size", {0.5f * pixels * 3.7f / 64.0f, 1.0f, 2.0f}});
        const int beside = 32 + static_cast<int>(std::ceil(0.5f * pixels * 8.0f / 6.0f));
        scene.settings.samples = 4;
        accumulate(scene, 1);
        for (const int samples : {4, 16, 64, 256}) {
            // As the samples per frame change, so does nothing else.
            while (renderer_->statistics().samples < samples) {
                scene.settings.samples = std::min(samples - renderer_->statistics().samples, 64);
                EXPECT_FALSE(renderer_->update(scene, options_));
                renderer_->render_frame();
            }
            const Image image = read(scene, Method::farfield, 4);
            const auto columns = [&](int first, int last) {
                double sum = 0.0;
                for (int y = 16; y < 48; ++y)
                    for (int x = first; x < last; ++x) sum += image.pixels[static_cast<std::size_t>(3 * (64 * y + x))];
                return sum / (32.0 * (last - first));
            };
            const double bright = columns(8, 24);
            EXPECT_GT(bright, 0.0);
            EXPECT_LT(columns(beside, 56), 0.02 * bright) << pixels << " pixels, " << samples << " samples";
            if (pixels >= 1.0f) {
                EXPECT_LT(columns(37, 56), 1e-6 * bright) << pixels;  // 7e-5 without links
            }
        }
    }
}

/// No visible jump while samples accumulate: the indirect light of each picture is nearer to that of the one before
/// than that was to its own.
TEST_F(Farfield, SuccessivePicturesComeEverCloser) {
    const Scene scene = bundled("two_rooms");
    const auto indirect = [&] {
        Image image = read(scene, Method::farfield, 3);
        const Image direct = renderer_->read(View::direct);
        for (std::size_t i = 0; i < direct.pixels.size(); ++i) image.pixels[i] -= direct.pixels[i];
        return image;
    };
    double last = 1e30;
    for (const int frames : {1, 2, 4, 8, 16}) {
        double change = 0.0;  // the mean over seeds: single pixels that meet the lamp by chance count much
        constexpr std::uint32_t seeds = 3;
        for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
            accumulate(scene, frames, seed);
            const Image before = indirect();
            renderer_->render_frame();
            change += compare(before, indirect()).rmse / mean(before) / seeds;
        }
        EXPECT_LT(change, last) << frames;
        last = change;
    }
    EXPECT_LT(last, 0.04);
}

/// How far the filters spread one bright pixel on a wall across the picture: the standard deviation along a row, on the
/// mean of where the pixel lies in the mip chain's texels.
TEST_F(Farfield, BlurLevelsAreAsWideInThePapersFilterAsInTheWavelet) {
    constexpr int side = 128;
    options_.size = {side, side};
    Scene scene;
    scene.camera = {{0.0f, 0.0f, 1.0f}, {0.0f, 0.0f, 0.0f}, 1.0f};
    accumulate(scene, 1);
    read(scene, Method::reference, 0);  // leaves the camera bound
    Targets targets(options_.size);
    const std::vector<glm::vec4> wall(side * side, {0.0f, 0.0f, 1.0f, 1.0f}), nothing(side * side, {0, 0, 0, 1});
    targets.geometry.upload(std::span(wall));
    targets.direct.upload(std::span(nothing));
    targets.split_near.upload(std::span(nothing));
    targets.bind();
    FilterPass mips;
    WaveletPass wavelet;
    SynthesisPass synthesis;
    const auto variance = [&](Method method, int levels, int at) {
        std::vector<glm::vec4> light = nothing;
        light[static_cast<std::size_t>(side * at + at)] = glm::vec4(1.0f);
        targets.far_light.upload(std::span<const glm::vec4>(light));
        targets.split_far.upload(std::span<const glm::vec4>(light));
        const gl::Texture* blurred = nullptr;
        const gl::Raster* filtered = nullptr;
        if (method == Method::paper) {
            blurred = &mips.run(targets, levels);
        } else {
            EXPECT_TRUE(wavelet.run(targets.wavelet, levels, {}));
            filtered = &wavelet.far_light(targets.wavelet, levels);
        }
        synthesis.run(targets, blurred, filtered, nullptr, static_cast<int>(View::filtered), method, 1);
        const Image image{options_.size, targets.view().read()};
        double sum = 0.0, squares = 0.0;
        for (int i = 0; i < side * side; ++i) {
            const double v = image.pixels[static_cast<std::size_t>(3 * i)], x = i % side - at;
            sum += v;
            squares += v * x * x;
        }
        EXPECT_NEAR(sum, 1.0, 0.03);  // wherever the pixel lies in the coarse levels' grids
        return squares / sum;
    };
    for (const int levels : {1, 2, 3}) {
        double paper = 0.0, farfield = 0.0;
        for (int i = 0; i < 8; ++i) {
            paper += variance(Method::paper, levels, 60 + i) / 8.0;
            farfield += variance(Method::farfield, levels, 60 + i) / 8.0;
        }
        // B3 spline: 1 + 4 + 16 + ..., restriction to the next grid and linear interpolation back, (4^i - 1) / 6 each;
        // mips: box, binomial and linear interpolation, 4^i (1/12 + 1 + 1/6).
        const double scale = std::pow(4.0, levels);
        EXPECT_NEAR(farfield, (5.0 * scale - 2.0) / 3.0, 0.03 * scale) << levels;
        EXPECT_NEAR(paper, 1.25 * scale, 0.1 * scale) << levels;
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

/// One sample for each pixel, as while a hand moves something: nothing tells its variance but the pixels around.
TEST_F(Farfield, OneSampleIsFilteredToo) {
    Scene scene = bundled("cornell");
    scene.settings.samples = 16;
    accumulate(scene, 16, 99);
    const Image truth = read(scene, Method::reference, 0);
    scene.settings.samples = 1;
    accumulate(scene, 1);
    EXPECT_LT(compare(read(scene, Method::farfield, 3), truth).rmse,
              0.5 * compare(read(scene, Method::reference, 0), truth).rmse);
}

/// Showing can be interrupted between levels: the texture is as it was, and the next picture is right.
TEST_F(Farfield, AnInterruptedPictureLeavesNoTrace) {
    const Scene scene = bundled("cornell");
    accumulate(scene, 2);
    const std::vector<unsigned char> whole = renderer_->display_pixels();
    const gl::Texture texture("picture", GL_RGBA8, options_.size);
    const auto pixels = [&] {
        std::vector<unsigned char> rgb(whole.size());
        glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
        texture.bind(0);
        glPixelStorei(GL_PACK_ALIGNMENT, 1);
        glGetTexImage(GL_TEXTURE_2D, 0, GL_RGB, GL_UNSIGNED_BYTE, rgb.data());
        return rgb;
    };
    ASSERT_TRUE(renderer_->display(texture));
    EXPECT_EQ(pixels(), whole);
    renderer_->render_frame();
    for (const int last : {1, 2, 6}) {
        int asked = 0;
        EXPECT_FALSE(renderer_->display(texture, {}, [&] { return ++asked == last; }));
        EXPECT_EQ(asked, last);
        EXPECT_EQ(pixels(), whole);
    }
    ASSERT_TRUE(renderer_->display(texture, {}, [] { return false; }));
    EXPECT_EQ(pixels(), renderer_->display_pixels());
    EXPECT_NE(pixels(), whole);
}

/// Another AO radius restarts the split alone: the reference and the coarse far light keep every sample, and the
/// picture right after stays near the one before.
TEST_F(Farfield, AnotherAoRadiusKeepsAllFarLight) {
    Scene scene = bundled("cornell");
    accumulate(scene, 16);
    const int samples = renderer_->statistics().samples;
    const Image before = read(scene, Method::farfield, 3), reference = read(scene, Method::reference, 3);
    const Image coarse = renderer_->read(View::coarse);
    for (const float radius : {0.1f, 2.0f, 0.1f}) {
        scene.settings.ao_radius = radius;
        const Image after = read(scene, Method::farfield, 3);
        EXPECT_EQ(renderer_->statistics().samples, samples);
        EXPECT_EQ(read(scene, Method::reference, 3).pixels, reference.pixels);
        EXPECT_EQ(renderer_->read(View::coarse).pixels, coarse.pixels);
        EXPECT_LT(compare(before, after).rmse, 0.1 * mean(before));
    }
    renderer_->render_frame();
    EXPECT_EQ(renderer_->statistics().samples, samples + scene.settings.samples);
    EXPECT_LT(compare(before, read(scene, Method::farfield, 3)).rmse, 0.1 * mean(before));
}

}  // namespace
}  // namespace farfield
