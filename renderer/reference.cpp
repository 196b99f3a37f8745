#include "renderer/reference.h"

#include "renderer/metrics.h"
#include "sdf/codegen.h"

#include <sha2.h>

#include <algorithm>
#include <sstream>

namespace farfield {
namespace {

constexpr int version = 2;            // of what else decides: raise it when passes.cpp follows paths anew
constexpr int frame_samples = 8;      // for each camera ray of a pixel, which antialiases
constexpr int portion_samples = 512;  // what an interrupted run loses at most
constexpr int first_frame = 1 << 20;  // of the first half, the other's is twice that: places in the pixel of their own
constexpr std::uint32_t first_seed = 0x5eed0000u;  // of the first half; far from those that people give

int half_of(int samples) { return (samples + 1) / 2; }

/// Samples of the next portion for a half.
int next_portion(const ReferenceHalf& half, int samples) {
    const int wanted = std::max(half_of(samples) - half.samples, 0);
    return std::min(portion_samples, (wanted + frame_samples - 1) / frame_samples * frame_samples);
}

/// Whether a shader reads what was accumulated and adds nothing to a reference.
bool only_shows(std::string_view shader) {
    return shader.starts_with("wavelet") || shader.starts_with("filter") || shader.starts_with("limit") ||
           shader == "occlusion.glsl" || shader == "reproject.glsl" || shader == "display.glsl";
}

/// `mean` of `samples` becomes that of `samples` + `more`.
void add(Image& mean, int samples, const Image& image, int more) {
    if (samples == 0) {
        mean = image;
        return;
    }
    const double share = static_cast<double>(more) / (static_cast<double>(samples) + more);
    for (std::size_t i = 0; i < mean.pixels.size(); ++i)
        mean.pixels[i] += static_cast<float>(share * (static_cast<double>(image.pixels[i]) - mean.pixels[i]));
}

/// Automatic bounces leave out what is too little to be seen; the reference does not.
Scene with_all_bounces(Scene scene) {
    if (scene.settings.bounces == 0) scene.settings.bounces = most_bounces;
    return scene;
}

Image mean_of(const Reference& reference, Image ReferenceHalf::*image) {
    const auto& [a, b] = reference.halves;
    Image mean = a.*image;
    add(mean, a.samples, b.*image, b.samples);
    return mean;
}

}  // namespace

Image Reference::indirect() const { return mean_of(*this, &ReferenceHalf::indirect); }
Image Reference::result() const { return mean_of(*this, &ReferenceHalf::result); }

double Reference::noise_mse() const {
    const auto& [a, b] = halves;
    const double n = a.samples, m = b.samples, rmse = compare(a.indirect, b.indirect).rmse;
    return rmse * rmse * n * m / ((n + m) * (n + m));
}

double Reference::noise_relative_mse() const {
    // Noise of the same size as the mean's, on top of the mean.
    Image noisy = indirect();
    const Image reference = noisy;
    const auto& [a, b] = halves;
    const double n = a.samples, m = b.samples, scale = std::sqrt(n * m) / (n + m);
    for (std::size_t i = 0; i < noisy.pixels.size(); ++i)
        noisy.pixels[i] += static_cast<float>(scale * (a.indirect.pixels[i] - b.indirect.pixels[i]));
    return relative_mse(noisy, reference);
}

std::string sha256(std::string_view bytes) {
    char digits[SHA256_DIGEST_STRING_LENGTH];
    SHA256Data(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), digits);
    return digits;
}

std::string shader_hash(bool all) {
    std::string code;
    for (std::string_view names = FARFIELD_SHADERS; !names.empty();) {
        const std::string_view name = names.substr(0, names.find('|'));
        names.remove_prefix(std::min(name.size() + 1, names.size()));
        if (!all && only_shows(name)) continue;
        std::istringstream in(shader_source(name));
        for (std::string line; std::getline(in, line);) {
            line.erase(std::min(line.find("//"), line.size()));  // a better comment is no other light
            line.erase(line.find_last_not_of(" \t") + 1);
            if (!line.empty() && !line.starts_with("#line")) code += line + "\n";
        }
    }
    return sha256(code);
}

std::string reference_key(const Scene& scene, glm::ivec2 size) {
    static const std::string shaders = shader_hash(false);
    const int numbers[] = {version, frame_samples, size.x, size.y};
    const GeneratedScene geometry = generate(scene, Tier::live);
    const Transport all = transport(with_all_bounces(scene), FrameOptions{});
    std::string bytes = geometry.key;
    bytes.append(reinterpret_cast<const char*>(geometry.parameters.data()), geometry.parameters.size() * sizeof(float));
    bytes += all.light + all.camera + shaders;
    bytes.append(reinterpret_cast<const char*>(numbers), sizeof numbers);
    return sha256(bytes);
}

int frames_to_extend(const Reference& reference, int samples) {
    int frames = 0;
    for (const ReferenceHalf& half : reference.halves)
        frames += (std::max(half_of(samples) - half.samples, 0) + frame_samples - 1) / frame_samples;
    return frames;
}

bool extend(Reference& reference, Renderer& renderer, Scene scene, glm::ivec2 size, int samples,
            const std::function<bool()>& frame_done, const std::function<void()>& portion_done) {
    scene = with_all_bounces(std::move(scene));
    scene.settings.method = Method::reference;
    FrameOptions options;
    options.size = size;
    options.samples = frame_samples;
    for (;;) {
        const auto& [a, b] = reference.halves;
        const std::uint32_t behind = a.samples <= b.samples ? 0 : 1;
        ReferenceHalf& half = reference.halves[behind];
        const int portion = next_portion(half, samples);
        if (portion == 0) return true;
        options.seed = first_seed + behind;
        options.first_frame = first_frame * static_cast<int>(behind + 1) + half.samples / frame_samples;
        renderer.update(scene, options);
        renderer.discard();
        while (renderer.statistics().samples < portion) {
            renderer.render_frame();
            if (!frame_done()) return false;
        }
        const Image result = renderer.read(View::result), direct = renderer.read(View::direct);
        add(half.indirect, half.samples, difference(result, direct), portion);
        add(half.result, half.samples, result, portion);
        half.samples += portion;
        portion_done();
    }
}

}  // namespace farfield
