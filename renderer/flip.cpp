#include "renderer/flip.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace farfield {
namespace {

using glm::dmat3;
using glm::dvec3;

constexpr double pi = 3.14159265358979;

// ---- colour spaces ----

/// Linear Rec. 709 to CIE XYZ (IEC 61966-2-1), exact for its primaries and white D65.
const dmat3 xyz_from_rgb =
    glm::transpose(dmat3(10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0,
                         2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0, 1425312.0 / 73733382.0,
                         8788810.0 / 73733382.0, 70074185.0 / 73733382.0));
const dmat3 rgb_from_xyz = glm::inverse(xyz_from_rgb);
const dvec3 white = xyz_from_rgb * dvec3(1.0);

/// The opponent axes that CIELAB and YCxCz have in common.
dvec3 opponents(dvec3 f) { return {116.0 * f.y - 16.0, 500.0 * (f.x - f.y), 200.0 * (f.y - f.z)}; }

dvec3 ycxcz_from_rgb(dvec3 rgb) { return opponents(xyz_from_rgb * rgb / white); }

dvec3 rgb_from_ycxcz(dvec3 c) {
    const double y = (c.x + 16.0) / 116.0;
    return rgb_from_xyz * (dvec3(y + c.y / 500.0, y, y - c.z / 200.0) * white);
}

/// CIELAB whose a and b grow with L: Hunt's effect, colours are paler where it is dark.
dvec3 hunt_lab_from_rgb(dvec3 rgb) {
    const dvec3 t = xyz_from_rgb * rgb / white;
    const auto f = [](double v) {
        constexpr double delta = 6.0 / 29.0;
        return v > delta * delta * delta ? std::cbrt(v) : v / (3.0 * delta * delta) + 4.0 / 29.0;
    };
    const dvec3 lab = opponents({f(t.x), f(t.y), f(t.z)});
    return {lab.x, 0.01 * lab.x * lab.y, 0.01 * lab.x * lab.z};
}

/// Abasi, Amani Tehran and Fairchild 2020.
double hyab(dvec3 a, dvec3 b) {
    const dvec3 d = a - b;
    return std::abs(d.x) + std::hypot(d.y, d.z);
}

// ---- separable filters ----

using Plane = std::vector<double>;
using Kernel = std::vector<double>;  ///< of odd size, centred

/// The plane filtered by `row` along x and by `column` along y.
Plane filtered(const Plane& plane, glm::ivec2 size, const Kernel& row, const Kernel& column) {
    const auto pass = [](const Plane& from, int length, int lines, int step, int line_step, const Kernel& kernel) {
        Plane to(from.size());
        const int radius = static_cast<int>(kernel.size()) / 2;
        for (int line = 0; line < lines; ++line)
            for (int i = 0; i < length; ++i) {
                double sum = 0.0;
                for (int k = -radius; k <= radius; ++k)
                    sum += kernel[static_cast<std::size_t>(k + radius)] *
                           from[static_cast<std::size_t>(line) * line_step +
                                static_cast<std::size_t>(std::clamp(i + k, 0, length - 1)) * step];
                to[static_cast<std::size_t>(line) * line_step + static_cast<std::size_t>(i) * step] = sum;
            }
        return to;
    };
    return pass(pass(plane, size.x, size.y, 1, size.x, row), size.y, size.x, size.x, 1, column);
}

template <class F>
Kernel kernel(int radius, F weight) {
    Kernel result;
    for (int x = -radius; x <= radius; ++x) result.push_back(weight(static_cast<double>(x)));
    return result;
}

double sum(const Kernel& k) { return std::accumulate(k.begin(), k.end(), 0.0); }

/// Times `factor`.
Kernel scaled(Kernel k, double factor) {
    for (double& v : k) v *= factor;
    return k;
}

/// Positive weights add up to 1 and negative ones to -1 in two dimensions, where the other direction adds up to 1.
Kernel balanced(Kernel k) {
    double positive = 0.0, negative = 0.0;
    for (const double v : k) (v > 0.0 ? positive : negative) += v;
    for (double& v : k) v /= v > 0.0 ? positive : -negative;
    return k;
}

// ---- the two pipelines, for one image ----

/// The contrast sensitivity of a channel is the sum of a √(π/b) exp(-π² x² / b), x in degrees.
struct Sensitivity {
    double a, b;
};
constexpr Sensitivity achromatic{1.0, 0.0047}, red_green{1.0, 0.0053}, blue_yellow[] = {{34.1, 0.04}, {13.5, 0.025}};

/// What the eye sees of an image: Hunt-adjusted CIELAB, and the achromatic channel, 0..1, for the features.
struct Seen {
    std::vector<dvec3> lab;
    Plane luminance;
};

Seen see(const Image& image, double pixels_per_degree) {
    const std::size_t pixels = image.pixels.size() / 3;
    Plane planes[3];
    for (Plane& plane : planes) plane.resize(pixels);
    Seen seen{std::vector<dvec3>(pixels), Plane(pixels)};
    for (std::size_t i = 0; i < pixels; ++i) {
        const float* rgb = &image.pixels[3 * i];
        const dvec3 c = ycxcz_from_rgb(glm::clamp(dvec3(rgb[0], rgb[1], rgb[2]), 0.0, 1.0));
        for (int channel = 0; channel < 3; ++channel) planes[channel][i] = c[channel];
        seen.luminance[i] = (c.x + 16.0) / 116.0;
    }
    const int radius = static_cast<int>(std::ceil(3.0 * std::sqrt(0.04 / (2.0 * pi * pi)) * pixels_per_degree));
    const auto gaussian = [&](double b) {
        return kernel(radius, [&](double x) {
            const double degrees = x / pixels_per_degree;
            return std::exp(-pi * pi * degrees * degrees / b);
        });
    };
    const auto blur = [&](const Plane& plane, Sensitivity s) {
        const Kernel g = gaussian(s.b), unit = scaled(g, 1.0 / sum(g));
        return filtered(plane, image.size, unit, unit);
    };
    const Plane y = blur(planes[0], achromatic), cx = blur(planes[1], red_green);
    const Plane cz1 = blur(planes[2], blue_yellow[0]), cz2 = blur(planes[2], blue_yellow[1]);
    // The weights of the two Gaussians of the sum before it is normalised.
    const auto weight = [&](Sensitivity s) { return s.a * std::sqrt(pi / s.b) * std::pow(sum(gaussian(s.b)), 2.0); };
    const double w1 = weight(blue_yellow[0]), w2 = weight(blue_yellow[1]);
    for (std::size_t i = 0; i < pixels; ++i) {
        const dvec3 rgb = rgb_from_ycxcz({y[i], cx[i], (w1 * cz1[i] + w2 * cz2[i]) / (w1 + w2)});
        seen.lab[i] = hunt_lab_from_rgb(glm::clamp(rgb, 0.0, 1.0));
    }
    return seen;
}

/// How strong an edge and a point are at each pixel.
struct Features {
    Plane edge, point;
};

Features features(const Plane& luminance, glm::ivec2 size, double pixels_per_degree) {
    const double deviation = 0.5 * 0.082 * pixels_per_degree;  // edges 0.082 degrees wide
    const int radius = static_cast<int>(std::ceil(3.0 * deviation));
    const auto g = [&](double x) { return std::exp(-x * x / (2.0 * deviation * deviation)); };
    Kernel smooth = kernel(radius, g);
    smooth = scaled(smooth, 1.0 / sum(smooth));
    const Kernel edge = balanced(kernel(radius, [&](double x) { return -x * g(x); }));
    const Kernel point =
        balanced(kernel(radius, [&](double x) { return (x * x / (deviation * deviation) - 1.0) * g(x); }));
    const auto strength = [&](const Kernel& k) {
        Plane x = filtered(luminance, size, k, smooth);
        const Plane y = filtered(luminance, size, smooth, k);
        std::transform(x.begin(), x.end(), y.begin(), x.begin(), [](double a, double b) { return std::hypot(a, b); });
        return x;
    };
    return {strength(edge), strength(point)};
}

/// Colour differences to 0..1: small ones, up to 0.4 of the largest, get the lower 95 %.
double compressed(double difference) {
    constexpr double exponent = 0.7, knee = 0.4, knee_value = 0.95;
    static const double largest =
        std::pow(hyab(hunt_lab_from_rgb({0.0, 1.0, 0.0}), hunt_lab_from_rgb({0.0, 0.0, 1.0})), exponent);
    const double d = std::pow(difference, exponent), bend = knee * largest;
    return d < bend ? d * knee_value / bend : knee_value + (d - bend) / (largest - bend) * (1.0 - knee_value);
}

}  // namespace

double flip(const Image& image, const Image& reference, double pixels_per_degree) {
    compare(image, reference);  // throws where the sizes differ
    if (count_invalid(image) + count_invalid(reference) > 0) throw ImageError("FLIP of values that are not finite");
    if (reference.pixels.empty()) throw ImageError("FLIP of images without pixels");
    const Seen a = see(image, pixels_per_degree), b = see(reference, pixels_per_degree);
    const Features fa = features(a.luminance, image.size, pixels_per_degree),
                   fb = features(b.luminance, image.size, pixels_per_degree);
    double total = 0.0;
    for (std::size_t i = 0; i < a.lab.size(); ++i) {
        const double colour = compressed(hyab(a.lab[i], b.lab[i]));
        const double strongest = std::max(std::abs(fa.edge[i] - fb.edge[i]), std::abs(fa.point[i] - fb.point[i]));
        const double feature = std::sqrt(std::min(strongest / std::sqrt(2.0), 1.0));
        total += std::pow(colour, 1.0 - feature);
    }
    return total / static_cast<double>(a.lab.size());
}

}  // namespace farfield
