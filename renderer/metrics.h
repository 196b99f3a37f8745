// How far an image is from a reference. Differences of all pixels and channels count alike; both images are linear.
#pragma once

#include "renderer/image.h"

namespace farfield {

struct Metrics {
    double mean = 0.0;            ///< of the reference
    double rmse = 0.0;            ///< root of the mean squared difference, as OpenImageIO compares
    double largest = 0.0;         ///< difference of a value
    double rmse_over_mean = 0.0;  ///< what is meant by "error" here; changes of exposure do not change it
    double relative_mse = 0.0;    ///< see relative_mse()
    double bias = 0.0;            ///< (mean of the image - mean of the reference) / mean of the reference; signed
};

/// Errors over the mean are infinite where the reference is black and the image is not. Throws ImageError when the
/// sizes differ, a value of either is not finite, or they have no pixels.
Metrics measure(const Image& image, const Image& reference);

/// Mean of (x - r)² / (r² + ε m²), with m the mean of the reference: relMSE of Rousselle, Knaus and Zwicker ("Adaptive
/// Sampling and Reconstruction using Greedy Error Minimization", 2011) with their ε = 0.01, which they add to pixels of
/// about 1. Times m² it does the same for every exposure. Every channel counts by itself.
double relative_mse(const Image& image, const Image& reference);
inline constexpr double relative_mse_epsilon = 0.01;

double mean(const Image& image);  ///< of all pixels and channels

}  // namespace farfield
