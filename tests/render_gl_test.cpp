// The renderer as a whole: contexts agree, repetition is exact, edits keep what they may keep.
#include "renderer/renderer.h"

#include "renderer/context.h"
#include "renderer/metrics.h"
#include "renderer/records.h"
#include "sdf/edit.h"
#include "sdf/scene_file.h"
#include "sdf/scene_parts.h"
#include "tests/gl_test.h"
#include "tests/test_support.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace farfield {
namespace {

constexpr FrameOptions small{.size = {96, 64}};
/// For pictures of one scene in two ways, of which one marches to what the other meets in closed form.
constexpr FrameOptions fine{.size = {96, 64}, .minimum_step = 0.1f};

Scene bundled(const std::string& name) { return load_scene(std::filesystem::path(FARFIELD_SCENES) / (name + ".json")); }

class Render : public testing::Test {
protected:
    void use(ContextKind kind) {
        renderer_.reset();
        if (context_) context_->release();
        context_ = make_headless_context(kind);
        context_->make_current();
        renderer_.emplace();
    }
    void SetUp() override { use(ContextKind::automatic); }
    void TearDown() override {
        renderer_.reset();
        context_->release();
    }
    /// `frames` more frames of the scene.
    Image render(const Scene& scene, int frames, const FrameOptions& options = small, View view = View::result) {
        renderer_->update(scene, options);
        for (int i = 0; i < frames; ++i) renderer_->render_frame();
        return renderer_->read(view);
    }
    std::unique_ptr<Context> context_;
    std::optional<Renderer> renderer_;
};

TEST_F(Render, EglAndOsMesaAgreeAndNothingIsNanOrInfinite) {
    for (const auto& file : bundled_scenes()) {
        const Scene scene = load_scene(file);
        std::vector<Image> images;
        for (const ContextKind kind : {ContextKind::egl, ContextKind::osmesa}) {
            use(kind);
            images.push_back(render(scene, 2));
            for (const ViewInfo& view : views())
                EXPECT_EQ(count_invalid(renderer_->read(view.view)), 0u)
                    << file << " " << view.key << " " << context_->name();
        }
        EXPECT_LE(compare(images[0], images[1]).rmse, 1e-4) << file;
    }
}

TEST_F(Render, RepetitionIsBitIdentical) {
    const Scene scene = bundled("cornell");
    const Image first = render(scene, 3);
    use(ContextKind::automatic);
    EXPECT_EQ(first.pixels, render(scene, 3).pixels);
    use(ContextKind::automatic);
    FrameOptions other = small;
    other.seed = 1;
    EXPECT_NE(first.pixels, render(scene, 3, other).pixels);
}

TEST_F(Render, AllTiersGiveTheSamePicture) {
    for (const char* name : {"cornell", "primitives", "csg_part"}) {
        const Scene scene = bundled(name);
        // The Cornell room's ceiling beside the lamp is half in its shadow, which moves with the places where rays
        // start.
        const FrameOptions usual = std::string_view(name) == "cornell" ? small : fine;
        FrameOptions live = usual, tuned = usual;
        live.tier = Tier::live;
        tuned.tuned = scene.root.children.at(0).id;
        use(ContextKind::automatic);
        const Image literals = render(scene, 2, usual);
        for (const FrameOptions& options : {live, tuned}) {
            use(ContextKind::automatic);
            // Rounding differs, and where rays stop within their tolerance, so single paths may part ways; the picture
            // must not.
            const Difference difference = compare(literals, render(scene, 2, options));
            EXPECT_LE(difference.rmse, 6e-3) << name;
        }
    }
}

TEST_F(Render, ALargeSceneInPartsGivesThePictureOfTheWhole) {
    for (const char* name : {"chess", "helix"}) {
        const Scene scene = bundled(name);
        Scene whole = scene;  // below an operation that changes nothing, which is not taken apart
        whole.root.children.assign(1, make_node(NodeKind::round));
        whole.root.children[0].id = whole.new_id();
        whole.root.children[0].values[0] = glm::vec3(0.0f);
        whole.root.children[0].children = scene.root.children;
        ASSERT_GT(scene_parts(scene).size(), 1u);
        ASSERT_EQ(scene_parts(whole).size(), 1u);
        FrameOptions counted = fine;
        counted.counting = true;
        use(ContextKind::automatic);
        const Image apart = render(scene, 2, counted), depth = renderer_->read(View::depth);
        const std::uint64_t rays = renderer_->statistics().rays;
        use(ContextKind::automatic);
        const Image together = render(whole, 2, counted), whole_depth = renderer_->read(View::depth);
        EXPECT_NEAR(static_cast<double>(rays), static_cast<double>(renderer_->statistics().rays),
                    0.001 * static_cast<double>(rays))
            << name;
        // A few rays that graze an edge meet it in one of the two.
        EXPECT_LE(differing_pixels(apart, together, 0.1f), 12u) << name << " of 6144";
        EXPECT_LE(differing_pixels(depth, whole_depth, 0.02f), 12u) << name;
    }
}

/// llvmpipe ends loops that have come to many turns, with all rays that an invocation has left.
TEST_F(Render, NoRayIsLostWhereTheDistanceTakesLoops) {
    const Scene scene = parse_scene(R"({"farfield": 1,
        "camera": {"position": [0, 0, 1.2], "target": [0, 0, 0]},
        "root": {"kind": "union", "children": [
            {"kind": "plane", "translate": [0, -3, 0]},
            {"kind": "plane", "translate": [0, 0, -3], "rotate": [90, 0, 0]},
            {"kind": "mandelbulb", "radius": 1, "power": 15, "iterations": 16}]}})",
                                    "scene");
    const Image steps = render(scene, 1, {.size = {256, 128}}, View::steps);
    EXPECT_EQ(std::count(steps.pixels.begin(), steps.pixels.end(), 0.0f), 0) << "rays that were never marched";
}

