// The reference against Blender's Cycles: a renderer with other geometry (meshes), other sampling and other people's
// mistakes. tests/cycles/make.py made the pictures; it says how units and bounces translate.
#include "renderer/renderer.h"
#include "sdf/scene_file.h"
#include "tests/gl_test.h"

#include <cmath>
#include <optional>

namespace farfield {
namespace {

constexpr int size = 128;

glm::vec3 at(const Image& image, int x, int y) {
    const std::size_t i = 3 * (static_cast<std::size_t>(y) * image.size.x + x);
    return {image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]};
}

class Cycles : public GlTest {
protected:
    void TearDown() override {
        renderer_.reset();
        GlTest::TearDown();
    }
    Image reference(Scene scene, std::uint32_t seed, int frames) {
        if (!renderer_) renderer_.emplace();
        scene.settings.method = Method::reference;
        scene.settings.bounces = 4;
        scene.settings.samples = 1;
        FrameOptions options;
        options.size = {size, size};
        options.seed = seed;
        renderer_->update(scene, options);
        for (int i = 0; i < frames; ++i) renderer_->render_frame();
        return renderer_->read(View::result);
    }
    /// Whether a pixel and those around it show one smooth surface, or the sky alone. On a plane the inverse of the
    /// depth is linear in the picture, however slanted it is.
    std::vector<bool> smooth() {
        const Image normals = renderer_->read(View::normals), depths = renderer_->read(View::depth);
        const auto inverse_depth = [&](int x, int y) { return 1.0f / std::max(at(depths, x, y).x, 1e-6f); };
        std::vector<bool> result(size * size, true);
        for (int y = 1; y < size - 1; ++y)
            for (int x = 1; x < size - 1; ++x)
                for (const glm::ivec2 step : {glm::ivec2(1, 0), {0, 1}}) {
                    const glm::ivec2 a = glm::ivec2(x, y) - step, b = glm::ivec2(x, y) + step;
                    const float bend = inverse_depth(a.x, a.y) + inverse_depth(b.x, b.y) - 2.0f * inverse_depth(x, y);
                    if (std::abs(bend) < 1e-3f * inverse_depth(x, y) &&
                        glm::distance(at(normals, a.x, a.y), at(normals, b.x, b.y)) < 0.2f)
                        continue;
                    for (int v = y - 1; v <= y + 1; ++v)
                        for (int u = x - 1; u <= x + 1; ++u) result[static_cast<std::size_t>(v * size + u)] = false;
                }
        return result;
    }
    /// Two pictures of different seeds against that of Cycles, outside silhouettes. Their noise is independent, so the
    /// mean product of their deviations is the mean square of what is left without it: Cycles' own noise and what is
    /// wrong.
    void expect_agreement(const Scene& scene, const std::string& name) {
        const Image cycles = read_image(std::string(FARFIELD_TESTS) + "/cycles/" + name + ".exr");
        ASSERT_EQ(cycles.size, glm::ivec2(size));
        const Image first = reference(scene, 1, 64), second = reference(scene, 2, 64);
        const std::vector<bool> counts = smooth();
        double sum = 0.0, cycles_sum = 0.0, squares = 0.0;
        int n = 0;
        for (std::size_t i = 0; i < cycles.pixels.size(); ++i) {
            if (!counts[i / 3]) continue;
            ++n;
            const double a = first.pixels[i], b = second.pixels[i], c = cycles.pixels[i];
            sum += 0.5 * (a + b);
            cycles_sum += c;
            squares += (a - c) * (b - c);
        }
        EXPECT_GT(n, 3 * size * size / 2);
        EXPECT_NEAR(sum / cycles_sum, 1.0, 0.005);
        EXPECT_LT(std::sqrt(std::max(squares / n, 0.0)) / (cycles_sum / n), 0.02);
    }
    std::optional<Renderer> renderer_;
};

TEST_F(Cycles, AgreesOnTheCornellRoom) {
    expect_agreement(load_scene(std::string(FARFIELD_SCENES) + "/cornell.json"), "cornell");
}

TEST_F(Cycles, AgreesUnderSkyAndSun) {
    expect_agreement(load_scene(std::string(FARFIELD_TESTS) + "/cycles/sky.json"), "sky");
}

}  // namespace
}  // namespace farfield
