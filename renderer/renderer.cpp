#include "renderer/renderer.h"

#include "sdf/local_scene.h"
#include "sdf/pick.h"

#include "renderer/emitters.h"
#include "renderer/records.h"
#include "renderer/sobol.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace farfield {
namespace {

template <class T>
void append_bytes(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Of frame n's camera rays from the pixels' centres, pixels: the point of the first of its samples, so that those of
/// all frames are spread over pixel and hemisphere together. The centre for frame 0. Of a thousand ways to scramble it
/// this one leaves edges of all directions the least error after 2 to 256 frames of 1 to 16 samples.
glm::vec2 pixel_offset(int n, int frame_samples) {
    constexpr unsigned flips_x = 3219546242u, flips_y = 3400147983u;
    const unsigned each = std::bit_ceil(static_cast<unsigned>(std::max(frame_samples, 1)));
    const glm::uvec2 point = sobol(static_cast<unsigned>(n) * each, sobol_pair::camera);
    const glm::ivec2 moved(scrambled(point.x, flips_x) - scrambled(0, flips_x),
                           scrambled(point.y, flips_y) - scrambled(0, flips_y));
    return glm::vec2(moved) * 0x1p-32f;  // modulo 1
}

/// A further bounce that adds less to the mean of indirect light is left out by automatic bounces. So many paths tell
/// what adds that much to a few tenths of it.
constexpr float bounce_threshold = 0.005f;
constexpr std::size_t measured_paths = 4096;

void set_camera(FrameRecord& record, const Camera& camera, glm::ivec2 size) {
    const CameraBasis basis(camera);
    record.camera_position = camera.position - local_origin(camera);
    record.pixel_angle = 2.0f * basis.half_height / static_cast<float>(size.y);
    record.camera_right = basis.right * (basis.half_height * static_cast<float>(size.x) / static_cast<float>(size.y));
    record.camera_up = basis.up * basis.half_height;
    record.camera_forward = basis.forward;
    record.image_size = size;
}

/// All but the camera.
FrameRecord frame_record(const Scene& scene, const FrameOptions& options) {
    FrameRecord record{};
    record.seed = options.seed;
    record.sky_horizon = scene.sky.horizon;
    record.light_count = static_cast<int>(scene.lights.size());
    record.sky_zenith = scene.sky.zenith;
    record.minimum_step = std::log2(options.minimum_step);
    record.step_limit = options.step_limit;
    return record;
}

std::vector<MaterialRecord> material_records(const Scene& scene) {
    std::vector<MaterialRecord> records;
    for (const Material& m : scene.materials) records.push_back({m.albedo, m.specular, m.emission, m.exponent});
    return records;
}

std::vector<LightRecord> light_records(const Scene& scene) {
    std::vector<LightRecord> records;
    for (const Light& light : scene.lights) {
        const bool directional = light.kind == LightKind::directional;
        const float length = glm::length(light.direction);
        const glm::vec3 direction = length > 0.0f ? light.direction / length : glm::vec3(0.0f, -1.0f, 0.0f);
        records.push_back({directional ? direction : light.position - local_origin(scene.camera), directional ? 1u : 0u,
                           light.intensity, 0.0f});
    }
    return records;
}

}  // namespace

Transport transport(const Scene& scene, const FrameOptions& options) {
    Transport result{FieldTree(scene), {}, {}};
    for (const MaterialRecord& record : material_records(scene)) append_bytes(result.light, record);
    for (const LightRecord& record : light_records(scene)) append_bytes(result.light, record);
    append_bytes(result.light, frame_record(scene, options));
    append_bytes(result.light, scene.settings.bounces);
    append_bytes(result.light, local_origin(scene.camera));  // what the records count from
    FrameRecord camera{};
    set_camera(camera, scene.camera, {1, 1});
    append_bytes(result.camera, camera);
    return result;
}

Renderer::Renderer() {
    counters_.resize(sizeof(CounterRecord));
    statistics_.device = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
}

bool Renderer::keeps_samples(const Scene& scene, const FrameOptions& options) const {
    return transport(scene, options) == transport_;
}

int Renderer::compile_one(const Scene& scene, Tier tier, Id tuned) {
    const int missing = programs_.compile_one(scene, tier, tuned);
    note_compiles();
    return missing;
}

void Renderer::note_compiles() {
    statistics_.structural_compiles = programs_.structural_compiles();
    statistics_.specialisations = programs_.other_compiles();
    statistics_.compile_milliseconds = programs_.last_compile_milliseconds();
}

bool Renderer::update(const Scene& scene, const FrameOptions& options) {
    programs_.select(scene, options.tier, options.tuned);  // may throw; nothing has changed until here
    note_compiles();
    statistics_.specialised = options.tier == Tier::specialised && options.tuned == 0;

    Transport now = transport(scene, options);
    const bool changed = now != transport_ || !targets_ || targets_->size != options.size;
    const bool new_occlusion = scene.settings.ao_radius != scene_.settings.ao_radius;
    const bool has_past =
        options.reprojection && !options.other && now.geometry == transport_.geometry && now.light == transport_.light;
    if (!has_past) past_.drop();
    if (changed) {
        if (has_past) keep_past();
        moves_ = has_past ? moves_ + 1 : 0;
    }
    scene_ = scene;
    options_ = options;
    if (std::optional<Look>& other = options_.other)
        other->blur_levels = blur_levels(other->blur_levels, options_.size);
    transport_ = std::move(now);
    if (!targets_ || targets_->size != options.size) {
        targets_.reset();  // frees before it takes
        targets_.emplace(options.size);
    }
    if (changed) {
        const std::vector<MaterialRecord> materials = material_records(scene);
        const std::vector<LightRecord> lights = light_records(scene);
        materials_.upload(std::span(materials));
        lights_.upload(std::span(lights));
        if (!has_past) {
            const std::vector<EmitterRecord> emitters = find_emitters(scene, transport_.geometry);
            emitter_count_ = static_cast<int>(emitters.size());
            emitters_.upload(std::span(emitters));
        }
        restart();
    } else if (new_occlusion) {
        targets_->clear_ao_radius();
        occlusion_samples_ = 0;
    }
    return changed;
}

/// Before the camera or the size changes: the picture as it is, if it has been filtered; else the one before stays.
void Renderer::keep_past() {
    if (!estimate_) return;
    FrameRecord camera{};
    set_camera(camera, scene_.camera, options_.size);
    past_.keep(*estimate_, targets_->wavelet.grids[0].guide, estimate_unit_, camera);
}

void Renderer::discard() {
    past_.drop();
    moves_ = 0;
    restart();
}

void Renderer::restart() {
    targets_->clear();
    estimate_ = nullptr;
    in_frame_ = false;
    completed_cameras_ = 0;
    far_samples_ = 0;
    occlusion_samples_ = 0;
    bounces_measured_ = false;
    statistics_.frames = 0;
    statistics_.samples = 0;
}

std::size_t Renderer::samples_together() const {
    if (sample_ < 0 || far_samples_ == 0) return 1;  // of a new picture something is to be seen soon
    const std::size_t most = std::clamp<std::size_t>(batch_size_ / 64, 1, most_samples_together);
    return std::min(most, static_cast<std::size_t>(frame_samples_ - sample_));
}

Work Renderer::next_work() const {
    const std::size_t samples = samples_together();
    return {programs_,
            *targets_,
            batch_,
            first_pixel_,
            std::min(batch_size_ / samples, targets_->pixels() - first_pixel_),
            samples,
            static_cast<int>(scene_.lights.size()),
            emitter_count_ > 0,
            options_.counting,
            observer_};
}

void Renderer::begin_frame() {
    in_frame_ = true;
    batch_size_ = std::clamp<std::size_t>(options_.batch, 64, Batch::capacity);
    first_pixel_ = 0;
    sample_ = -1;
    frame_samples_ = options_.samples > 0 ? options_.samples : scene_.settings.samples;
    frame_start_ = std::chrono::steady_clock::now();
    timers_.begin_frame();
    FrameRecord record = frame_record(scene_, options_);
    record.emitter_count = emitter_count_;
    set_camera(record, scene_.camera, options_.size);
    const glm::vec2 offset = pixel_offset(options_.first_frame + completed_cameras_, frame_samples_);
    record.jitter_x = offset.x;
    record.jitter_y = offset.y;
    record.seed += moves_;
    frame_.upload(&record, sizeof record);
    const CounterRecord zero;
    counters_.upload(&zero, sizeof zero);
}

bool Renderer::step() {
    if (!in_frame_) begin_frame();
    frame_.bind_uniform(binding::frame);
    targets_->bind();
    batch_.bind();
    for (const auto& [buffer, at] : {std::pair(&materials_, binding::materials), std::pair(&lights_, binding::lights),
                                     std::pair(&emitters_, binding::emitters)})
        buffer->bind_texels(binding::first_texels + at, GL_RGBA32UI);
    counters_.bind_storage(binding::counters);
    const Work w = next_work();
    if (sample_ < 0) {
        {
            Timers::Scope scope(timers_, "camera rays");
            camera_pass_.run(w);
        }
        Timers::Scope scope(timers_, "direct light");
        direct_pass_.run(w);
    } else {
        {
            Timers::Scope scope(timers_, "far light");
            const auto elsewhere = static_cast<unsigned>(options_.first_frame * frame_samples_);
            far_light_pass_.run(w, elsewhere + far_samples_, bounces(), scene_.settings.ao_radius);
        }
        Work single = w;
        single.samples = 1;
        for (unsigned ray = 0; ray < occlusion_rays(); ++ray) {
            Timers::Scope scope(timers_, "ambient occlusion");
            occlusion_pass_.run(single, occlusion_samples_ + ray, scene_.settings.ao_radius);
        }
    }
    first_pixel_ += w.pixels;
    if (first_pixel_ < targets_->pixels()) return false;
    first_pixel_ = 0;
    if (sample_ < 0) {
        ++completed_cameras_;
        const int before = bounces();
        if (options_.measure_bounces ? !bounces_measured_ : before == 0) measure_bounces();
        if (bounces() != before && far_samples_ > 0) {
            discard();
            return false;
        }
        statistics_.bounces = bounces();
        sample_ = 0;
    } else {
        occlusion_samples_ += occlusion_rays();
        far_samples_ += static_cast<unsigned>(w.samples);
        sample_ += static_cast<int>(w.samples);
        statistics_.samples = static_cast<int>(far_samples_);
    }
    if (sample_ < frame_samples_) return false;
    finish_frame();
    return true;
}

void Renderer::measure_bounces() {
    Timers::Scope scope(timers_, "bounces");
    Work work = next_work();
    work.pixels = measured_paths;
    work.samples = 1;
    work.counting = false;
    const std::vector<double> light = far_light_pass_.measure(work, most_bounces + 1);
    std::vector<float>& shares = statistics_.bounce_shares;
    shares.assign(1, 1.0f);
    for (std::size_t i = 1; i < light.size(); ++i) {
        const double added = light[i] - light[i - 1];
        shares.push_back(added > 0.0 ? static_cast<float>(added / std::max(light[i - 1], 0.01 * added)) : 0.0f);
    }
    automatic_bounces_ = most_bounces;
    while (automatic_bounces_ > 1 && shares[static_cast<std::size_t>(automatic_bounces_) - 1] < bounce_threshold)
        --automatic_bounces_;
    bounces_measured_ = true;
}

void Renderer::finish_frame() {
    in_frame_ = false;
    statistics_.frames = completed_cameras_;
    CounterRecord counters;
    if (options_.counting) counters_.read(&counters, sizeof counters);
    statistics_.rays = counters.rays;
    statistics_.evaluations = counters.steps;
    statistics_.exhausted_rays = counters.exhausted_rays;
    statistics_.passes = timers_.collect();
    const auto elapsed = std::chrono::steady_clock::now() - frame_start_;
    statistics_.frame_milliseconds = std::chrono::duration<double, std::milli>(elapsed).count();
}

bool Renderer::displayable() const {
    const bool mixed = in_frame_ && sample_ < 0 && first_pixel_ > 0;  // some pixels have one camera sample more
    return far_samples_ > 0 && !mixed;
}

void Renderer::render_frame() {
    while (!step()) {}
}

bool Renderer::filter(const Look& look, const std::function<bool()>& stop) {
    frame_.bind_uniform(binding::frame);
    targets_->bind();
    estimate_ = nullptr;
    if (look.method != Method::farfield) {
        blurred_ = &filter_pass_.run(*targets_, look.blur_levels);
        return true;
    }
    if (!wavelet_pass_.run(targets_->wavelet, look.blur_levels, stop)) return false;
    estimate_ = &targets_->wavelet.estimates[0];
    estimate_unit_ = static_cast<float>(far_samples_);
    const int most = Reprojection::pictures * frame_samples_ - static_cast<int>(far_samples_);
    if (most <= 0) past_.drop();
    if (past_) {
        estimate_ = &past_.add(*targets_, estimate_unit_, static_cast<float>(most));
        estimate_unit_ = 1.0f;
    }
    return true;
}

void Renderer::synthesise(const Look& look) {
    const bool filtered = look.view == View::filtered || look.view == View::direct_filtered;
    const gl::Raster* far_light = look.method == Method::farfield && filtered
                                      ? &wavelet_pass_.far_light(targets_->wavelet, look.blur_levels)
                                      : nullptr;
    synthesis_pass_.run(*targets_, blurred_, far_light, estimate_, static_cast<int>(look.view), look.method,
                        completed_cameras_);
}

bool Renderer::display(const gl::Texture& output, const gl::Texture& other, const std::function<bool()>& stop) {
    const auto show = [&](const Look& look, const gl::Texture& to) {
        synthesise(look);
        display_pass_.run(*targets_, to, static_cast<int>(look.view), scene_.settings.exposure);
    };
    const Look own = own_look(options_.view);
    if (!filter(own, stop)) return false;
    show(own, output);
    if (!options_.other || !other) return true;
    const Look& look = *options_.other;
    const bool same_filter =
        (look.method == Method::farfield) == (own.method == Method::farfield) && look.blur_levels == own.blur_levels;
    if (!same_filter && !filter(look, stop)) return false;
    show(look, other);
    return true;
}

std::vector<unsigned char> Renderer::display_pixels() {
    const gl::Texture output("display", GL_RGBA8, options_.size);
    display(output);
    std::vector<unsigned char> rgb(targets_->pixels() * 3);
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    output.bind(0);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGB, GL_UNSIGNED_BYTE, rgb.data());
    return rgb;
}

