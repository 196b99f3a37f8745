#include "renderer/passes.h"

#include "renderer/records.h"

#include <algorithm>

namespace farfield {
namespace {

int mip_levels(glm::ivec2 size) {
    int levels = 1;
    while ((std::max(size.x, size.y) >> levels) > 0) ++levels;
    return levels;
}

glm::ivec2 level_size(glm::ivec2 size, int level) {
    return glm::max(glm::ivec2(size.x >> level, size.y >> level), glm::ivec2(1));
}

/// See leave in common.glsl. What the camera sees wants shadows that touch what casts them. What light is gathered from
/// does not: grazing rays that start nearer took 12 % of the time of the Cornell room.
constexpr float start_of_seen_shadows = 0.2f, start_of_other_shadows = 1.0f;

void trace(const Work& work, RayKind kind) {
    if (work.observer) work.observer(work, kind);
    work.tracer.trace(work.count, needs_surfaces(kind), work.counting);
}

/// Shadow rays from the bound surfaces to light `light`, traced.
void trace_shadow_rays(const gl::Program& rays, const Work& work, RayKind kind, std::size_t first_surface, int light,
                       float start) {
    rays.set("ray_count", static_cast<unsigned>(work.count));
    rays.set("first_surface", static_cast<unsigned>(first_surface));
    rays.set("light_index", static_cast<unsigned>(light));
    rays.set("reach", far_reach);
    rays.set("start", start);
    rays.run(work.count);
    trace(work, kind);
}

/// Rays over the hemispheres of the bound surfaces.
struct HemisphereRays {
    std::size_t first_surface;
    unsigned sample_index;
    unsigned stream;
    bool stratified;
    bool start_path;
    float reach;
    std::size_t spread = 0;

