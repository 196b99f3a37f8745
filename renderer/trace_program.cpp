#include "renderer/trace_program.h"

#include "renderer/records.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <regex>

namespace farfield {
namespace {

constexpr std::size_t cache_size = 64;
constexpr int generated_file = 2;  // its number in #line directives

/// The key of the cache: a live and a specialised program never share code, so the code itself is enough.
std::string cache_key(const GeneratedScene& generated) { return generated.key; }

/// The driver's log with the name of the node whose line it complains about. Logs name lines as 2:17(8) or 2(17).
std::string explain(const Scene& scene, const GeneratedScene& generated, const std::string& log) {
    static const std::regex position(R"((?:^|\n)[^\n]*?\b2[:(](\d+))");
    std::smatch match;
    if (!std::regex_search(log, match, position)) return log;
    const std::size_t line = static_cast<std::size_t>(std::stoul(match[1])) - 1;
    if (line >= generated.line_nodes.size()) return log;
    const Node* node = find_node(scene, generated.line_nodes[line]);
    return node ? fmt::format("node \"{}\": {}", display_name(*node), log) : log;
}

}  // namespace

std::string trace_source(const GeneratedScene& generated, Tier tier) {
    const std::string kernel = shader_source("trace.glsl");
    // The scene goes between the common part and the kernel's own, which starts at the second #line directive.
    const std::size_t own = kernel.rfind("#line 1 0\n");
    std::string text = kernel.substr(0, own);
    if (tier == Tier::live)
        text += fmt::format(
            "layout(std140, binding = 1) uniform Parameters {{ vec4 parameter_block[{}]; }};\n"
            "float parameter(int i) {{ return parameter_block[i >> 2][i & 3]; }}\n",
            (generated.parameters.size() + 3) / 4);
    return text + fmt::format("#line 1 {}\n", generated_file) + generated.text + kernel.substr(own);
}

TracePrograms::TracePrograms() { parameters_.resize(0); }

bool TracePrograms::has(const Scene& scene, Tier tier) const {
    const std::string key = cache_key(generate(scene, tier));
    return std::any_of(cache_.begin(), cache_.end(), [&](const Entry& entry) { return entry.key == key; });
}

void TracePrograms::select(const Scene& scene, Tier tier) {
    const GeneratedScene generated = generate(scene, tier);
    const std::string key = cache_key(generated);
    const auto found = std::find_if(cache_.begin(), cache_.end(), [&](const Entry& entry) { return entry.key == key; });
    if (found != cache_.end()) {
        cache_.splice(cache_.begin(), cache_, found);
    } else {
        compile(scene, generated, tier);
    }
    current_ = &cache_.front().program;
    tier_ = tier;
    if (tier == Tier::live) parameters_.upload(std::span<const float>(generated.parameters));
}

const gl::Program& TracePrograms::compile(const Scene& scene, const GeneratedScene& generated, Tier tier) {
    const auto start = std::chrono::steady_clock::now();
    gl::Program program;
    try {
        program = gl::Program("the scene's trace kernel", trace_source(generated, tier));
    } catch (const ShaderError& error) {
        throw ShaderError(explain(scene, generated, error.what()));
    }
    // Drivers compile compute shaders at their first dispatch: have that now, with no ray to trace.
    program.set("ray_count", 0u);
    program.run(std::size_t{1});
    glFinish();
    compile_milliseconds_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    ++(tier == Tier::live ? live_compiles_ : specialised_compiles_);
    cache_.push_front({generated.key, std::move(program)});
    if (cache_.size() > cache_size) cache_.pop_back();
    return cache_.front().program;
}

void TracePrograms::trace(std::size_t count, bool surfaces, bool counting) const {
    parameters_.bind_uniform(1);
    current_->set("ray_count", static_cast<unsigned>(count));
    current_->set("surface_wanted", surfaces ? 1 : 0);
    current_->set("counting", counting ? 1 : 0);
    current_->run(count);
}

}  // namespace farfield
