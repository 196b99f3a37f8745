#include "renderer/reference_store.h"

#include "sdf/user_folder.h"

#include <fmt/format.h>

#include <charconv>

namespace farfield {
namespace {

namespace fs = std::filesystem;

constexpr int most = 1'000'000'000;  // samples; that two of them can be added
constexpr const char* half_names[] = {"a", "b"};

int whole_attribute(const fs::path& file, const std::string& name) {
    const std::string text = read_attribute(file, name);
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < 1 || value > most)
        throw ImageError(
            fmt::format("{}: {} is \"{}\", expected a number between 1 and {}", file.string(), name, text, most));
    return value;
}

Image whole_layer(const fs::path& file, const std::string& layer, glm::ivec2 size) {
    Image image = read_linear(file, layer);
    if (image.size != size)
        throw ImageError(fmt::format("{}: {} x {} pixels, expected {} x {}", file.string(), image.size.x, image.size.y,
                                     size.x, size.y));
    if (count_invalid(image) > 0) throw ImageError(fmt::format("{}: values that are not finite", file.string()));
    return image;
}

}  // namespace

fs::path ReferenceStore::user_folder() {
    const fs::path folder = farfield::user_folder("XDG_CACHE_HOME", ".cache");
    return folder.empty() ? folder : folder / "references";
}

Reference ReferenceStore::load(const std::string& key, glm::ivec2 size, std::string& problem) const {
    problem.clear();
    const fs::path from = file(key);
    std::error_code ignored;
    if (folder_.empty() || !fs::exists(from, ignored)) return {};
    try {
        if (read_attribute(from, "farfield:key") != key)
            throw ImageError(fmt::format("{}: of another scene than its name says", from.string()));
        Reference reference;
        for (std::size_t i = 0; i < 2; ++i) {
            const std::string name = half_names[i];
            reference.halves[i] = {whole_attribute(from, "farfield:samples." + name),
                                   whole_layer(from, name + ".indirect", size),
                                   whole_layer(from, name + ".result", size)};
        }
        return reference;
    } catch (const ImageError& error) {
        problem = fmt::format("{}; the reference is made again", error.what());
        return {};
    }
}

void ReferenceStore::save(const std::string& key, const Reference& reference) const {
    if (folder_.empty() || reference.halves[1].samples == 0) return;
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error) throw ImageError(fmt::format("{}: cannot be made: {}", folder_.string(), error.message()));
    Attributes attributes{{"farfield:key", key}};
    std::vector<Layer> layers;
    for (std::size_t i = 0; i < 2; ++i) {
        const ReferenceHalf& half = reference.halves[i];
        const std::string name = half_names[i];
        attributes["farfield:samples." + name] = std::to_string(half.samples);
        layers.push_back({name + ".indirect", half.indirect});
        layers.push_back({name + ".result", half.result});
    }
    write_exr(file(key), layers, attributes);
}

}  // namespace farfield