    void run(const gl::Program& program, const Work& work) const {
        program.set("ray_count", static_cast<unsigned>(work.count));
        program.set("first_surface", static_cast<unsigned>(first_surface));
        program.set("first_pixel", static_cast<unsigned>(work.first_pixel));
        program.set("sample_index", sample_index);
        program.set("stream", stream);
        program.set("stratified", stratified ? 1 : 0);
        program.set("start_path", start_path ? 1 : 0);
        program.set("reach", reach);
        program.set("spread", static_cast<unsigned>(spread));
        program.run(work.count);
    }
};

// Streams of random numbers, apart from the bounces' own 0..8; from roulette_stream on one for each bounce.
constexpr unsigned occlusion_stream = 100, measure_stream = 200, roulette_stream = 300;
constexpr int roulette_after = 4;  // bounces: most of the light has been found, and what is left is dim

/// Of the wavelet: its openness is the one in front of the mean far light. Narrower ones bring noise, wider ones blur
/// contact.
constexpr std::size_t narrow_level = 2;

}  // namespace

Targets::Targets(glm::ivec2 s) : size(s) {
    surfaces.resize(pixels() * surface_bytes);
    for (gl::Buffer* sum :
         {&direct, &geometry, &reflectance, &far_light, &indirect, &occlusion, &split_far, &split_near})
        sum->resize(pixels() * sum_bytes);
    squares.resize(pixels() * square_bytes);
    clear();
}

void Targets::clear() {
    for (gl::Buffer* sum : {&direct, &geometry, &reflectance, &far_light, &indirect, &squares}) sum->clear();
    clear_ao_radius();
}

void Targets::clear_ao_radius() {
    for (gl::Buffer* sum : {&occlusion, &split_far, &split_near}) sum->clear();
}

void Targets::bind() const {
    surfaces.bind_storage(binding::surfaces);
    direct.bind_storage(binding::direct);
    geometry.bind_storage(binding::geometry);
    reflectance.bind_storage(binding::reflectance);
    far_light.bind_storage(binding::far_light);
    indirect.bind_storage(binding::indirect);
    occlusion.bind_storage(binding::occlusion);
    split_far.bind_storage(binding::split_far);
    split_near.bind_storage(binding::split_near);
    squares.bind_storage(binding::squares);
}

std::size_t Targets::bytes() const {
    std::size_t sum = mips.bytes() + blurred.bytes() + guide.bytes();
    for (const gl::Buffer* buffer : {&surfaces, &direct, &geometry, &reflectance, &far_light, &indirect, &occlusion,
                                     &split_far, &split_near, &squares})
        sum += buffer->bytes();
    const auto add = [&](const WaveletLevel& level) {
        sum += level.far.bytes() + level.near.bytes() + level.gain.bytes();
    };
    for (const WaveletLevel& level : levels) add(level);
    add(half_level);
    for (const auto& direction : links)
        for (const gl::Texture& texture : direction) sum += texture.bytes();
    for (const gl::Texture& texture : estimates) sum += texture.bytes();
    return sum;
}

Batch::Batch() {
    rays.resize(capacity * ray_bytes);
    hits.resize(capacity * hit_bytes);
    vertices.resize(capacity * surface_bytes);
    paths.resize(capacity * path_bytes);
}

void Batch::bind() const {
    rays.bind_storage(binding::rays);
    hits.bind_storage(binding::hits);
    paths.bind_storage(binding::paths);
}

void CameraPass::run(const Work& work) const {
    rays_.set("ray_count", static_cast<unsigned>(work.count));
    rays_.set("first_pixel", static_cast<unsigned>(work.first_pixel));
    rays_.set("reach", far_reach);
    rays_.run(work.count);
    trace(work, RayKind::camera);
    gbuffer_.set("ray_count", static_cast<unsigned>(work.count));
    gbuffer_.set("first_pixel", static_cast<unsigned>(work.first_pixel));
    gbuffer_.run(work.count);
}

void DirectPass::run(const Work& work) const {
    for (int light = 0; light < work.light_count; ++light) {
        trace_shadow_rays(rays_, work, RayKind::shadow, work.first_pixel, light, start_of_seen_shadows);
        shade_.set("ray_count", static_cast<unsigned>(work.count));
        shade_.set("first_pixel", static_cast<unsigned>(work.first_pixel));
        shade_.set("light_index", static_cast<unsigned>(light));
        shade_.run(work.count);
    }
}

void FarLightPass::run(const Work& work, unsigned sample_index, int bounces, float near_radius) const {
    for (int bounce = 0; bounce < bounces; ++bounce) {
        // The first rays leave the camera's surfaces, later ones the paths' vertices, which every bounce overwrites.
        const bool first = bounce == 0;
        if (bounce >= roulette_after) {
            roulette_.set("ray_count", static_cast<unsigned>(work.count));
            roulette_.set("first_pixel", static_cast<unsigned>(work.first_pixel));
            roulette_.set("sample_index", sample_index);
            roulette_.set("stream", roulette_stream + static_cast<unsigned>(bounce));
            roulette_.run(work.count);
        }
        HemisphereRays{
            first ? work.first_pixel : 0, sample_index, static_cast<unsigned>(bounce), first, first, far_reach}
            .run(hemisphere_, work);
        follow(work, first);
    }
    work.targets.surfaces.bind_storage(binding::surfaces);
    gather_.set("ray_count", static_cast<unsigned>(work.count));
    gather_.set("first_pixel", static_cast<unsigned>(work.first_pixel));
    gather_.set("near_radius", near_radius);
    gather_.run(work.count);
}

void FarLightPass::follow(const Work& work, bool first) const {
    trace(work, RayKind::bounce);
    work.batch.vertices.bind_storage(binding::surfaces);
    bounce_.set("ray_count", static_cast<unsigned>(work.count));
    bounce_.set("first_bounce", first ? 1 : 0);
    bounce_.run(work.count);
    for (int light = 0; light < work.light_count; ++light) {
        trace_shadow_rays(light_rays_, work, RayKind::bounce_shadow, 0, light, start_of_other_shadows);
        light_.set("ray_count", static_cast<unsigned>(work.count));
        light_.set("light_index", static_cast<unsigned>(light));
        light_.run(work.count);
    }
}

std::vector<double> FarLightPass::measure(const Work& work, int bounces) const {
    std::vector<double> light;
    std::vector<PathRecord> paths(work.count);
    for (int bounce = 0; bounce < bounces; ++bounce) {
        const bool first = bounce == 0;
        HemisphereRays{0,
                       0,
                       measure_stream + static_cast<unsigned>(bounce),
                       false,
                       first,
                       far_reach,
                       first ? work.targets.pixels() : 0}
            .run(hemisphere_, work);
        follow(work, first);
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        work.batch.paths.read(paths.data(), paths.size() * sizeof(PathRecord));
        double sum = 0.0;
        for (const PathRecord& path : paths) sum += path.radiance.x + path.radiance.y + path.radiance.z;
        light.push_back(sum / (3.0 * static_cast<double>(paths.size())));
    }
    work.targets.surfaces.bind_storage(binding::surfaces);
    return light;
}

void OcclusionPass::run(const Work& work, unsigned sample_index, float radius) const {
    HemisphereRays{work.first_pixel, sample_index, occlusion_stream, true, false, radius}.run(hemisphere_, work);
    trace(work, RayKind::occlusion);
    gather_.set("ray_count", static_cast<unsigned>(work.count));
    gather_.set("first_pixel", static_cast<unsigned>(work.first_pixel));
    gather_.run(work.count);
}

const gl::Texture& FilterPass::run(Targets& targets, int blur_levels) const {
    const int levels = mip_levels(targets.size), level = std::clamp(blur_levels, 0, levels - 1);
    if (!targets.mips) targets.mips = gl::Texture("far light mips", GL_RGBA32F, targets.size, levels);
    targets.mips.bind_image(0, GL_WRITE_ONLY);
    start_.run(targets.size);
    if (level == 0) return targets.mips;
    targets.mips.bind(0);
    for (int i = 1; i <= level; ++i) {
        targets.mips.bind_image(0, GL_WRITE_ONLY, i);
        mip_.set("source_level", i - 1);
        mip_.run(level_size(targets.size, i));
    }
    const glm::ivec2 size = level_size(targets.size, level);
    if (!targets.blurred || targets.blurred.size() != size)
        targets.blurred = gl::Texture("blurred far light", GL_RGBA32F, size);
    targets.blurred.bind_image(0, GL_WRITE_ONLY);
    targets.mips.bind(0);
    blur_.set("source_level", level);
    blur_.run(size);
    return targets.blurred;
}

bool WaveletPass::run(Targets& targets, int blur_levels, const std::function<bool()>& stop) const {
    const std::size_t levels = blur_levels > 0 ? static_cast<std::size_t>(blur_levels) + 1 : 0;
    make_textures(targets, levels);
    start_.draw({&targets.levels[0].far, &targets.levels[0].near, &targets.guide});
    targets.guide.bind(0);
    links_.draw({&targets.links[0][0], &targets.links[1][0]});
    for (std::size_t i = 0; i < levels; ++i) {
        if (stop && stop()) return false;
        // Rows first or columns first in turn, so that edges treat both alike.
        smooth(targets, i, i % 2, targets.levels[i], targets.half_level);
        if (stop && stop()) return false;
        smooth(targets, i, 1 - i % 2, targets.half_level, targets.levels[i + 1]);
    }
    for (std::size_t i = levels + 1; i-- > 0;) {
        if (stop && stop()) return false;
        shrink(targets, i);
    }
    return true;
}

void WaveletPass::make_textures(Targets& targets, std::size_t levels) const {
    const auto make = [&](gl::Texture& texture, const char* label, GLenum format = GL_RGBA32F) {
        if (!texture) texture = gl::Texture(label, format, targets.size);
    };
    const auto make_level = [&](WaveletLevel& level) {
        make(level.far, "far level");
        make(level.near, "near level");
        make(level.gain, "noise gain", GL_R32F);
    };
    make(targets.guide, "guide");
    for (gl::Texture& texture : targets.estimates) make(texture, "estimate");
    for (auto& direction : targets.links)
        for (gl::Texture& texture : direction) make(texture, "links", GL_R32F);
    targets.levels.resize(levels + 1);
    for (WaveletLevel& level : targets.levels) make_level(level);
    make_level(targets.half_level);
}

void WaveletPass::smooth(Targets& targets, std::size_t level, std::size_t direction, const WaveletLevel& source,
                         const WaveletLevel& target) const {
    source.far.bind(0);
    source.near.bind(1);
    targets.guide.bind(2);
    source.gain.bind(3);
    targets.links[direction][level % 2].bind(4);
    smooth_.set("step_x", direction == 0 ? 1 << level : 0);
    smooth_.set("step_y", direction == 0 ? 0 : 1 << level);
    smooth_.set("first", &source == &targets.levels[0] ? 1 : 0);
    smooth_.draw({&target.far, &target.near, &target.gain, &targets.links[direction][(level + 1) % 2]});
}

void WaveletPass::shrink(Targets& targets, std::size_t level) const {
    const WaveletLevel &finer = targets.levels[level > 0 ? level - 1 : 0], &coarsest = targets.levels.back();
    const bool first = level + 1 == targets.levels.size();
    if (first) {
        coarsest.far.bind(0);
        coarsest.near.bind(1);
    } else {
        targets.detail(level % 2).bind(0);
        targets.estimates[(level + 1) % 2].bind(1);
        targets.guide.bind(2);
        coarsest.near.bind(6);
    }
    finer.far.bind(3);
    finer.near.bind(4);
    finer.gain.bind(5);
    targets.levels[std::min(narrow_level, targets.levels.size() - 1)].far.bind(7);
    const gl::Program& program = first ? coarsest_ : shrink_;
    program.set("level", static_cast<int>(level));
    program.set("narrow_level", static_cast<int>(narrow_level));
    const gl::Texture& estimate = targets.estimates[level % 2];
    if (level > 0)
        program.draw({&estimate, &targets.detail((level + 1) % 2)});
    else
        program.draw({&estimate});
}

void SynthesisPass::run(Targets& targets, const gl::Texture& filtered, const gl::Texture* estimate, int view,
                        Method method, int frames) const {
    if (!targets.view()) targets.view() = gl::Texture("picture", GL_RGBA32F, targets.size);
    filtered.bind(0);
    if (estimate) estimate->bind(1);
    program_.set("view", view);
    program_.set("method", static_cast<int>(method));
    program_.set("frames", static_cast<float>(std::max(frames, 1)));
    program_.draw({&targets.view()});
}

void DisplayPass::run(Targets& targets, const gl::Texture& output, int view, float exposure) const {
    targets.view().bind(0);
    program_.set("view", view);
    program_.set("exposure", exposure);
    program_.draw({&output});
}

}  // namespace farfield
