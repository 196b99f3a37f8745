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

/// Shadow rays from `count` of the bound surfaces to light `light`, traced.
void trace_shadow_rays(const gl::Program& rays, const Work& work, std::size_t first_surface, int light) {
    rays.set("ray_count", static_cast<unsigned>(work.count));
    rays.set("first_surface", static_cast<unsigned>(first_surface));
    rays.set("light_index", static_cast<unsigned>(light));
    rays.set("reach", far_reach);
    rays.run(work.count);
    work.tracer.trace(work.count, false, work.counting);
}

/// Rays over the hemispheres of the bound surfaces.
struct HemisphereRays {
    std::size_t first_surface;
    unsigned sample_index;
    unsigned stream;
    bool stratified;
    bool start_path;
    float reach;

    void run(const gl::Program& program, const Work& work) const {
        program.set("ray_count", static_cast<unsigned>(work.count));
        program.set("first_surface", static_cast<unsigned>(first_surface));
        program.set("first_pixel", static_cast<unsigned>(work.first_pixel));
        program.set("sample_index", sample_index);
        program.set("stream", stream);
        program.set("stratified", stratified ? 1 : 0);
        program.set("start_path", start_path ? 1 : 0);
        program.set("reach", reach);
        program.run(work.count);
    }
};

constexpr unsigned occlusion_stream = 100;  // apart from the bounces' streams 0..8
constexpr unsigned roulette_stream = 200;   // and more, one for each bounce
constexpr int roulette_after = 4;           // bounces: most of the light has been found, and what is left is dim

}  // namespace

Targets::Targets(glm::ivec2 s)
    : size(s), mips("far light mips", GL_RGBA32F, s, mip_levels(s)), view("view", GL_RGBA32F, s) {
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
    work.tracer.trace(work.count, true, work.counting);
    gbuffer_.set("ray_count", static_cast<unsigned>(work.count));
    gbuffer_.set("first_pixel", static_cast<unsigned>(work.first_pixel));
    gbuffer_.run(work.count);
}

void DirectPass::run(const Work& work) const {
    for (int light = 0; light < work.light_count; ++light) {
        trace_shadow_rays(rays_, work, work.first_pixel, light);
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
        work.tracer.trace(work.count, true, work.counting);
        work.batch.vertices.bind_storage(binding::surfaces);
        bounce_.set("ray_count", static_cast<unsigned>(work.count));
        bounce_.set("first_bounce", first ? 1 : 0);
        bounce_.run(work.count);
        for (int light = 0; light < work.light_count; ++light) {
            trace_shadow_rays(light_rays_, work, 0, light);
            light_.set("ray_count", static_cast<unsigned>(work.count));
            light_.set("light_index", static_cast<unsigned>(light));
            light_.run(work.count);
        }
    }
    work.targets.surfaces.bind_storage(binding::surfaces);
    gather_.set("ray_count", static_cast<unsigned>(work.count));
    gather_.set("first_pixel", static_cast<unsigned>(work.first_pixel));
    gather_.set("near_radius", near_radius);
    gather_.run(work.count);
}

void OcclusionPass::run(const Work& work, unsigned sample_index, float radius) const {
    HemisphereRays{work.first_pixel, sample_index, occlusion_stream, true, false, radius}.run(hemisphere_, work);
    work.tracer.trace(work.count, false, work.counting);
    gather_.set("ray_count", static_cast<unsigned>(work.count));
    gather_.set("first_pixel", static_cast<unsigned>(work.first_pixel));
    gather_.run(work.count);
}

