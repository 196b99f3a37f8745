#include "app/compare.h"

#include "renderer/flip.h"
#include "renderer/metrics.h"

#include <fmt/format.h>

#include <cmath>

namespace farfield {
namespace {

Image read(const std::filesystem::path& file, const std::string& layer) {
    // A layer counts for files that can have some; a PNG stands for any.
    Image image = read_linear(file, file.extension() == ".exr" ? layer : "");
    if (const std::size_t invalid = count_invalid(image))
        throw ImageError(
            fmt::format("{}: {} of {} values are not finite", file.string(), invalid, image.pixels.size()));
    return image;
}

}  // namespace

int run_compare(const CompareOptions& options) {
    try {
        const Image image = read(options.image, options.layer), reference = read(options.reference, options.layer);
        if (image.size != reference.size)
            throw ImageError(fmt::format("{}: has {} x {} pixels, expected {} x {} as {}", options.image.string(),
                                         image.size.x, image.size.y, reference.size.x, reference.size.y,
                                         options.reference.string()));
        const Metrics m = measure(image, reference);
        fmt::print(
            "reference mean   {:.6g}\nRMSE             {:.6g}\nRMSE / mean      {:.6g}\nrelMSE           {:.6g}\n"
            "mean bias        {:+.4f} %\nlargest          {:.6g}\nFLIP             {:.6f}\n",
            m.mean, m.rmse, m.rmse_over_mean, m.relative_mse, 100.0 * m.bias, m.largest,
            flip(exposed(image, options.exposure), exposed(reference, options.exposure)));
    } catch (const ImageError& error) {
        throw std::invalid_argument(error.what());
    }
    return 0;
}

}  // namespace farfield
