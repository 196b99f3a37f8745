#include "renderer/passes.h"

#include "renderer/records.h"
#include "renderer/sobol.h"

#include <algorithm>
#include <array>

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

void trace(const Work& work, RayKind kind) {
    if (work.observer) work.observer(work, kind);
    work.tracer.trace(work.rays(), needs_surfaces(kind), work.counting);
}

/// One invocation for each ray of the batch.
void run_on_rays(const gl::Program& program, const Work& work) {
    program.set("ray_count", static_cast<unsigned>(work.rays()));
    program.run(work.rays());
}

/// One for each pixel, and if `sampled` for each of its samples.
void run_on_pixels(const gl::Program& program, const Work& work, bool sampled) {
    program.set("pixel_count", static_cast<unsigned>(work.pixels));
    program.set("first_pixel", static_cast<unsigned>(work.first_pixel));
    program.run(work.pixels, sampled ? work.samples : 1);
}

// Streams of random numbers, apart from the bounces' own 0..8; from roulette_stream on one for each bounce.
constexpr unsigned occlusion_stream = 100, measure_stream = 200, roulette_stream = 300;

/// Points of the work's samples, of which `first` is the first, for the rays of a bounce.
void set_points(const gl::Program& program, const Work& work, unsigned first, int bounce) {
    std::array<glm::uvec2, most_samples_together> points;
    for (unsigned i = 0; i < work.samples; ++i) points[i] = sobol(first + i, sobol_pair::of_bounce(bounce));
    program.set("points", std::span(points).first(work.samples));
}

/// Rays over the hemispheres of the camera's surfaces.
struct HemisphereRays {
    unsigned sample_index;
    unsigned stream;
    bool stratified;
    float reach;
    std::size_t spread = 0;

    void run(const gl::Program& program, const Work& work) const {
        set_points(program, work, sample_index, 0);
        program.set("stream", stream);
        program.set("stratified", stratified ? 1 : 0);
        program.set("reach", reach);
        program.set("spread", static_cast<unsigned>(spread));
        run_on_pixels(program, work, true);
    }
};

constexpr int roulette_after = 4;  // bounces: most of the light has been found, and what is left is dim
/// Of paths: farther than anything, see far_reach in common.glsl.
constexpr float no_limit = 1e4f;

}  // namespace

Targets::Targets(glm::ivec2 s) : size(s), wavelet(s) {
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
    bind_records(surfaces, binding::surfaces);
    bind_records(direct, binding::direct);
    bind_records(geometry, binding::geometry);
    bind_records(reflectance, binding::reflectance);
    bind_records(far_light, binding::far_light);
    bind_records(indirect, binding::indirect);
    bind_records(occlusion, binding::occlusion);
    bind_records(split_far, binding::split_far);
    bind_records(split_near, binding::split_near);
    bind_records(squares, binding::squares);
}

std::size_t Targets::bytes() const {
    std::size_t sum = mips.bytes() + blurred.bytes() + wavelet.bytes();
    for (const gl::Buffer* buffer : {&surfaces, &direct, &geometry, &reflectance, &far_light, &indirect, &occlusion,
                                     &split_far, &split_near, &squares})
        sum += buffer->bytes();
    return sum;
}

Batch::Batch() {
    rays.resize(capacity * ray_bytes);
    hits.resize(capacity * hit_bytes);
    vertices.resize(capacity * surface_bytes);
    paths.resize(capacity * path_bytes);
}

void Batch::bind() const {
    bind_records(rays, binding::rays);
    bind_records(hits, binding::hits);
    bind_records(paths, binding::paths);
}

void CameraPass::run(const Work& work) const {
    rays_.set("first_pixel", static_cast<unsigned>(work.first_pixel));
    run_on_rays(rays_, work);
    trace(work, RayKind::camera);
    gbuffer_.set("first_pixel", static_cast<unsigned>(work.first_pixel));
    run_on_rays(gbuffer_, work);
}

void DirectPass::run(const Work& work) const {
    for (int light = 0; light < work.light_count; ++light) {
        for (const gl::Program* program : {&rays_, &shade_}) {
            program->set("first_pixel", static_cast<unsigned>(work.first_pixel));
            program->set("light_index", static_cast<unsigned>(light));
        }
        run_on_rays(rays_, work);
        trace(work, RayKind::shadow);
        run_on_rays(shade_, work);
    }
}

