// The filter of Method::farfield, a consistent near/far estimate: edge-avoiding à-trous wavelet and James-Stein
// shrinkage from coarse to fine; see METHOD.md.
#pragma once

#include "renderer/gl.h"

#include <functional>
#include <vector>

namespace farfield {

/// Far and near light as one level of the wavelet has them, and the share of a pixel's variance that is left, in whose
/// place comes the squared error that is to be expected of the estimate down to that level.
struct WaveletLevel {
    gl::Raster far, near, gain;
};

/// Pixels that stand apart by `spacing`: their surfaces, and how they hang together.
struct WaveletGrid {
    glm::ivec2 size;
    int spacing;
    gl::Raster guide, right, below;
};

/// What the filter makes of one picture.
struct WaveletRasters {
    explicit WaveletRasters(glm::ivec2 picture) : size(picture) {}
    std::size_t bytes() const;
    const WaveletGrid& grid_of(std::size_t level) const { return grids[level > 0 ? level - 1 : 0]; }

    glm::ivec2 size;
    std::vector<WaveletLevel> levels;  ///< the first is unfiltered; the second has all pixels, too
    std::vector<WaveletGrid> grids;    ///< of all pixels, of every second row and column, of every fourth, ...
    gl::Raster estimates[2];
    gl::Raster evenness;  ///< of every fourth row and column
    /// Half a level, filtered in one direction; later the details of two levels.
    WaveletLevel scratch;
};

/// The consistent near/far estimate: à-trous wavelet and James-Stein shrinkage from coarse to fine; see METHOD.md.
class WaveletPass {
public:
    /// One level of the wavelet more than `blur_levels` (0 stays 0): so wide is the paper's filter, see METHOD.md.
    /// Leaves irradiance / pi in rasters.estimates[0]. Asks `stop`, if there is one, between levels; false when it said
    /// so and nothing is there to be shown.
    bool run(WaveletRasters& rasters, int blur_levels, const std::function<bool()>& stop) const;
    /// The coarsest far light of the last run, with its openness in w, for every pixel. The estimate stays.
    const gl::Raster& far_light(WaveletRasters& rasters, int blur_levels) const;
    /// The squared error that is to be expected of the last run's estimate, for every pixel. Of at least one blur
    /// level.
    const gl::Raster& risk(const WaveletRasters& rasters) const;

private:
    void make_rasters(WaveletRasters& rasters, std::size_t levels) const;
    void make_grids(WaveletRasters& rasters, std::size_t levels) const;
    /// A level at the places of the next one's grid.
    void restrict_level(WaveletRasters& rasters, std::size_t level, const WaveletLevel& target) const;
    /// Half a level: along rows or columns, on the grid of level + 1.
    void smooth(WaveletRasters& rasters, std::size_t level, bool along_columns, const WaveletLevel& source,
                const WaveletLevel& target) const;
    /// From the grid of level + 1 to that of `level`, and what the level has beyond that.
    void refine(WaveletRasters& rasters, std::size_t level, const gl::Raster& coarse, const gl::Raster& fine,
                const gl::Raster& detail, bool of_far_light) const;
    /// What the noise is of what the samples' variance lets expect; see METHOD.md.
    float evenness(WaveletRasters& rasters) const;
    void shrink(WaveletRasters& rasters, std::size_t level, bool from_coarsest, float evenness) const;
    void bind_narrow(const gl::Program& program, const WaveletRasters& rasters, std::size_t level, GLuint unit) const;
    gl::Program start_ = load_program("wavelet_start.glsl"), links_ = load_program("wavelet_links.glsl"),
                halve_ = load_program("wavelet_halve.glsl"), restrict_ = load_program("wavelet_restrict.glsl"),
                smooth_ = load_program("wavelet_smooth.glsl"), coarsest_ = load_program("wavelet_coarsest.glsl"),
                refine_ = load_program("wavelet_refine.glsl"), evenness_ = load_program("wavelet_evenness.glsl"),
                shrink_ = load_program("wavelet_shrink.glsl", "#define leaves_detail 0\n"),
                shrink_to_finest_ = load_program("wavelet_shrink.glsl", "#define leaves_detail 1\n");
};

}  // namespace farfield
