// Errors of an image against a reference: values computed by hand, and FLIP against its authors' code.
#include "renderer/flip.h"
#include "renderer/metrics.h"
#include "tests/test_support.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>

namespace farfield {
namespace {

Image filled(glm::ivec2 size, glm::vec3 color) {
    Image image{size, {}};
    for (int i = 0; i < size.x * size.y; ++i) image.pixels.insert(image.pixels.end(), {color.x, color.y, color.z});
    return image;
}

Image grey(glm::ivec2 size, float value) { return filled(size, glm::vec3(value)); }

TEST(Metrics, AnImageHasNoErrorAgainstItself) {
    const Image image = filled({5, 3}, {0.1f, 2.0f, 30.0f});
    const Metrics metrics = measure(image, image);
    EXPECT_EQ(metrics.rmse, 0.0);
    EXPECT_EQ(metrics.rmse_over_mean, 0.0);
    EXPECT_EQ(metrics.relative_mse, 0.0);
    EXPECT_EQ(metrics.bias, 0.0);
    EXPECT_NEAR(metrics.mean, 10.7, 1e-5);
}

/// Values 1 and 3 (mean 2) seen as 2 and 2.5: differences 1 and -0.5.
TEST(Metrics, AgreeWithAHandComputedPair) {
    Image reference = grey({2, 1}, 1.0f), image = grey({2, 1}, 2.0f);
    for (std::size_t i = 3; i < 6; ++i) reference.pixels[i] = 3.0f, image.pixels[i] = 2.5f;
    const Metrics metrics = measure(image, reference);
    EXPECT_DOUBLE_EQ(metrics.mean, 2.0);
    EXPECT_NEAR(metrics.rmse, std::sqrt((1.0 + 0.25) / 2.0), 1e-7);
    EXPECT_NEAR(metrics.rmse_over_mean, std::sqrt(0.625) / 2.0, 1e-7);
    EXPECT_NEAR(metrics.largest, 1.0, 1e-7);
    EXPECT_NEAR(metrics.relative_mse, 0.5 * (1.0 / (1.0 + 0.04) + 0.25 / (9.0 + 0.04)), 1e-9);
    EXPECT_NEAR(metrics.bias, 0.125, 1e-9);
    EXPECT_NEAR(measure(reference, image).bias, -0.25 / 2.25, 1e-9);
}

TEST(Metrics, ExposureChangesNoRelativeError) {
    Image reference = filled({4, 4}, {0.2f, 0.5f, 1.0f}), image = filled({4, 4}, {0.25f, 0.4f, 1.5f});
    const Metrics before = measure(image, reference);
    for (Image* i : {&reference, &image})
        for (float& v : i->pixels) v *= 1024.0f;
    const Metrics after = measure(image, reference);
    EXPECT_NEAR(after.rmse_over_mean, before.rmse_over_mean, 1e-7);
    EXPECT_NEAR(after.relative_mse, before.relative_mse, 1e-7);
    EXPECT_NEAR(after.bias, before.bias, 1e-7);
    EXPECT_NEAR(after.rmse, 1024.0 * before.rmse, 1e-3);
}

TEST(Metrics, ABlackReferenceMakesErrorsInfiniteButNotNaN) {
    const Image black = grey({2, 2}, 0.0f);
    EXPECT_EQ(measure(black, black).rmse_over_mean, 0.0);
    EXPECT_EQ(measure(black, black).relative_mse, 0.0);
    const Metrics metrics = measure(grey({2, 2}, 1.0f), black);
    EXPECT_TRUE(std::isinf(metrics.rmse_over_mean) && std::isinf(metrics.relative_mse) && std::isinf(metrics.bias));
}

TEST(Metrics, RefuseWhatCannotBeCompared) {
    Image broken = grey({2, 2}, 1.0f);
    broken.pixels[4] = std::numeric_limits<float>::quiet_NaN();
    const Image whole = grey({2, 2}, 1.0f);
    for (const auto& [a, b] :
         {std::pair(broken, whole), {whole, broken}, {whole, grey({2, 1}, 1.0f)}, {Image{}, Image{}}}) {
        EXPECT_THROW(measure(a, b), ImageError);
        EXPECT_THROW(flip(a, b), ImageError);
    }
}

TEST(Flip, IsZeroForEqualImagesAndSymmetric) {
    const Image a = filled({9, 7}, {0.3f, 0.6f, 0.1f}), b = grey({9, 7}, 0.4f);
    EXPECT_EQ(flip(a, a), 0.0);
    EXPECT_DOUBLE_EQ(flip(a, b), flip(b, a));
    EXPECT_EQ(flip(grey({3, 3}, 7.0f), grey({3, 3}, 1.0f)), 0.0) << "both are white on a screen";
}

/// Uniform images have no features, so FLIP is the compressed colour difference. Green against blue is the largest
/// there is: 1. White against black has a HyAB distance of 100, green against blue one of 203.3 (CIELAB of D65, times
/// L/100): 0.95 + 0.05 (100^0.7 - 0.4 m) / (0.6 m) with m = 203.3^0.7.
TEST(Flip, OfUniformImagesFollowsFromTheColours) {
    EXPECT_NEAR(flip(filled({8, 8}, {0.0f, 1.0f, 0.0f}), filled({8, 8}, {0.0f, 0.0f, 1.0f})), 1.0, 1e-9);
    const double m = std::pow(203.3, 0.7);
    EXPECT_NEAR(flip(grey({8, 8}, 1.0f), grey({8, 8}, 0.0f)),
                0.95 + 0.05 * (std::pow(100.0, 0.7) - 0.4 * m) / (0.6 * m), 1e-4);
    // Greys of L = 50 and 60: 10^0.7 on the steep part.
    const auto of_lightness = [](double l) { return static_cast<float>(std::pow((l + 16.0) / 116.0, 3.0)); };
    EXPECT_NEAR(flip(grey({8, 8}, of_lightness(50.0)), grey({8, 8}, of_lightness(60.0))),
                std::pow(10.0, 0.7) * 0.95 / (0.4 * m), 1e-4);
}

/// A pair made of formulas, with colours, edges and points. The expected values come from the authors' published numpy
/// code (python/flip_api.py of 2021, with two-dimensional filters) in double precision; their own test images are not
/// at hand.
TEST(Flip, AgreesWithTheAuthorsCode) {
    const auto linear = [](double v) {
        return static_cast<float>(v > 0.04045 ? std::pow((v + 0.055) / 1.055, 2.4) : v / 12.92);
    };
    Image reference{{48, 32}, {}}, test{{48, 32}, {}};
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 48; ++x) {
            const double r = 0.5 + 0.4 * std::sin(0.31 * x + 0.2 * y),
                         g = 0.5 + 0.4 * std::sin(0.13 * x - 0.37 * y + 1.0),
                         b = 0.5 + 0.4 * std::cos(0.05 * x * y / 8.0);
            const bool point = y >= 10 && y < 14 && x >= 20 && x < 23, even = (x / 4 + y / 4) % 2 == 0;
            const double blue = point ? 1.0 : b;
            reference.pixels.insert(reference.pixels.end(), {linear(r), linear(g), linear(b)});
            test.pixels.insert(test.pixels.end(), {linear(0.9 * (point ? 1.0 : r)), linear(point ? 1.0 : g),
                                                   linear(even ? blue : 1.0 - blue)});
        }
    EXPECT_NEAR(flip(test, reference), 0.516985961, 1e-6);
    EXPECT_NEAR(flip(test, reference, 30.0), 0.537790074, 1e-6);
    Image impulse = grey({33, 33}, 0.0f);
    for (std::size_t i = 0; i < 3; ++i) impulse.pixels[3 * (16 * 33 + 16) + i] = 1.0f;
    EXPECT_NEAR(flip(impulse, grey({33, 33}, 0.0f)), 0.013141943, 1e-6);
}

TEST(Images, LayersAttributesAndDisplayValuesAreRead) {
    const TemporaryFolder folder;
    write_exr(folder / "a.exr", {{"", grey({3, 2}, 0.25f)}, {"half.a", filled({3, 2}, {1.0f, 2.0f, 3.0f})}},
              {{"farfield:key", "k"}});
    EXPECT_EQ(read_linear(folder / "a.exr").pixels, grey({3, 2}, 0.25f).pixels);
    EXPECT_EQ(read_linear(folder / "a.exr", "half.a").pixels, filled({3, 2}, {1.0f, 2.0f, 3.0f}).pixels);
    EXPECT_EQ(read_attribute(folder / "a.exr", "farfield:key"), "k");
    EXPECT_EQ(read_attribute(folder / "a.exr", "farfield:other"), "");
    try {
        read_linear(folder / "a.exr", "other");
        FAIL();
    } catch (const ImageError& error) {
        EXPECT_NE(std::string(error.what()).find("layers half.a"), std::string::npos) << error.what();
    }
    write_display(folder / "a.png", {2, 1}, {0, 188, 255, 0, 188, 255});
    const Image png = read_linear(folder / "a.png");
    EXPECT_EQ(png.pixels[0], 0.0f);
    EXPECT_NEAR(png.pixels[1], 0.5029, 1e-4);
    EXPECT_EQ(png.pixels[2], 1.0f);
    EXPECT_THROW(read_linear(folder / "missing.exr"), ImageError);
}

/// As the thumbnails of a scene that is saved twice at once; they had one temporary file.
TEST(Images, ThreadsMayWriteOneFile) {
    const TemporaryFolder folder;
    const glm::ivec2 size{200, 120};
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&, t] {
            std::vector<unsigned char> rgb;
            for (int i = 0; i < 3 * size.x * size.y; ++i) rgb.push_back(static_cast<unsigned char>(i * i * (t + 1)));
            for (int i = 0; i < 25; ++i) EXPECT_NO_THROW(write_display(folder / "a.png", size, rgb));
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(read_image(folder / "a.png").size, size);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / ""), {}), 1);
}

TEST(Images, ResizingKeepsAUniformImageAndItsMean) {
    const Image small = filled({4, 2}, {0.5f, 1.0f, 2.0f}), large = resized(small, {16, 8});
    EXPECT_EQ(large.size, glm::ivec2(16, 8));
    for (std::size_t i = 0; i < large.pixels.size(); ++i) EXPECT_NEAR(large.pixels[i], small.pixels[i % 3], 1e-6);
    EXPECT_EQ(resized(small, small.size).pixels, small.pixels);
}

}  // namespace
}  // namespace farfield