/// Nor with few turns for each of many nodes: noise has eight.
TEST_F(Render, NoRayIsLostWhereManyNodesTakeLoops) {
    std::string nodes;
    for (int i = 0; i < 22; ++i)
        nodes += fmt::format(R"({}{{"kind": "displace_noise", "amplitude": 0.05, "size": 0.2, "octaves": 8,
                                   "translate": [{}, {}, {}], "children": [{{"kind": "sphere", "radius": 0.5}}]}})",
                             i == 0 ? "" : ", ", 0.8 * (i % 5 - 2), 0.8 * (i / 5 - 2), 0.4 * (i % 4));
    const Scene scene = parse_scene(fmt::format(R"({{"farfield": 1,
        "settings": {{"samples": 1, "bounces": 1}}, "camera": {{"position": [0.3, 0.2, 5], "target": [0.3, 0.2, 0]}},
        "root": {{"kind": "union", "radius": 0.3, "children": [{}]}}}})",
                                                nodes),
                                    "noise");
    const FrameOptions options{.size = {48, 48}, .counting = true};
    const Image depth = render(scene, 1, options, View::depth);
    std::uint64_t rays = 48 * 48;  // and one more from each surface
    for (std::size_t i = 0; i < depth.pixels.size(); i += 3) rays += depth.pixels[i] > 0.0f;
    EXPECT_EQ(renderer_->statistics().rays, rays);
}

TEST_F(Render, AnEditOfALargeSceneCompilesItsOwnPart) {
    Scene scene = bundled("helix");
    render(scene, 1);
    const auto compiles = [&] {
        return renderer_->statistics().structural_compiles + renderer_->statistics().specialisations;
    };
    const int parts = compiles();
    EXPECT_GE(parts, 3);
    EXPECT_LT(parts, static_cast<int>(scene_parts(scene).size())) << "two of them are families";
    apply(scene, InsertNode{scene.root.id, 2, make_node(NodeKind::sphere)});
    FrameOptions options = small;
    render(scene, 1, options);
    EXPECT_LE(compiles(), parts + 2);
    // All that the selected node needs, one kernel at a time: march and surface.
    options.tuned = scene.root.children[2].id;
    const int before = compiles();
    int compiled = 0;
    for (; renderer_->needs_compile(scene, options.tier, options.tuned); ++compiled)
        renderer_->compile_one(scene, options.tier, options.tuned);
    EXPECT_EQ(compiled, 2);
    EXPECT_EQ(compiles(), before + 1);
    renderer_->update(scene, options);
    EXPECT_EQ(compiles(), before + 1);
}

TEST_F(Render, SwappingTiersDiscardsNothing) {
    const Scene scene = bundled("cornell");
    FrameOptions live = small;
    live.tier = Tier::live;
    render(scene, 1, live);
    EXPECT_FALSE(renderer_->update(scene, small));
    renderer_->render_frame();
    EXPECT_EQ(renderer_->statistics().frames, 2);
}