std::optional<double> Renderer::noise(const std::function<bool()>& stop) {
    const Look look = own_look(View::result);
    std::vector<float> risk;
    if (look.method == Method::farfield && look.blur_levels > 0) {
        if (!filter(look, stop)) return std::nullopt;
        risk = wavelet_pass_.risk(targets_->wavelet).read();
    }
    constexpr std::size_t part = 1 << 16;                // pixels that are read at once
    std::vector<glm::vec4> sums(part), reflected(part);  // w: samples, 0 without a surface
    std::vector<float> squares(part);
    double error = 0.0, light = 0.0, count = 0.0;
    for (std::size_t first = 0; first < targets_->pixels(); first += part) {
        const std::size_t pixels = std::min(part, targets_->pixels() - first);
        targets_->far_light.read(sums.data(), pixels * sizeof sums[0], first * sizeof sums[0]);
        targets_->indirect.read(reflected.data(), pixels * sizeof reflected[0], first * sizeof reflected[0]);
        targets_->squares.read(squares.data(), pixels * sizeof squares[0], first * sizeof squares[0]);
        for (std::size_t i = 0; i < pixels; ++i) {
            const double n = sums[i].w;
            if (n < 1.0) continue;
            const glm::dvec3 sum(sums[i]), mean = sum / n, shown(reflected[i]), albedo = shown / glm::max(sum, 1e-30);
            const double variance = std::max(squares[i] / n - glm::dot(mean, mean) / 3.0, 0.0) / (n - 1.0);
            error += (risk.empty() || n < 2.0 ? variance : risk[first + i]) * glm::dot(albedo, albedo) / 3.0;
            light += (shown.x + shown.y + shown.z) / (3.0 * n);
            ++count;
        }
    }
    if (light <= 0.0) return 0.0;
    return std::isnan(error) ? std::numeric_limits<double>::infinity() : std::sqrt(error * count) / light;
}

Image Renderer::read(View view) {
    const Look look = own_look(view);
    filter(look);
    synthesise(look);
    return {options_.size, targets_->view().read()};
}

}  // namespace farfield
