#include "renderer/image.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <array>
#include <cmath>
#include <functional>
#include <string_view>

namespace farfield {
namespace {

namespace fs = std::filesystem;

/// Rows begin to end - 1, all channels of a pixel together.
using Rows = std::function<const void*(int begin, int end)>;

/// Writes through a temporary file of the same folder and type, some rows at a time: a large picture has many channels.
void write(const fs::path& file, const OIIO::ImageSpec& spec, OIIO::TypeDesc type, const Rows& rows) {
    constexpr int at_once = 64;
    static std::atomic<unsigned> count = 0;  // threads may write one file: the small picture of a scene saved twice
    fs::path temporary = file;
    temporary.replace_filename(
        fmt::format(".{}.{}.{}{}", file.stem().string(), ::getpid(), ++count, file.extension().string()));
    const auto fail = [&](const std::string& why) {
        std::error_code ignored;
        fs::remove(temporary, ignored);
        throw ImageError(fmt::format("{}: cannot be written: {}", file.string(), why));
    };
    const auto output = OIIO::ImageOutput::create(temporary.string());
    if (!output) fail(OIIO::geterror());
    if (!output->open(temporary.string(), spec)) fail(output->geterror());
    for (int y = 0; y < spec.height; y += at_once) {
        const int end = std::min(y + at_once, spec.height);
        if (!output->write_scanlines(y, end, 0, type, rows(y, end))) fail(output->geterror());
    }
    if (!output->close()) fail(output->geterror());
    // The PNG writer says nothing of a full disk; a file that can be read has reached it.
    if (OIIO::ImageBuf written(temporary.string());
        std::string_view(output->format_name()) == "png" && !written.read(0, 0, true))
        fail("the disk may be full");
    std::error_code error;
    fs::rename(temporary, file, error);
    if (error) fail(error.message());
}

OIIO::ImageBuf as_buffer(const Image& image) {
    const OIIO::ImageSpec spec(image.size.x, image.size.y, 3, OIIO::TypeDesc::FLOAT);
    return OIIO::ImageBuf(spec, const_cast<float*>(image.pixels.data()));
}

/// "R" and "direct.R" are of the layers "" and "direct".
std::string_view layer_of(std::string_view channel) {
    const std::size_t dot = channel.rfind('.');
    return dot == channel.npos ? std::string_view() : channel.substr(0, dot);
}

std::string layer_names(const std::vector<std::string>& channels) {
    std::string names;
    for (const std::string& channel : channels) {
        const std::string_view layer = layer_of(channel);
        if (!channel.ends_with('R') || layer.empty()) continue;
        names += fmt::format("{}{}", names.empty() ? "" : ", ", layer);
    }
    return names.empty() ? "no layers" : "layers " + names;
}

float from_srgb(float v) { return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f); }

}  // namespace

void write_exr(const fs::path& file, const std::vector<Layer>& layers, const Attributes& attributes) {
    const glm::ivec2 size = layers.at(0).image.size;
    const int channels = static_cast<int>(layers.size()) * 3;
    OIIO::ImageSpec spec(size.x, size.y, channels, OIIO::TypeDesc::FLOAT);
    spec.attribute("compression", "zip");
    spec.attribute("oiio:ColorSpace", "Linear");
    for (const auto& [name, value] : attributes) spec.attribute(name, value);
    spec.channelnames.clear();
    for (const Layer& layer : layers)
        for (const char* channel : {"R", "G", "B"})
            spec.channelnames.push_back(layer.name.empty() ? channel : layer.name + "." + channel);
    std::vector<float> data;
    write(file, spec, OIIO::TypeDesc::FLOAT, [&](int begin, int end) {
        data.clear();
        for (std::size_t i = std::size_t{3} * begin * size.x; i < std::size_t{3} * end * size.x; i += 3)
            for (const Layer& layer : layers)
                data.insert(data.end(), &layer.image.pixels[i], &layer.image.pixels[i] + 3);
        return data.data();
    });
}

