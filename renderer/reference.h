// The reference: the scene's light transport accumulated without filter (Method::reference), in two independent halves,
// so that its own noise is known. It grows: later samples come on top of what there is, from where the half's sequence
// of samples is, for rays and places in the pixel alike. See METHOD.md.
#pragma once

#include "renderer/image.h"
#include "renderer/renderer.h"
#include "sdf/scene.h"

#include <array>
#include <functional>
#include <string>

namespace farfield {

struct ReferenceHalf {
    int samples = 0;  ///< per pixel
    Image indirect;   ///< linear radiance that indirect light adds: albedo x irradiance / pi
    Image result;     ///< the same plus direct light
};

struct Reference {
    std::array<ReferenceHalf, 2> halves;

    int samples() const { return halves[0].samples + halves[1].samples; }
    Image indirect() const;  ///< mean of both, by samples
    Image result() const;

    /// Expected mean square of the noise in `indirect()`, estimated without bias from the halves' difference: with n
    /// and m samples that has a variance of v/n + v/m, their mean v/(n+m).
    double noise_mse() const;
    /// What that noise alone adds to `relative_mse` of an image against `indirect()`.
    double noise_relative_mse() const;
};

/// SHA-256 of all that a reference depends on, 64 hexadecimal digits: its `transport` (of seed 0), size, and the code
/// of the shaders that take part.
std::string reference_key(const Scene& scene, glm::ivec2 size);

/// SHA-256 of the shaders' code but for comments: of all, or of those that a reference depends on.
std::string shader_hash(bool all);

std::string sha256(std::string_view bytes);  ///< 64 hexadecimal digits

/// Adds portions until there are at least so many samples, half of them in each half; needs a current context. Calls
/// `frame_done` after each frame and `portion_done` when the reference has grown. False when `frame_done` returned
/// false: then what the last portion has is dropped.
bool extend(Reference& reference, Renderer& renderer, Scene scene, glm::ivec2 size, int samples,
            const std::function<bool()>& frame_done, const std::function<void()>& portion_done);

/// Frames that `extend` would render.
int frames_to_extend(const Reference& reference, int samples);

}  // namespace farfield