TEST_F(Render, ParameterEditsNeverRecompileAndEqualAFreshLoad) {
    FrameOptions live = small;
    live.tier = Tier::live;
    Scene scene = bundled("primitives");
    render(scene, 1, live);
    EXPECT_EQ(renderer_->statistics().structural_compiles, 1);
    std::mt19937 random(9);
    const std::vector<Id> ids = all_ids(scene);
    for (int i = 0; i < 100; ++i) {
        const ObjectRef node{ObjectType::node, ids[random() % ids.size()]};
        const std::vector<Parameter> all = parameters(scene, node);
        const Parameter& parameter = all[random() % all.size()];
        glm::vec3 v = value(scene, node, parameter.key);
        for (int c = 0; c < parameter.components(); ++c)
            v[c] += std::uniform_real_distribution<float>(-0.05f, 0.05f)(random);
        apply(scene, SetValue{node, parameter.key, clamped(parameter, v)});
        renderer_->update(scene, live);
        if (i % 10 == 0) renderer_->render_frame();
    }
    const Image edited = render(scene, 2, live);
    EXPECT_EQ(renderer_->statistics().structural_compiles, 1);
    EXPECT_EQ(renderer_->statistics().specialisations, 0);

    use(ContextKind::automatic);
    const Scene reloaded = parse_scene(to_text(scene), "saved");
    // Not one sample of the hundred old scenes is left, so all bits are equal but for frames rendered in between.
    const Image fresh = render(reloaded, 2, live);
    EXPECT_EQ(edited.pixels, fresh.pixels);
}

TEST_F(Render, ViewEditsKeepAllSamples) {
    Scene scene = bundled("cornell");
    render(scene, 2);
    const int samples = renderer_->statistics().samples;
    const Image coarse = renderer_->read(View::coarse);
    apply(scene, SetValue{{ObjectType::settings}, "blur_levels", {5.0f, 0.0f, 0.0f}});
    apply(scene, SetValue{{ObjectType::settings}, "exposure", {1.0f, 0.0f, 0.0f}});
    apply(scene, SetValue{{ObjectType::settings}, "method", {0.0f, 0.0f, 0.0f}});
    apply(scene, SetValue{{ObjectType::settings}, "samples", {2.0f, 0.0f, 0.0f}});
    FrameOptions other_view = small;
    other_view.view = View::normals;
    EXPECT_FALSE(renderer_->update(scene, other_view));
    EXPECT_EQ(renderer_->statistics().samples, samples);
    EXPECT_EQ(renderer_->read(View::coarse).pixels, coarse.pixels);
    renderer_->render_frame();
    EXPECT_EQ(renderer_->statistics().samples, samples + 2);
}

/// The pixels of a texture, as the screen shows them.
std::vector<unsigned char> pixels_of(const gl::Texture& texture) {
    std::vector<unsigned char> rgb(static_cast<std::size_t>(texture.size().x) * texture.size().y * 3);
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    texture.bind(0);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGB, GL_UNSIGNED_BYTE, rgb.data());
    return rgb;
}

TEST_F(Render, BothHalvesOfASplitPictureAreThePicturesOfTheirSettings) {
    const Scene scene = bundled("cornell");
    const Look own{View::result, scene.settings.method, scene.settings.blur_levels};
    const auto with = [&](const Look& look) {
        Scene changed = scene;
        changed.settings.method = look.method;
        changed.settings.blur_levels = look.blur_levels;
        FrameOptions options = small;
        options.view = look.view;
        options.occlusion = true;
        use(ContextKind::automatic);
        renderer_->update(changed, options);
        for (int i = 0; i < 2; ++i) renderer_->render_frame();
        return renderer_->display_pixels();
    };
    const std::vector<unsigned char> alone = with(own);
    for (const Look& other : {Look{View::result, Method::paper, 3}, Look{View::result, Method::reference, 3},
                              Look{View::direct, Method::farfield, 3}, Look{View::filtered, Method::farfield, 1},
                              Look{View::occlusion, Method::farfield, 3}, own}) {
        const std::vector<unsigned char> expected = with(other);
        FrameOptions options = small;
        options.other = other;
        options.occlusion = true;
        use(ContextKind::automatic);
        renderer_->update(scene, options);
        for (int i = 0; i < 2; ++i) renderer_->render_frame();
        const gl::Texture left("left", GL_RGBA8, small.size), right("right", GL_RGBA8, small.size);
        ASSERT_TRUE(renderer_->display(left, right));
        EXPECT_EQ(pixels_of(left), alone);
        EXPECT_EQ(pixels_of(right), expected);
        EXPECT_EQ(renderer_->display_pixels(), alone) << "what is exported is the left half's";
        EXPECT_EQ(expected == alone, other == own) << "the looks differ";
    }
}

