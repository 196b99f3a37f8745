// The reference against a path tracer on the CPU (path_tracer.h): the mean, and every pixel within the noise of both.
#include "renderer/renderer.h"
#include "sdf/scene_file.h"
#include "tests/gl_test.h"
#include "tests/path_tracer.h"

#include <cmath>
#include <optional>
#include <random>

namespace farfield {
namespace {

constexpr int size = 48;
constexpr int batches = 8;

/// One value of the picture from each of eight independent batches of samples.
struct Batches {
    double sum = 0.0, squares = 0.0;
    void add(double value) {
        sum += value;
        squares += value * value;
    }
    double mean() const { return sum / batches; }
    double variance_of_mean() const { return std::max(squares / batches - mean() * mean(), 0.0) / (batches - 1); }
};

class CpuPathTracer : public GlTest {
protected:
    void SetUp() override {
        GlTest::SetUp();
        renderer_.emplace();
    }
    void TearDown() override {
        renderer_.reset();
        GlTest::TearDown();
    }
    /// Batch after batch from one accumulation, because the points within the pixel go on with the frames, not the
    /// seed.
    std::vector<Batches> on_gpu(const Scene& scene) {
        std::vector<Batches> result(3 * size * size);
        std::vector<double> before(result.size());
        FrameOptions options;
        options.size = {size, size};
        options.samples = 1;
        renderer_->update(scene, options);
        for (int batch = 1; batch <= batches; ++batch) {
            for (int i = 0; i < 64; ++i) renderer_->render_frame();
            const Image image = renderer_->read(View::result);
            for (std::size_t i = 0; i < result.size(); ++i) {
                const double sum = static_cast<double>(image.pixels[i]) * batch;
                result[i].add(sum - before[i]);
                before[i] = sum;
            }
        }
        return result;
    }
    static std::vector<Batches> on_cpu(const Scene& scene) {
        const PathTracer tracer(scene);
        std::vector<Batches> result(3 * size * size);
        std::mt19937_64 random(1);
        constexpr int samples = 48;
        for (std::size_t pixel = 0; pixel < size * size; ++pixel)
            for (int batch = 0; batch < batches; ++batch) {
                glm::dvec3 sum(0.0);
                for (int i = 0; i < samples; ++i)
                    sum += tracer.sample(static_cast<int>(pixel % size), static_cast<int>(pixel / size), size, random);
                for (int c = 0; c < 3; ++c) result[3 * pixel + c].add(sum[c] / samples);
            }
        return result;
    }
    /// Deviations in units of their standard error, estimated from the batches: Welch's t. Of 8 + 8 batches its square
    /// is 14 / 12 on average, where both estimate the same.
    void expect_agreement(Scene scene) {
        scene.settings.method = Method::reference;
        scene.settings.bounces = 5;
        const std::vector<Batches> gpu = on_gpu(scene), cpu = on_cpu(scene);
        double gpu_sum = 0.0, cpu_sum = 0.0, squares = 0.0, far_off = 0.0;
        for (std::size_t i = 0; i < gpu.size(); ++i) {
            gpu_sum += gpu[i].mean();
            cpu_sum += cpu[i].mean();
            const double rounding = 1e-4;  // of sums in single precision, for pixels without noise
            const double variance = gpu[i].variance_of_mean() + cpu[i].variance_of_mean() + rounding * rounding;
            const double square = std::pow(gpu[i].mean() - cpu[i].mean(), 2) / variance;
            squares += square;
            far_off += square > 25.0 ? 1.0 : 0.0;
        }
        const auto n = static_cast<double>(gpu.size());
        EXPECT_NEAR(gpu_sum / cpu_sum, 1.0, 0.007);  // about three standard errors
        EXPECT_LT(squares / n, 1.5);
        EXPECT_LT(far_off / n, 0.003);
    }
    std::optional<Renderer> renderer_;
};

TEST_F(CpuPathTracer, AgreesOnTheCornellRoom) {
    expect_agreement(load_scene(std::string(FARFIELD_SCENES) + "/cornell.json"));
}

TEST_F(CpuPathTracer, AgreesUnderSkyAndSunWithHighlights) {
    Scene scene = load_scene(std::string(FARFIELD_TESTS) + "/cycles/sky.json");
    for (Material& material : scene.materials) material.specular = 0.3f;
    expect_agreement(scene);
}

}  // namespace
}  // namespace farfield