const gl::Texture& FilterPass::run(Targets& targets, int blur_levels) const {
    const int level = std::clamp(blur_levels, 0, targets.mips.levels() - 1);
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

const gl::Texture& WaveletPass::run(Targets& targets, int blur_levels) const {
    const glm::ivec2 size = targets.size;
    const auto levels = static_cast<std::size_t>(std::max(blur_levels, 0));
    const auto make = [&](gl::Texture& texture, const char* label, GLenum format = GL_RGBA32F) {
        if (!texture) texture = gl::Texture(label, format, size);
    };
    make(targets.guide, "guide");
    make(targets.detail, "detail");
    for (gl::Texture& texture : targets.estimates) make(texture, "estimate");
    targets.far_levels.resize(levels + 1);
    targets.near_levels.resize(levels + 1);
    targets.gain_levels.resize(levels + 1);
    targets.link_levels.resize(levels + 1);
    for (gl::Texture& texture : targets.far_levels) make(texture, "far level");
    for (gl::Texture& texture : targets.near_levels) make(texture, "near level");
    for (gl::Texture& texture : targets.gain_levels) make(texture, "noise gain", GL_R32F);
    for (gl::Texture& texture : targets.link_levels) make(texture, "links", GL_RG32F);

    targets.far_levels[0].bind_image(0, GL_WRITE_ONLY);
    targets.near_levels[0].bind_image(1, GL_WRITE_ONLY);
    targets.gain_levels[0].bind_image(2, GL_WRITE_ONLY);
    targets.guide.bind_image(3, GL_WRITE_ONLY);
    start_.run(size);
    for (std::size_t i = 0; i < levels; ++i) {
        targets.link_levels[i > 0 ? i - 1 : levels].bind(0);
        targets.guide.bind(1);
        targets.link_levels[i].bind_image(0, GL_WRITE_ONLY);
        links_.set("stride", 1 << i);
        links_.run(size);
        targets.link_levels[i].bind(4);
        targets.far_levels[i].bind(0);
        targets.near_levels[i].bind(1);
        targets.guide.bind(2);
        targets.gain_levels[i].bind(3);
        targets.gain_levels[i + 1].bind_image(2, GL_WRITE_ONLY);
        targets.far_levels[i + 1].bind_image(0, GL_WRITE_ONLY);
        targets.near_levels[i + 1].bind_image(1, GL_WRITE_ONLY);
        smooth_.set("stride", 1 << i);
        smooth_.run(size);
    }
    // From the coarsest level, taken as it is, to the unfiltered one.
    for (std::size_t i = levels + 1; i-- > 0;) {
        const gl::Texture& coarser = targets.estimates[(i + 1) % 2];
        targets.far_levels[i].bind(0);
        targets.near_levels[i].bind(1);
        targets.gain_levels[i].bind(2);
        coarser.bind(3);
        targets.near_levels[levels].bind(4);
        targets.detail.bind_image(0, GL_WRITE_ONLY);
        detail_.set("level", static_cast<int>(i));
        detail_.set("coarsest", i == levels ? 1 : 0);
        detail_.run(size);
        targets.detail.bind(0);
        targets.guide.bind(2);
        targets.estimates[i % 2].bind_image(0, GL_WRITE_ONLY);
        shrink_.set("level", static_cast<int>(i));
        shrink_.set("coarsest", i == levels ? 1 : 0);
        shrink_.run(size);
    }
    return targets.estimates[0];
}

void SynthesisPass::run(const Targets& targets, const gl::Texture& filtered, const gl::Texture& estimate, int view,
                        Method method, int frames) const {
    filtered.bind(0);
    if (estimate) estimate.bind(1);
    targets.view.bind_image(0, GL_WRITE_ONLY);
    program_.set("view", view);
    program_.set("method", static_cast<int>(method));
    program_.set("frames", static_cast<float>(std::max(frames, 1)));
    program_.run(targets.size);
}

void DisplayPass::run(const Targets& targets, const gl::Texture& output, int view, float exposure) const {
    targets.view.bind_image(0, GL_READ_ONLY);
    output.bind_image(1, GL_WRITE_ONLY);
    program_.set("view", view);
    program_.set("exposure", exposure);
    program_.run(targets.size);
}

}  // namespace farfield