TEST_F(Render, AnotherLookKeepsAllSamples) {
    const Scene scene = bundled("cornell");
    render(scene, 1);
    FrameOptions options = small;
    for (const Method method : {Method::paper, Method::reference, Method::farfield}) {
        options.other = Look{View::result, method, 2};
        EXPECT_FALSE(renderer_->update(scene, options));
        EXPECT_EQ(renderer_->statistics().frames, 1);
    }
}

TEST_F(Render, AnotherAoRadiusKeepsTheFarLight) {
    Scene scene = bundled("cornell");
    render(scene, 2);
    const Image coarse = renderer_->read(View::coarse), occlusion = renderer_->read(View::occlusion);
    apply(scene, SetValue{{ObjectType::settings}, "ao_radius", {0.05f, 0.0f, 0.0f}});
    EXPECT_FALSE(renderer_->update(scene, small));
    EXPECT_EQ(renderer_->read(View::coarse).pixels, coarse.pixels);
    renderer_->render_frame();
    EXPECT_NE(renderer_->read(View::occlusion).pixels, occlusion.pixels);
    EXPECT_EQ(renderer_->statistics().frames, 3);
}

TEST_F(Render, ChangesOfSceneCameraAndTransportDiscard) {
    const Scene start = bundled("cornell");
    const ObjectRef child{ObjectType::node, start.root.children.at(0).id};
    const Edit edits[] = {SetValue{child, "translate", {0.0f, 0.1f, 0.0f}},
                          SetValue{{ObjectType::camera}, "field_of_view", {50.0f, 0.0f, 0.0f}},
                          SetValue{{ObjectType::sky}, "zenith", {1.0f, 1.0f, 1.0f}},
                          SetValue{{ObjectType::material, start.materials[0].id}, "albedo", {0.1f, 0.2f, 0.3f}},
                          SetValue{{ObjectType::settings}, "bounces", {2.0f, 0.0f, 0.0f}},
                          RemoveNode{child.id}};
    for (const Edit& edit : edits) {
        render(start, 1);
        Scene scene = start;
        apply(scene, edit);
        EXPECT_TRUE(renderer_->update(scene, small)) << describe(start, edit);
        EXPECT_EQ(renderer_->statistics().samples, 0) << describe(start, edit);
    }
}

TEST_F(Render, ACompileErrorNamesTheNodeAndKeepsTheLastGoodScene) {
    const Scene good = bundled("cornell");
    const Image before = render(good, 1);
    Scene broken = good;
    Node& node = broken.root.children.at(1);
    node.name = "culprit";
    node.transform.translate.x = std::nanf("");  // no file or edit can do this; it makes the generated text invalid
    try {
        renderer_->update(broken, small);
        FAIL() << "compiled";
    } catch (const ShaderError& error) {
        EXPECT_NE(std::string(error.what()).find("node \"culprit\""), std::string::npos) << error.what();
    }
    EXPECT_EQ(renderer_->read(View::result).pixels, before.pixels);
    renderer_->render_frame();
    EXPECT_EQ(renderer_->statistics().frames, 2);
}

