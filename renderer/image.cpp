#include "renderer/image.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace farfield {
namespace {

namespace fs = std::filesystem;

/// Writes through a temporary file of the same folder and type.
void write(const fs::path& file, const OIIO::ImageSpec& spec, OIIO::TypeDesc type, const void* data) {
    fs::path temporary = file;
    temporary.replace_filename(fmt::format(".{}.{}{}", file.stem().string(), ::getpid(), file.extension().string()));
    const auto fail = [&](const std::string& why) {
        std::error_code ignored;
        fs::remove(temporary, ignored);
        throw ImageError(fmt::format("{}: cannot be written: {}", file.string(), why));
    };
    const auto output = OIIO::ImageOutput::create(temporary.string());
    if (!output) fail(OIIO::geterror());
    if (!output->open(temporary.string(), spec)) fail(output->geterror());
    if (!output->write_image(type, data)) fail(output->geterror());
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

}  // namespace

void write_exr(const fs::path& file, const std::vector<Layer>& layers) {
    const glm::ivec2 size = layers.at(0).image.size;
    const int channels = static_cast<int>(layers.size()) * 3;
    OIIO::ImageSpec spec(size.x, size.y, channels, OIIO::TypeDesc::FLOAT);
    spec.attribute("compression", "zip");
    spec.attribute("oiio:ColorSpace", "Linear");
    spec.channelnames.clear();
    std::vector<float> data(static_cast<std::size_t>(size.x) * size.y * channels);
    for (std::size_t layer = 0; layer < layers.size(); ++layer) {
        const std::string prefix = layers[layer].name.empty() ? "" : layers[layer].name + ".";
        for (const char* channel : {"R", "G", "B"}) spec.channelnames.push_back(prefix + channel);
        const std::vector<float>& from = layers[layer].image.pixels;
        for (std::size_t pixel = 0; pixel < from.size() / 3; ++pixel)
            std::copy_n(&from[pixel * 3], 3, &data[pixel * channels + layer * 3]);
    }
    write(file, spec, OIIO::TypeDesc::FLOAT, data.data());
}

void write_display(const fs::path& file, glm::ivec2 size, const std::vector<unsigned char>& rgb) {
    OIIO::ImageSpec spec(size.x, size.y, 3, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    write(file, spec, OIIO::TypeDesc::UINT8, rgb.data());
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
