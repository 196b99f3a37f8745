#include "renderer/trace_program.h"

#include "renderer/context.h"
#include "renderer/records.h"
#include "sdf/local_scene.h"
#include "sdf/scene_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <regex>
#include <utility>

namespace farfield {
namespace {

constexpr std::size_t cache_size = 128;      // programs beside those of the scenes that were asked for last
constexpr std::size_t remembered_codes = 6;  // of scenes: two of each program that an edit asks for
constexpr int generated_file = 2;            // its number in #line directives

/// Larger scenes are refused: llvmpipe took 33 s to compile 10,500 nodes.
constexpr std::uint64_t largest_program = 20000;

void check_size(const Scene& scene) {
    const std::uint64_t count = expanded_node_count(scene);
    if (count > largest_program)
        throw ShaderError(
            fmt::format("the scene comes to {} nodes, instances counted with what they show; more than {} are not "
                        "compiled, because "
                        "drivers need minutes for such programs",
                        count, largest_program));
}

/// So many parameters are copied to private variables before the march, which makes them half as fast as literals; with
/// more the copies spill and the driver compiles for seconds, so that they are read from the buffer, 8 times slower
/// than literals (measured on llvmpipe: 136 parameters 2.1 x against 8.4 x the frame time).
constexpr std::size_t most_copied_parameters = 1024;

/// In front of kernels, see trace.glsl.
constexpr std::string_view sharing =
    "#extension GL_ARB_shader_ballot : require\n#extension GL_ARB_gpu_shader_int64 : require\n#define shares_rays 1\n";
constexpr std::string_view not_sharing = "#define shares_rays 0\n";

/// A dispatch keeps all cores busy with so many groups.
constexpr std::size_t enough_invocations = 1024;

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

/// What programs are made of.
std::vector<Scene> local_parts(const Scene& scene, Id tuned) {
    return local_origin(scene.camera) == glm::vec3(0.0f) ? scene_parts(scene) : scene_parts(local_scene(scene, tuned));
}

/// llvmpipe ends all loops of an invocation once they have come to 65,535 turns together, and with them the rays that
/// are left. The tracer's own come to 9,000 at most for 16 rays; a ray that evaluates loops 512 times needs an
/// invocation for itself.
bool has_loops(std::string_view code) {
    for (auto at = code.find("for"); at != std::string_view::npos; at = code.find("for", at + 1)) {
        const auto is_name = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
        const auto next = code.find_first_not_of(" \t\n", at + 3);
        if ((at == 0 || !is_name(code[at - 1])) && next != std::string_view::npos && code[next] == '(') return true;
    }
    return false;
}

}  // namespace

std::string scene_kernel_source(const std::string& file, const GeneratedScene& generated, bool shares_rays) {
    const std::string kernel = shader_source(file, shares_rays ? sharing : not_sharing);
    // The scene goes between the common part and the kernel's own, which starts at the second #line directive.
    const std::size_t own = kernel.rfind("#line 1 0\n");
    const std::size_t count = generated.parameters.size();
    const bool copied = count <= most_copied_parameters;
    std::string text = kernel.substr(0, own), load;
    if (count > 0)
        text += fmt::format("layout(std140, binding = {}) uniform Parameters {{ vec4 parameter_block[{}]; }};\n",
                            binding::parameters, (count + 3) / 4);
    if (count > 0 && copied) {
        text +=
            fmt::format("float parameter_copy[{}];\nfloat parameter(int i) {{ return parameter_copy[i]; }}\n", count);
        for (std::size_t i = 0; i < count; ++i)
            load += fmt::format("    parameter_copy[{}] = parameter_block[{}][{}];\n", i, i / 4, i % 4);
    } else if (count > 0) {
        text += "float parameter(int i) { return parameter_block[i >> 2][i & 3]; }\n";
    }
    text += fmt::format("void load_parameters() {{\n{}}}\nconst bool flat_field = {};\n", load, generated.flat);
    // Drivers spend a good part of their time on functions that nothing calls.
    const std::string_view all = generated.text;
    const auto from = [&](std::size_t begin, std::size_t length) {
        const auto line = 1 + std::count(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(begin), '\n');
        return fmt::format("#line {} {}\n{}", line, generated_file, all.substr(begin, length));
    };
    text += from(0, generated.surface_at);
    if (kernel.find("scene_surface(") != std::string::npos)
        text += from(generated.surface_at, generated.march_at - generated.surface_at);
    if (kernel.find("scene_march(") != std::string::npos) text += from(generated.march_at, std::string::npos);
    return text + kernel.substr(own);
}

// On a GPU rays are many and lanes need work at once. On llvmpipe 32 to 128 rays and pauses of 3 to 6 evaluations
// differ by less than 5 %, and 16 rays lose 6 % in the colonnade.
TracePrograms::TracePrograms() {
    if (renders_on_cpu() && has_extension("GL_ARB_shader_ballot")) schedule_ = {64, 4, true};
}

TracePrograms::Cache::const_iterator TracePrograms::find(const std::string& key) const {
    return std::find_if(cache_.begin(), cache_.end(), [&](const auto& entry) { return entry->key == key; });
}

TracePrograms::Codes TracePrograms::codes(const Scene& scene, Tier tier, Id tuned) const {
    const bool by_distance = marches_by_distance(scene);
    const auto same_content = [](const Scene& a, const Scene& b) {
        return a.root == b.root && a.definitions == b.definitions &&
               std::equal(a.materials.begin(), a.materials.end(), b.materials.begin(), b.materials.end(),
                          [](const Material& x, const Material& y) { return x.id == y.id; });
    };
    Codes codes;
    for (Scene& part : local_parts(scene, tuned)) {
        const Id tuned_here = find_node(part, tuned) ? tuned : 0;
        std::shared_ptr<const Code> code;
        for (const Codes& others : codes_)
            for (const auto& other : others)
                if (!code && other->tier == tier && other->tuned == tuned_here && other->by_distance == by_distance &&
                    same_content(other->part, part))
                    code = other;
        if (!code) {
            GeneratedScene generated = generate(part, tier, tuned_here, by_distance);
            code = std::make_shared<const Code>(
                Code{std::move(part), tier, tuned_here, by_distance, std::move(generated)});
        }
        codes.push_back(std::move(code));
    }
    codes_.insert(codes_.begin(), codes);
    if (codes_.size() > remembered_codes) codes_.pop_back();
    return codes;
}

int TracePrograms::missing(const Scene& scene, Tier tier, Id tuned) const {
    if (expanded_node_count(scene) > largest_program) return 1;
    const Codes all = codes(scene, tier, tuned);
    return static_cast<int>(std::count_if(all.begin(), all.end(),
                                          [&](const auto& code) { return find(code->generated.key) == cache_.end(); }));
}

int TracePrograms::compile_one(const Scene& scene, Tier tier, Id tuned) {
    check_size(scene);
    Codes missing = codes(scene, tier, tuned);
    const auto is_there = [&](const auto& code) { return find(code->generated.key) != cache_.end(); };
    std::erase_if(missing, is_there);
    if (missing.empty()) return 0;
    if (!is_begun(*missing.front())) compile_milliseconds_ = 0.0;
    compile_next(*missing.front());
    std::erase_if(missing, is_there);  // others may have the same code
    return static_cast<int>(missing.size());
}

void TracePrograms::select(const Scene& scene, Tier tier, Id tuned) {
    check_size(scene);
    std::vector<Part> parts;
    bool compiled = false;
    for (const auto& code : codes(scene, tier, tuned)) {
        const GeneratedScene& generated = code->generated;
        const auto found = find(generated.key);
        if (found == cache_.end()) {
            if (!std::exchange(compiled, true) && !is_begun(*code)) compile_milliseconds_ = 0.0;
            while (find(generated.key) == cache_.end()) compile_next(*code);
        } else {
            cache_.splice(cache_.begin(), cache_, found);
        }
        Part& part = parts.emplace_back();
        part.programs = cache_.front();
        part.code = code;
        part.parameters.upload(std::span<const float>(generated.parameters));
        // Hits lie up to an epsilon before the surface; rays that run along the bounds must not lose them to rounding.
        part.bounds = {generated.bounds.low - 0.01f * (1.0f + glm::abs(generated.bounds.low)),
                       generated.bounds.high + 0.01f * (1.0f + glm::abs(generated.bounds.high))};
    }
    current_ = std::move(parts);
}

bool TracePrograms::is_begun(const Code& code) const { return begun_ && begun_->key == code.generated.key; }

void TracePrograms::compile_next(const Code& code) {
    if (is_begun(code))
        compile_surface(code);
    else
        compile_march(code);
}

void TracePrograms::compile_march(const Code& code) {
    const GeneratedScene& generated = code.generated;
    GLint largest_block = 0;
    glGetIntegerv(GL_MAX_UNIFORM_BLOCK_SIZE, &largest_block);
    if (generated.parameters.size() * sizeof(float) > static_cast<std::size_t>(largest_block))
        throw ShaderError(fmt::format("{} live parameters do not fit into this driver's uniform block of {} bytes",
                                      generated.parameters.size(), largest_block));
    gl::Program march = compiled(code, "the scene's trace kernel", "trace.glsl");
    // Of what the march calls; the function for materials is none of that.
    const bool loops = has_loops(std::string_view(generated.text).substr(0, generated.surface_at)) ||
                       has_loops(std::string_view(generated.text).substr(generated.march_at));
    begun_ = Entry{generated.key, loops ? 1 : schedule_.rays_each, std::move(march), {}};
}

/// Of the part that has been begun.
void TracePrograms::compile_surface(const Code& code) {
    begun_->surface = compiled(code, "the scene's surface kernel", "surface.glsl");
    ++compiles_;
    structures_.insert(std::hash<std::string>()(generate(code.part, Tier::live).key));
    cache_.push_front(std::make_shared<const Entry>(*std::exchange(begun_, {})));
    std::size_t most = cache_size;
    for (const Codes& parts : codes_) most += parts.size();
    while (cache_.size() > most) cache_.pop_back();
}

gl::Program TracePrograms::compiled(const Code& code, const char* name, const char* file) {
    const auto start = std::chrono::steady_clock::now();
    std::optional<gl::Program> program;
    try {
        program.emplace(name, scene_kernel_source(file, code.generated, schedule_.shares_rays));
    } catch (const ShaderError& error) {
        throw ShaderError(explain(code.part, code.generated, error.what()));
    }
    // Drivers compile compute shaders at their first dispatch: have that now, with no ray to trace.
    gl::Buffer parameters("parameters");
    parameters.upload(std::span<const float>(code.generated.parameters));
    parameters.bind_uniform(binding::parameters);
    program->set("ray_count", 0u);
    program->run(std::size_t{1});
    glFinish();
    compile_milliseconds_ +=
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    return std::move(*program);
}

void TracePrograms::run(const gl::Program& kernel, std::size_t part, std::size_t count) const {
    current_[part].parameters.bind_uniform(binding::parameters);
    kernel.set("ray_count", static_cast<unsigned>(count));
    kernel.run(count);
}

std::size_t TracePrograms::rays_each(std::size_t part, std::size_t count) const {
    return std::clamp<std::size_t>(count / enough_invocations, 1, current_[part].programs->rays_each);
}

void TracePrograms::march(std::size_t part, std::size_t count, bool any_hit) const {
    const auto& [programs, code, parameters, bounds] = current_[part];
    const gl::Program& march = programs->march;
    const std::size_t each = rays_each(part, count);
    parameters.bind_uniform(binding::parameters);
    march.set("ray_count", static_cast<unsigned>(count));
    if (schedule_.shares_rays) march.set("rays_each", static_cast<unsigned>(each));
    march.set("pause", schedule_.pause);
    march.set("part", static_cast<unsigned>(part));
    march.set("any_hit", any_hit ? 1 : 0);
    march.set("scene_low", bounds.low);
    march.set("scene_high", bounds.high);
    march.run((count + each - 1) / each);
}

void TracePrograms::count(std::size_t rays) const {
    count_.set("ray_count", static_cast<unsigned>(rays));
    count_.run(rays);
}

void TracePrograms::trace(std::size_t count, bool surfaces, bool counting) const {
    for (std::size_t part = 0; part < current_.size(); ++part) march(part, count, !surfaces);
    if (counting) this->count(count);
    for (std::size_t part = 0; surfaces && part < current_.size(); ++part) {
        const gl::Program& surface = current_[part].programs->surface;
        surface.set("part", static_cast<unsigned>(part));
        run(surface, part, count);
    }
}

std::vector<gl::Program> TracePrograms::make_kernels(const char* file) const {
    std::vector<gl::Program> kernels;
    for (const Part& part : current_) kernels.emplace_back(file, scene_kernel_source(file, part.code->generated));
    return kernels;
}

}  // namespace farfield