TEST_F(Render, RecordsHaveTheLayoutOfTheShaders) {
    const gl::Program program = load_program("gbuffer.glsl");
    const std::pair<const char*, std::size_t> members[] = {{"camera_position", offsetof(FrameRecord, camera_position)},
                                                           {"sky_horizon", offsetof(FrameRecord, sky_horizon)},
                                                           {"sky_zenith", offsetof(FrameRecord, sky_zenith)},
                                                           {"image_size", offsetof(FrameRecord, image_size)},
                                                           {"seed", offsetof(FrameRecord, seed)},
                                                           {"light_count", offsetof(FrameRecord, light_count)}};
    for (const auto& [name, offset] : members) {
        GLuint index = GL_INVALID_INDEX;
        glGetUniformIndices(program.name(), 1, &name, &index);
        ASSERT_NE(index, GL_INVALID_INDEX) << name;
        GLint found = -1;
        glGetActiveUniformsiv(program.name(), 1, &index, GL_UNIFORM_OFFSET, &found);
        EXPECT_EQ(static_cast<std::size_t>(found), offset) << name;
    }
    const auto property = [&](const char* name, GLenum what) {
        const GLuint index = glGetProgramResourceIndex(program.name(), GL_BUFFER_VARIABLE, name);
        GLint found = -1;
        if (index != GL_INVALID_INDEX)
            glGetProgramResourceiv(program.name(), GL_BUFFER_VARIABLE, index, 1, &what, 1, nullptr, &found);
        return static_cast<std::size_t>(found);
    };
    EXPECT_EQ(property("surfaces[0].position", GL_TOP_LEVEL_ARRAY_STRIDE), surface_bytes);
    EXPECT_EQ(property("rays[0].origin", GL_TOP_LEVEL_ARRAY_STRIDE), ray_bytes);
    EXPECT_EQ(property("hits[0].distance", GL_TOP_LEVEL_ARRAY_STRIDE), hit_bytes);
}

/// Against a reference of many more samples, of the accumulated samples and as `farfield` filters them.
TEST_F(Render, NoiseIsEstimatedFromTheSamples) {
    Scene scene = bundled("cornell");
    scene.settings.method = Method::reference;
    scene.settings.samples = 4;
    const auto indirect = [&](int frames, std::uint32_t seed) {
        FrameOptions options = small;
        options.seed = seed;
        const Image image = render(scene, frames, options);
        return difference(image, renderer_->read(View::direct));
    };
    const Image truth = indirect(512, 1);
    const double error = measure(indirect(4, 2), truth).rmse_over_mean, noise = renderer_->noise().value();
    EXPECT_GT(noise, 0.9 * error);
    EXPECT_LT(noise, 2.0 * error);
    indirect(12, 2);  // and 12 more
    EXPECT_NEAR(renderer_->noise().value(), 0.5 * noise, 0.1 * noise);

    scene.settings.method = Method::farfield;
    for (const int frames : {4, 12}) {  // 16 samples, then 64
        const double filtered = measure(indirect(frames, 3), truth).rmse_over_mean;
        EXPECT_LT(filtered, 0.5 * error);
        EXPECT_GT(renderer_->noise().value(), 0.5 * filtered);
        EXPECT_LT(renderer_->noise().value(), 2.0 * filtered);
    }
    EXPECT_FALSE(renderer_->noise([] { return true; }).has_value());

    scene.settings.samples = 1;
    render(scene, 1);
    EXPECT_EQ(renderer_->noise(), std::numeric_limits<double>::infinity());
    scene.sky = {};
    scene.lights.clear();
    for (Material& material : scene.materials) material.emission = glm::vec3(0.0f);
    render(scene, 2);
    EXPECT_EQ(renderer_->noise(), 0.0);
}

/// A Lambert plane under a point light: radiance albedo / pi x I cos / d². A directional light: albedo / pi x E cos.
TEST_F(Render, DirectLightIsLambertsLaw) {
    Scene scene;
    apply(scene, InsertNode{scene.root.id, -1, make_node(NodeKind::plane)});
    scene.materials[0].albedo = glm::vec3(0.6f);
    const Id lamp = apply(scene, AddLight{Light{}});
    scene.lights[0].position = {3.0f, 4.0f, 0.0f};
    scene.lights[0].intensity = glm::vec3(50.0f);
    scene.camera.position = {0.0f, 2.0f, 0.001f};
    scene.camera.target = glm::vec3(0.0f);
    scene.camera.field_of_view = 1.0f;
    FrameOptions options;
    options.size = {9, 9};
    const std::size_t centre = (4 * 9 + 4) * 3;
    EXPECT_NEAR(render(scene, 1, options, View::direct).pixels[centre], 0.6 / 3.14159265 * 50.0 / 25.0 * 0.8, 2e-4);
    apply(scene, SetLightKind{lamp, LightKind::directional});
    scene.lights[0].direction = {0.0f, -3.0f, 4.0f};
    EXPECT_NEAR(render(scene, 1, options, View::direct).pixels[centre], 0.6 / 3.14159265 * 50.0 * 0.6, 2e-3);
}

}  // namespace
}  // namespace farfield
