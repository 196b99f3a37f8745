#include "renderer/reprojection.h"

#include <utility>

namespace farfield {

void Reprojection::keep(gl::Raster& light, gl::Raster& guide, float unit, const FrameRecord& camera) {
    const auto take = [](gl::Raster& ours, gl::Raster& theirs) {
        std::swap(ours, theirs);
        if (theirs.size() != ours.size()) theirs = {};
    };
    take(light_, light);
    take(guide_, guide);
    unit_ = unit;
    camera_ = camera;
}

gl::Raster& Reprojection::add(Targets& targets, float samples, float most) const {
    const auto pixels = [](glm::ivec2 size) { return static_cast<float>(size.x) * static_cast<float>(size.y); };
    gl::Raster& result = targets.wavelet.scratch.far;  // which the wavelet needs no more
    targets.wavelet.estimates[0].bind(0);
    targets.wavelet.grids[0].guide.bind(1);
    light_.bind(2);
    guide_.bind(3);
    program_.set("past_position", camera_.camera_position);
    program_.set("past_right", camera_.camera_right);
    program_.set("past_up", camera_.camera_up);
    program_.set("past_forward", camera_.camera_forward);
    program_.set("past_size", light_.size());
    program_.set("past_unit", unit_ * pixels(light_.size()) / pixels(targets.size));
    program_.set("samples", samples);
    program_.set("most", most);
    result.bind_target(0);
    program_.run(targets.size);
    return result;
}

}  // namespace farfield
