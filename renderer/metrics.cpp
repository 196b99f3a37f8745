#include "renderer/metrics.h"

#include <fmt/format.h>

#include <limits>

namespace farfield {
namespace {

void require_finite(const Image& image, const char* which) {
    if (const std::size_t invalid = count_invalid(image))
        throw ImageError(
            fmt::format("{} of the {} values of the {} are not finite", invalid, image.pixels.size(), which));
    if (image.pixels.empty()) throw ImageError(fmt::format("the {} has no pixels", which));
}

double over(double value, double mean) {
    if (value == 0.0) return 0.0;
    return mean != 0.0 ? value / mean : std::numeric_limits<double>::infinity();
}

}  // namespace

double mean(const Image& image) {
    double sum = 0.0;
    for (const float v : image.pixels) sum += v;
    return sum / static_cast<double>(image.pixels.size());
}

double relative_mse(const Image& image, const Image& reference) {
    const double m = mean(reference), floor = relative_mse_epsilon * m * m;
    double sum = 0.0;
    for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
        const double r = reference.pixels[i], difference = image.pixels[i] - r;
        sum += over(difference * difference, r * r + floor);
    }
    return sum / static_cast<double>(reference.pixels.size());
}

Metrics measure(const Image& image, const Image& reference) {
    const Difference difference = compare(image, reference);
    require_finite(image, "image");
    require_finite(reference, "reference");
    Metrics metrics;
    metrics.mean = mean(reference);
    metrics.rmse = difference.rmse;
    metrics.largest = difference.largest;
    metrics.rmse_over_mean = over(difference.rmse, metrics.mean);
    metrics.relative_mse = relative_mse(image, reference);
    metrics.bias = over(mean(image) - metrics.mean, metrics.mean);
    return metrics;
}

}  // namespace farfield