const FarLightPass::Leaving& FarLightPass::leaving(const Work& work) const {
    if (!work.guided) return unguided_;
    if (!guided_) guided_.emplace("#define guided 1\n");
    return *guided_;
}

void FarLightPass::run(const Work& work, unsigned sample_index, int bounces, float near_radius) const {
    HemisphereRays{sample_index, 0, true, no_limit}.run(leaving(work).hemisphere, work);
    for (int bounce = 0; bounce < bounces; ++bounce) {
        if (bounce > 0) go_on(work, sample_index, bounce, 0, bounce >= roulette_after);
        follow(work, bounce == 0, bounce + 1 == bounces);
    }
    bind_records(work.targets.surfaces, binding::surfaces);
    gather_.set("sample_count", static_cast<unsigned>(work.samples));
    gather_.set("near_radius", near_radius);
    run_on_pixels(gather_, work, false);
}

void FarLightPass::follow(const Work& work, bool first, bool last) const {
    trace(work, RayKind::bounce);
    bind_records(work.batch.vertices, binding::surfaces);
    const gl::Program& bounce = last && work.light_count <= 1 ? last_bounce_ : bounce_;
    bounce.set("first_bounce", first ? 1 : 0);
    run_on_rays(bounce, work);
    for (int light = 0; light < work.light_count; ++light) {
        if (light > 0) {
            next_light_.set("light_index", static_cast<unsigned>(light));
            run_on_rays(next_light_, work);
        }
        trace(work, RayKind::bounce_shadow);
    }
}

void FarLightPass::go_on(const Work& work, unsigned sample_index, int bounce, unsigned first_stream,
                         bool roulette) const {
    const gl::Program& continuation = leaving(work).continuation;
    const unsigned stream = first_stream + static_cast<unsigned>(bounce);
    set_points(continuation, work, sample_index, bounce);
    continuation.set("sample_index", sample_index);
    continuation.set("stream", stream);
    continuation.set("roulette_stream", roulette_stream + stream);
    continuation.set("roulette", roulette ? 1 : 0);
    run_on_pixels(continuation, work, true);
}

std::vector<double> FarLightPass::measure(const Work& work, int bounces) const {
    std::vector<double> light;
    std::vector<PathRecord> paths(work.rays());
    HemisphereRays{0, measure_stream, false, no_limit, work.targets.pixels()}.run(leaving(work).hemisphere, work);
    for (int bounce = 0; bounce < bounces; ++bounce) {
        follow(work, bounce == 0, false);
        go_on(work, 0, bounce + 1, measure_stream, false);  // adds what came with the shadow rays
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        work.batch.paths.read(paths.data(), paths.size() * sizeof(PathRecord));
        double sum = 0.0;
        for (const PathRecord& path : paths) sum += path.radiance.x + path.radiance.y + path.radiance.z;
        light.push_back(sum / (3.0 * static_cast<double>(paths.size())));
    }
    bind_records(work.targets.surfaces, binding::surfaces);
    return light;
}

void OcclusionPass::run(const Work& work, unsigned sample_index, float radius) const {
    HemisphereRays{sample_index, occlusion_stream, true, radius}.run(hemisphere_, work);
    trace(work, RayKind::occlusion);
    gather_.set("first_pixel", static_cast<unsigned>(work.first_pixel));
    run_on_rays(gather_, work);
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

void SynthesisPass::run(Targets& targets, const gl::Texture* blurred, const gl::Raster* filtered,
                        const gl::Raster* estimate, int view, Method method, int frames) const {
    if (!targets.view()) targets.view() = gl::Raster("picture", targets.size);
    if (blurred) blurred->bind(0);
    if (filtered) filtered->bind(1);
    if (estimate) estimate->bind(2);
    targets.view().bind_target(0);
    program_.set("view", view);
    program_.set("method", static_cast<int>(method));
    program_.set("frames", static_cast<float>(std::max(frames, 1)));
    program_.run(targets.size);
}

void DisplayPass::run(Targets& targets, const gl::Texture& output, int view, float exposure) const {
    targets.view().bind(0);
    program_.set("view", view);
    program_.set("exposure", exposure);
    program_.draw(output);
}

}  // namespace farfield
