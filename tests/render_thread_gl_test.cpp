// What the render thread does when a scene or the driver fails: the last good picture stays, it says why, and goes on
// with the next change.
#include "renderer/render_thread.h"
#include "sdf/scene_file.h"
#include "tests/gl_test.h"
#include "tests/test_support.h"

#include <atomic>
#include <chrono>
#include <functional>
#include <string_view>
#include <thread>

namespace farfield {
namespace {

/// What the driver answers for the thread's textures of pictures while it has no memory left.
std::atomic<bool> no_memory{false};
thread_local bool failing = false;
PFNGLOBJECTLABELPROC label_of_driver = nullptr;
PFNGLGETERRORPROC error_of_driver = nullptr;

void label(GLenum kind, GLuint name, GLsizei length, const GLchar* text) {
    failing = no_memory && text == std::string_view("picture");
    label_of_driver(kind, name, length, text);
}
GLenum error() {
    const GLenum found = error_of_driver();
    return std::exchange(failing, false) ? GL_OUT_OF_MEMORY : found;
}

class RenderThreadTest : public GlTest {
protected:
    void SetUp() override {
        GlTest::SetUp();
        thread_.emplace(make_headless_context(ContextKind::automatic));
    }
    void TearDown() override {
        thread_.reset();
        GlTest::TearDown();
    }

    void submit(const Scene& scene, glm::ivec2 size = {32, 32}) {
        thread_->submit({.scene = std::make_shared<const Scene>(scene), .size = size, .max_frames = 2});
    }
    /// The first picture that satisfies the condition.
    RenderedPicture wait(const std::function<bool(const RenderedPicture&)>& condition) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        RenderedPicture picture;
        while (!condition(picture = thread_->acquire()) && std::chrono::steady_clock::now() < end)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        EXPECT_TRUE(condition(picture)) << picture.serial << " " << picture.error;
        return picture;
    }

    std::optional<RenderThread> thread_;
    const Scene scene_ = load_scene(std::filesystem::path(FARFIELD_SCENES) / "csg_part.json");
};

bool good(const RenderedPicture& picture) { return picture.texture != 0 && picture.error.empty(); }
bool failed(const RenderedPicture& picture) { return !picture.error.empty(); }

TEST_F(RenderThreadTest, ARefusedSceneLeavesTheLastPictureAndTheNextSceneShows) {
    submit(scene_);
    const RenderedPicture first = wait(good);
    Scene large = scene_;
    for (int i = 0; i < 30'000; ++i) {
        Node node = make_node(NodeKind::sphere);
        node.id = large.new_id();
        large.root.children.push_back(node);
    }
    submit(large);
    const RenderedPicture refused = wait(failed);
    EXPECT_NE(refused.error.find("nodes"), std::string::npos) << refused.error;
    EXPECT_NE(refused.texture, 0u);
    EXPECT_GE(refused.serial, first.serial);
    Scene next = scene_;
    next.camera.position.x += 0.5f;
    submit(next);
    wait([&](const RenderedPicture& p) { return good(p) && p.serial > refused.serial; });
}

/// Samples of a view are kept when less noise is asked for.
TEST_F(RenderThreadTest, ThePictureRestsAtItsNoiseAndGoesOnForLess) {
    Scene scene = scene_;
    scene.settings.samples = 8;
    const auto rest_at = [&](float percent) {
        scene.settings.noise = percent;
        thread_->submit({.scene = std::make_shared<const Scene>(scene), .size = {32, 32}});
        const auto reached = [&](const RenderedPicture& p) {
            return p.statistics.noise && 100.0 * *p.statistics.noise <= percent;
        };
        wait(reached);
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        const int samples = thread_->acquire().statistics.samples;
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        EXPECT_EQ(thread_->acquire().statistics.samples, samples) << "goes on at " << percent << " %";
        return samples;
    };
    const int coarse = rest_at(20.0f), fine = rest_at(4.0f);
    EXPECT_GE(coarse, 16);
    EXPECT_GT(fine, 2 * coarse);
    EXPECT_LE(rest_at(20.0f), fine + scene.settings.samples) << "one frame to see that there is enough";
}

TEST_F(RenderThreadTest, ALargeSceneTellsHowFarItIsAndMakesWayForANewerOne) {
    Scene large;
    std::mt19937 random(1);
    while (count_nodes(large) < 400) apply(large, InsertNode{large.root.id, -1, random_tree(2, random)});
    submit(large);
    const RenderedPicture waiting = wait([](const RenderedPicture& p) { return p.compiled > 0; });
    EXPECT_GT(waiting.to_compile, 8);
    EXPECT_LT(waiting.compiled, waiting.to_compile);
    EXPECT_EQ(waiting.texture, 0u);
    submit(scene_);
    const RenderedPicture first = wait(good);
    EXPECT_EQ(first.to_compile, 0);
    EXPECT_LT(first.statistics.structural_compiles, waiting.to_compile);
}

TEST_F(RenderThreadTest, AFailureOfTheDriverLeavesTheLastPictureAndTheNextChangeTriesAgain) {
    submit(scene_);
    RenderedPicture last = wait([](const RenderedPicture& p) { return good(p) && p.size == glm::ivec2(32, 32); });
    // The thread's context has loaded the functions by now.
    label_of_driver = std::exchange(glad_glObjectLabel, label);
    error_of_driver = std::exchange(glad_glGetError, error);
    no_memory = true;
    std::string said;
    for (const int width : {40, 48}) {  // another size takes other textures, and the error names it
        submit(scene_, {width, 32});
        const RenderedPicture kept = wait([&](const RenderedPicture& p) { return failed(p) && p.error != said; });
        EXPECT_NE(kept.error.find("cannot make texture"), std::string::npos) << kept.error;
        // Until the first failure the picture may have been drawn once more.
        EXPECT_TRUE(kept.serial == last.serial || said.empty());
        EXPECT_TRUE(kept.serial != last.serial || kept.texture == last.texture);
        EXPECT_NE(kept.texture, 0u);
        EXPECT_EQ(kept.size, last.size);
        last = kept;
        said = kept.error;
    }
    no_memory = false;
    submit(scene_, {56, 32});
    wait([](const RenderedPicture& p) { return good(p) && p.size == glm::ivec2(56, 32); });
    thread_.reset();
    glad_glObjectLabel = label_of_driver;
    glad_glGetError = error_of_driver;
}

}  // namespace
}  // namespace farfield
