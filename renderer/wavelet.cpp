#include "renderer/wavelet.h"

#include <algorithm>

namespace farfield {
namespace {

/// Of the wavelet: its openness is the one in front of the mean far light. Narrower ones bring noise, wider ones blur
/// contact.
constexpr std::size_t narrow_level = 2;

glm::ivec2 evenness_size(glm::ivec2 picture) { return (picture + 3) / 4; }

std::size_t levels_of(int blur_levels) { return blur_levels > 0 ? static_cast<std::size_t>(blur_levels) + 1 : 0; }

}  // namespace

std::size_t WaveletRasters::bytes() const {
    std::size_t sum = 0;
    const auto add = [&](const WaveletLevel& level) {
        sum += level.far.bytes() + level.near.bytes() + level.gain.bytes();
    };
    for (const WaveletLevel& level : levels) add(level);
    add(scratch);
    for (const WaveletGrid& grid : grids) sum += grid.guide.bytes() + grid.right.bytes() + grid.below.bytes();
    for (const gl::Raster& estimate : estimates) sum += estimate.bytes();
    return sum + evenness.bytes();
}

bool WaveletPass::run(WaveletRasters& rasters, int blur_levels, const std::function<bool()>& stop) const {
    const std::size_t levels = levels_of(blur_levels);
    make_rasters(rasters, levels);
    rasters.levels[0].far.bind_target(0);
    rasters.levels[0].near.bind_target(1);
    rasters.grids[0].guide.bind_target(2);
    start_.run(rasters.size);
    make_grids(rasters, levels);
    for (std::size_t i = 0; i < levels; ++i) {
        // Rows first or columns first in turn, so that edges treat both alike.
        if (stop && stop()) return false;
        const WaveletLevel &level = rasters.levels[i], &next = rasters.levels[i + 1];
        if (i > 0) restrict_level(rasters, i, next);
        smooth(rasters, i, i % 2 == 1, i > 0 ? next : level, rasters.scratch);
        if (stop && stop()) return false;
        smooth(rasters, i, i % 2 == 0, rasters.scratch, next);
    }
    const WaveletLevel& coarsest = rasters.levels[levels];
    coarsest.far.bind(0);
    coarsest.near.bind(1);
    bind_narrow(coarsest_, rasters, levels, 2);
    rasters.estimates[0].bind_target(0);
    coarsest.gain.bind(3);
    rasters.scratch.gain.bind_target(1);
    coarsest_.set("grid_size", rasters.grid_of(levels).size);
    coarsest_.set("level", static_cast<int>(levels));
    coarsest_.run(rasters.grid_of(levels).size);
    const float even = levels > 0 ? evenness(rasters) : 1.0f;
    for (std::size_t i = levels; i-- > 0;) {
        if (stop && stop()) return false;
        if (i > 0) refine(rasters, i, rasters.estimates[0], rasters.estimates[1], rasters.scratch.far, false);
        shrink(rasters, i, i + 1 == levels, even);
    }
    return true;
}

void WaveletPass::make_rasters(WaveletRasters& rasters, std::size_t levels) const {
    const auto make = [](gl::Raster& raster, const char* label, glm::ivec2 size, int channels = 4) {
        if (!raster) raster = gl::Raster(label, size, channels);
    };
    const auto make_level = [&](WaveletLevel& level, glm::ivec2 size) {
        make(level.far, "far level", size);
        make(level.near, "near level", size);
        make(level.gain, "noise gain", size, 1);
    };
    while (rasters.grids.size() < std::max<std::size_t>(levels, 1)) {
        WaveletGrid grid{rasters.size, 1, {}, {}, {}};
        if (!rasters.grids.empty())
            grid.size = (rasters.grids.back().size + 1) / 2, grid.spacing = 2 * rasters.grids.back().spacing;
        rasters.grids.push_back(std::move(grid));
    }
    for (WaveletGrid& grid : rasters.grids) {
        make(grid.guide, "guide", grid.size);
        make(grid.right, "links to the right", grid.size, 1);
        make(grid.below, "links below", grid.size, 1);
    }
    rasters.levels.resize(std::max(rasters.levels.size(), levels + 1));
    for (std::size_t i = 0; i <= levels; ++i) make_level(rasters.levels[i], rasters.grid_of(i).size);
    make_level(rasters.scratch, rasters.size);
    for (gl::Raster& raster : rasters.estimates) make(raster, "estimate", rasters.size);
    make(rasters.evenness, "evenness of samples", evenness_size(rasters.size), 1);
}

void WaveletPass::make_grids(WaveletRasters& rasters, std::size_t levels) const {
    if (levels == 0) return;
    rasters.grids[0].guide.bind(0);
    rasters.grids[0].right.bind_target(0);
    rasters.grids[0].below.bind_target(1);
    links_.run(rasters.size);
    for (std::size_t i = 1; i < levels; ++i) {
        const WaveletGrid &fine = rasters.grids[i - 1], &grid = rasters.grids[i];
        fine.guide.bind(0);
        fine.right.bind(1);
        fine.below.bind(2);
        grid.guide.bind_target(0);
        grid.right.bind_target(1);
        grid.below.bind_target(2);
        halve_.set("grid_size", grid.size);
        halve_.set("fine_size", fine.size);
        halve_.run(grid.size);
    }
}

void WaveletPass::restrict_level(WaveletRasters& rasters, std::size_t level, const WaveletLevel& target) const {
    const WaveletLevel& source = rasters.levels[level];
    const WaveletGrid& fine = rasters.grid_of(level);
    source.far.bind(0);
    source.near.bind(1);
    source.gain.bind(2);
    fine.right.bind(3);
    fine.below.bind(4);
    target.far.bind_target(0);
    target.near.bind_target(1);
    target.gain.bind_target(2);
    const glm::ivec2 size = rasters.grid_of(level + 1).size;
    restrict_.set("grid_size", size);
    restrict_.set("source_size", fine.size);
    restrict_.run(size);
}

void WaveletPass::smooth(WaveletRasters& rasters, std::size_t level, bool along_columns, const WaveletLevel& source,
                         const WaveletLevel& target) const {
    const WaveletGrid& grid = rasters.grid_of(level + 1);
    source.far.bind(0);
    source.near.bind(1);
    grid.guide.bind(2);
    source.gain.bind(3);
    (along_columns ? grid.below : grid.right).bind(4);
    target.far.bind_target(0);
    target.near.bind_target(1);
    target.gain.bind_target(2);
    smooth_.set("grid_size", grid.size);
    smooth_.set("spacing", grid.spacing);
    smooth_.set("along_columns", along_columns ? 1 : 0);
    smooth_.set("first", &source == &rasters.levels[0] ? 1 : 0);
    smooth_.run(grid.size);
}

void WaveletPass::bind_narrow(const gl::Program& program, const WaveletRasters& rasters, std::size_t level,
                              GLuint unit) const {
    const std::size_t narrow = std::min(narrow_level, level);
    const WaveletGrid &grid = rasters.grid_of(level), &narrow_grid = rasters.grid_of(narrow);
    rasters.levels[narrow].far.bind(unit);
    program.set("narrow_level", static_cast<int>(narrow_level));
    program.set("narrow_size", narrow_grid.size);
    program.set("narrow_step", grid.spacing / narrow_grid.spacing);
}

void WaveletPass::refine(WaveletRasters& rasters, std::size_t level, const gl::Raster& coarse, const gl::Raster& fine,
                         const gl::Raster& detail, bool of_far_light) const {
    const WaveletGrid& grid = rasters.grid_of(level);
    coarse.bind(0);
    grid.guide.bind(1);
    grid.right.bind(2);
    grid.below.bind(3);
    rasters.levels[level].far.bind(4);
    rasters.levels[level].near.bind(5);
    rasters.levels[level].gain.bind(6);
    bind_narrow(refine_, rasters, level, 7);
    fine.bind_target(0);
    detail.bind_target(1);
    refine_.set("grid_size", grid.size);
    refine_.set("spacing", grid.spacing);
    refine_.set("coarse_size", rasters.grid_of(level + 1).size);
    refine_.set("level", static_cast<int>(level));
    refine_.set("of_far_light", of_far_light ? 1 : 0);
    refine_.run(grid.size);
}

float WaveletPass::evenness(WaveletRasters& rasters) const {
    rasters.levels[0].far.bind(0);
    rasters.levels[0].near.bind(1);
    rasters.levels[1].far.bind(2);
    rasters.levels[1].near.bind(3);
    rasters.grids[0].guide.bind(4);
    rasters.evenness.bind_target(0);
    const glm::ivec2 size = evenness_size(rasters.size);
    evenness_.set("grid_size", size);
    evenness_.run(size);
    std::vector<float> all = rasters.evenness.read();
    std::erase(all, 0.0f);
    if (all.empty()) return 1.0f;
    const auto median = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    std::nth_element(all.begin(), median, all.end());
    return std::min(*median, 1.0f);
}

void WaveletPass::shrink(WaveletRasters& rasters, std::size_t level, bool from_coarsest, float evenness) const {
    const WaveletGrid &grid = rasters.grid_of(level), &coarser = rasters.grid_of(level + 1);
    const gl::Program& program = level == 1 ? shrink_to_finest_ : shrink_;
    if (level == 0) std::swap(rasters.estimates[0], rasters.estimates[1]);
    (level > 0 ? rasters.scratch.far : rasters.scratch.near).bind(0);
    rasters.estimates[1].bind(1);
    grid.guide.bind(2);
    (from_coarsest ? rasters.scratch : rasters.levels[level + 1]).gain.bind(5);
    rasters.estimates[0].bind_target(0);
    rasters.levels[level].gain.bind_target(2);
    if (level == 1) {
        rasters.levels[0].far.bind(3);
        rasters.levels[0].near.bind(4);
        rasters.scratch.near.bind_target(1);
    }
    program.set("grid_size", grid.size);
    program.set("spacing", grid.spacing);
    program.set("coarser_size", coarser.size);
    program.set("coarser_step", coarser.spacing / grid.spacing);
    program.set("stride", level > 0 ? 2 : 1);
    program.set("evenness", evenness);
    program.run(grid.size);
}

const gl::Raster& WaveletPass::risk(const WaveletRasters& rasters) const { return rasters.levels[0].gain; }

const gl::Raster& WaveletPass::far_light(WaveletRasters& rasters, int blur_levels) const {
    // By turns into what the finest level was.
    const gl::Raster* far = &rasters.levels[levels_of(blur_levels)].far;
    for (std::size_t i = levels_of(blur_levels); i-- > 1;) {
        const gl::Raster& finer = i % 2 == 0 ? rasters.levels[0].far : rasters.estimates[1];
        refine(rasters, i, *far, finer, rasters.levels[0].near, true);
        far = &finer;
    }
    return *far;
}

}  // namespace farfield
