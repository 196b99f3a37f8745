// The offline commands of the command line; each returns the exit status: 0 done, 1 failed while running, 2 wrong
// input.
#pragma once

#include "renderer/context.h"
#include "renderer/views.h"
#include "sdf/scene.h"

#include <glm/vec2.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace farfield {

class Progress;
class Renderer;

/// Throws std::invalid_argument for another extension (written in small letters) and ImageError where there is no such
/// folder: before a long render, not after it.
void check_output(const std::filesystem::path& file, std::initializer_list<std::string_view> extensions);

/// What a setting is called on the command line: "--ao-radius" for "ao_radius".
std::string option_name(std::string_view key);

/// Accumulates so many frames, or fewer: until `enough`, asked after each, says so. False, and says so, when the user
/// interrupts.
bool render_frames(Renderer& renderer, int frames, Progress& progress, const std::function<bool()>& enough = {});

/// Settings given on the command line; those not given are the scene's own.
struct Overrides {
    std::vector<std::pair<std::string, std::string>> values;  ///< key and text, as of the settings table
    /// Throws std::invalid_argument that names the option and what it takes.
    void apply(Settings& settings) const;
};

/// Loads a scene whose custom code may run: all of it with `trust_code`, otherwise what the user's list has. Throws
/// SceneFileError.
Scene load_trusted_scene(const std::filesystem::path& file, bool trust_code);

struct RenderOptions {
    std::filesystem::path scene;
    bool trust_code = false;
    std::vector<std::filesystem::path> outputs;
    glm::ivec2 size{768, 512};
    std::optional<int> frames;  ///< 16 by default, for a noise or a time as many as that takes
    float seconds = 0.0f;       ///< no further frame after so much time; 0: no end
    std::uint32_t seed = 0;
    View view = View::result;
    ContextKind context = ContextKind::automatic;
    Overrides overrides;
};
int run_render(const RenderOptions& options);

struct GlslOptions {
    std::filesystem::path scene;
    bool trust_code = false;
    bool live = false;
};
int run_glsl(const GlslOptions& options);

/// Prints the scene format's JSON Schema.
int run_schema();

}  // namespace farfield