void write_display(const fs::path& file, glm::ivec2 size, const std::vector<unsigned char>& rgb) {
    OIIO::ImageSpec spec(size.x, size.y, 3, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    write(file, spec, OIIO::TypeDesc::UINT8, [&](int begin, int) { return &rgb[std::size_t{3} * begin * size.x]; });
}

Image read_image(const fs::path& file) {
    OIIO::ImageBuf buffer(file.string());
    if (!buffer.read(0, 0, true, OIIO::TypeDesc::FLOAT))
        throw ImageError(fmt::format("{}: cannot be read: {}", file.string(), buffer.geterror()));
    if (buffer.nchannels() < 3)
        throw ImageError(fmt::format("{}: has {} channels, expected three or more", file.string(), buffer.nchannels()));
    Image image;
    image.size = {buffer.spec().width, buffer.spec().height};
    image.pixels.resize(static_cast<std::size_t>(image.size.x) * image.size.y * 3);
    OIIO::ROI roi = buffer.roi();
    roi.chend = 3;
    buffer.get_pixels(roi, OIIO::TypeDesc::FLOAT, image.pixels.data());
    return image;
}

Image read_linear(const fs::path& file, std::string_view layer) {
    OIIO::ImageBuf buffer(file.string());
    if (!buffer.read(0, 0, true, OIIO::TypeDesc::FLOAT))
        throw ImageError(fmt::format("{}: cannot be read: {}", file.string(), buffer.geterror()));
    const OIIO::ImageSpec& spec = buffer.spec();
    Image image{{spec.width, spec.height}, std::vector<float>(static_cast<std::size_t>(spec.width) * spec.height * 3)};
    const std::string prefix = layer.empty() ? "" : std::string(layer) + ".";
    for (std::size_t i = 0; i < 3; ++i) {
        const int channel = spec.channelindex(prefix + std::array{"R", "G", "B"}[i]);
        if (channel < 0)
            throw ImageError(fmt::format("{}: has no channels {}R, {}G, {}B, but {}", file.string(), prefix, prefix,
                                         prefix, layer_names(spec.channelnames)));
        OIIO::ROI roi = buffer.roi();
        roi.chbegin = channel;
        roi.chend = channel + 1;
        std::vector<float> values(image.pixels.size() / 3);
        buffer.get_pixels(roi, OIIO::TypeDesc::FLOAT, values.data());
        for (std::size_t pixel = 0; pixel < values.size(); ++pixel) image.pixels[3 * pixel + i] = values[pixel];
    }
    if (!buffer.file_format_name().empty() && !buffer.nativespec().format.is_floating_point())
        std::transform(image.pixels.begin(), image.pixels.end(), image.pixels.begin(), from_srgb);
    return image;
}

std::string read_attribute(const fs::path& file, const std::string& name) {
    const auto input = OIIO::ImageInput::open(file.string());
    if (!input) throw ImageError(fmt::format("{}: cannot be read: {}", file.string(), OIIO::geterror()));
    return std::string(input->spec().get_string_attribute(name));
}

Image exposed(Image image, float exposure) {
    const float factor = std::exp2(exposure);
    for (float& v : image.pixels) v = std::clamp(v * factor, 0.0f, 1.0f);
    return image;
}

Image difference(const Image& a, const Image& b) {
    Image result = a;
    std::transform(a.pixels.begin(), a.pixels.end(), b.pixels.begin(), result.pixels.begin(), std::minus<>());
    return result;
}

Image resized(const Image& image, glm::ivec2 size) {
    if (image.size == size) return image;
    Image result{size, std::vector<float>(static_cast<std::size_t>(size.x) * size.y * 3)};
    OIIO::ImageBuf to = as_buffer(result);
    if (!OIIO::ImageBufAlgo::resample(to, as_buffer(image), true)) throw ImageError(to.geterror());
    return result;
}

Difference compare(const Image& a, const Image& b) {
    if (a.size != b.size)
        throw ImageError(fmt::format("images of {} x {} and {} x {} pixels cannot be compared", a.size.x, a.size.y,
                                     b.size.x, b.size.y));
    const OIIO::ImageBufAlgo::CompareResults results =
        OIIO::ImageBufAlgo::compare(as_buffer(a), as_buffer(b), 1e-3f, 1e-3f);
    return {results.rms_error, results.maxerror};
}

std::size_t count_invalid(const Image& image) {
    return static_cast<std::size_t>(
        std::count_if(image.pixels.begin(), image.pixels.end(), [](float v) { return !std::isfinite(v); }));
}

}  // namespace farfield
