// The last picture's indirect light, taken over by the next where nothing but the camera has changed (reprojection;
// after Nehab et al. 2007). It counts as so many samples less as the new picture has more, and then for nothing: what
// is seen in the end are the new picture's samples alone. See METHOD.md.
#pragma once

#include "renderer/passes.h"
#include "renderer/records.h"

namespace farfield {

class Reprojection {
public:
    /// Pictures that the past and the new one count as together at most.
    static constexpr int pictures = 8;

    explicit operator bool() const { return static_cast<bool>(light_); }
    /// Takes the pictures, of equal size: irradiance / pi, whose w of 1 stands for `unit` samples, and the guide that
    /// belongs to it. Leaves others of that size, or none.
    void keep(gl::Raster& light, gl::Raster& guide, float unit, const FrameRecord& camera);
    void drop() { light_ = {}, guide_ = {}; }

    /// targets.wavelet.estimates[0], of `samples`, and the past, which counts for `most` samples or fewer. The result's
    /// w are samples. Needs the frame of the new picture bound.
    gl::Raster& add(Targets& targets, float samples, float most) const;

private:
    gl::Raster light_, guide_;
    float unit_ = 0.0f;
    FrameRecord camera_{};  ///< that saw them
    gl::Program program_ = load_program("reproject.glsl");
};

}  // namespace farfield
