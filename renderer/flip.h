// FLIP for images of low dynamic range: how different two pictures look to a person who flips between them.
//
// Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild, "FLIP: A Difference Evaluator for Alternating
// Images", Proceedings of the ACM on Computer Graphics and Interactive Techniques 3(2), 2020. Two pipelines:
//
//   colour    opponent space YCxCz -> contrast sensitivity of the eye as a low-pass filter -> clamped to the display's
//             gamut -> CIELAB with Hunt's effect -> HyAB distance -> compressed to 0..1
//   feature   edges and points of the achromatic channel by first and second derivatives of a Gaussian
//
//   FLIP = colour^(1 - feature)
//
// Filters are separable: each is a product of two one-dimensional filters or the sum of two such. Pixels beyond the
// border repeat those at it.
#pragma once

#include "renderer/image.h"

namespace farfield {

/// Pixels for each degree of visual angle that the paper assumes: a screen 0.7 m wide of 3840 pixels, 0.7 m away.
inline constexpr double flip_pixels_per_degree = 3840.0 / 0.7 * 0.7 * 3.14159265358979 / 180.0;

/// Mean over the pixels, 0 (alike) to 1. Both images are linear Rec. 709 as displayed; values are clamped to 0..1.
/// Throws ImageError when the sizes differ, a value is not finite, or they have no pixels.
double flip(const Image& image, const Image& reference, double pixels_per_degree = flip_pixels_per_degree);

}  // namespace farfield
