#include "renderer/trace_program.h"

#include "renderer/context.h"
#include "renderer/records.h"
#include "sdf/local_scene.h"
#include "sdf/scene_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <regex>
#include <utility>

namespace farfield {
namespace {

constexpr std::size_t cache_size = 128;          // programs beside those of the scenes that were asked for last
constexpr std::size_t remembered_divisions = 6;  // two of each program that an edit asks for
constexpr int generated_file = 2;                // its number in #line directives

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

/// Of loops in an invocation: llvmpipe ends them after 65,535, see march.glsl.
constexpr std::uint64_t most_turns = 60000;
/// Of the tracer's own loops for each march as far as the pause.
constexpr std::uint64_t turns_of_march = 6;
/// Of these for the walks of an invocation's rays through a family: lanes wait for each other, and some rays walk
/// longer than BoxTree::longest_walk. With 1 to 60 rays each times differ by less than 10 %.
constexpr std::uint64_t safe_turns = 4096;

/// Evaluations of a ray. Flat fields (GeneratedScene::flat) need more, see march.glsl.
std::uint64_t march_limit(const GeneratedScene& generated) { return generated.marches_flat ? 512 : 256; }

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

/// Whether both come to the same programs.
bool same_content(const Scene& a, const Scene& b) {
    return a.root == b.root && a.definitions == b.definitions && local_origin(a.camera) == local_origin(b.camera) &&
           std::equal(a.materials.begin(), a.materials.end(), b.materials.begin(), b.materials.end(),
                      [](const Material& x, const Material& y) { return x.id == y.id; });
}

/// Leaves out the nodes with these ids, which are sorted, and what is below them.
void remove(Node& node, const std::vector<Id>& ids) {
    std::erase_if(node.children,
                  [&](const Node& child) { return std::binary_search(ids.begin(), ids.end(), child.id); });
    for (Node& child : node.children) remove(child, ids);
}

/// The numbers of a family's member as its code reads them; no scene else has any.
std::string members_source(std::size_t vectors) {
    std::string variables, loads;
    for (std::size_t i = 0; i < vectors; ++i) {
        variables += fmt::format("vec4 member{};\n", i);
        loads += fmt::format("    member{} = load(member_texels, {}u * member + {}u);\n", i, vectors, i);
    }
    if (vectors > 0)
        variables += fmt::format("layout(binding = {}) uniform usamplerBuffer member_texels;\n",
                                 binding::first_texels + binding::members);
    return fmt::format("{}void load_member(uint member) {{\n{}}}\n", variables, loads);
}

}  // namespace

std::string scene_kernel_source(const std::string& file, const GeneratedScene& generated, bool shares_rays) {
    std::string constants(shares_rays ? sharing : not_sharing);
    constants += fmt::format("#define claims_rays {}\n#define casts {}\n#define marches {}\n",
                             shares_rays && generated.loop_turns > 0 ? 1 : 0, generated.casts ? 1 : 0,
                             generated.marches ? 1 : 0);
    const std::string kernel = shader_source(file, constants);
    // The scene goes between the common part and the kernel's own, which starts at the second #line directive.
    const std::size_t own = kernel.rfind("#line 1 0\n");
    const bool marches = file.starts_with("trace");
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
    text += fmt::format("void load_parameters() {{\n{}}}\nconst bool flat_field = {};\n", load,
                        marches ? generated.marches_flat : generated.flat);
    if (marches)
        text +=
            fmt::format("const int usual_limit = {};\nconst uint most_turns = {}u;\nconst uint turns_of_march = {}u;\n",
                        march_limit(generated), most_turns, turns_of_march);
    text += members_source(generated.member_vectors);
    // Drivers spend a good part of their time on functions that nothing calls.
    const std::string_view all = generated.text;
    const auto from = [&](std::size_t begin, std::size_t length) {
        const auto line = 1 + std::count(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(begin), '\n');
        return fmt::format("#line {} {}\n{}", line, generated_file, all.substr(begin, length));
    };
    text += from(0, generated.surface_at);
    if (kernel.find("scene_surface(") != std::string::npos)
        text += from(generated.surface_at, generated.march_at - generated.surface_at);
    if (marches || kernel.find("scene_march(") != std::string::npos)
        text += from(generated.march_at, std::string::npos);
    if (marches) text += fmt::format("#line 1 3\n{}", shader_text("march.glsl"));
    return text + kernel.substr(own);
}

// On a GPU rays are many and lanes need work at once. On llvmpipe 32 to 128 rays and pauses of 3 to 6 evaluations
// differ by less than 5 %, and 16 rays lose 6 % in the colonnade.
TracePrograms::TracePrograms() {
    queue_.resize(sizeof(std::uint32_t));
    if (renders_on_cpu() && has_extension("GL_ARB_shader_ballot")) schedule_ = {64, 4, true};
}

TracePrograms::Cache::const_iterator TracePrograms::find(const std::string& key) const {
    return std::find_if(cache_.begin(), cache_.end(), [&](const auto& entry) { return entry->key == key; });
}

const TracePrograms::Codes& TracePrograms::codes(const Scene& scene, Tier tier, Id tuned) const {
    if (tuned != 0 && !find_node(scene, tuned)) tuned = 0;
    const auto known = std::find_if(divisions_.begin(), divisions_.end(), [&](const Division& d) {
        return d.tier == tier && d.tuned == tuned && same_content(d.scene, scene);
    });
    if (known != divisions_.end()) {
        divisions_.splice(divisions_.begin(), divisions_, known);
    } else {
        Codes codes = divide(scene, tier, tuned);
        divisions_.push_front({scene, tier, tuned, std::move(codes)});
        if (divisions_.size() > remembered_divisions) divisions_.pop_back();
    }
    return divisions_.front().codes;
}

TracePrograms::Codes TracePrograms::divide(const Scene& scene, Tier tier, Id tuned) const {
    Scene rest = local_scene(scene, tuned);
    Codes families;
    if (tier == Tier::specialised && expanded_node_count(rest) > largest_whole_scene)
        families = take_families(rest, tuned);
    const bool by_distance = marches_by_distance(rest);
    Codes codes;
    if (families.empty() || !is_empty(rest, rest.root))
        for (Scene& part : scene_parts(rest)) {
            const Id tuned_here = find_node(part, tuned) ? tuned : 0;
            std::shared_ptr<const Code> code;
            for (const Division& division : divisions_)
                for (const auto& other : division.codes)
                    if (!code && !other->members && other->tier == tier && other->tuned == tuned_here &&
                        other->by_distance == by_distance && same_content(other->part, part))
                        code = other;
            if (!code) {
                GeneratedScene generated = generate(part, tier, tuned_here, by_distance);
                code = std::make_shared<const Code>(
                    Code{std::move(part), tier, tuned_here, by_distance, std::move(generated), {}});
            }
            codes.push_back(std::move(code));
        }
    codes.insert(codes.end(), families.begin(), families.end());
    return codes;
}

TracePrograms::Codes TracePrograms::take_families(Scene& scene, Id tuned) const {
    Codes families;
    std::vector<Id> taken;
    for (Family& family : families_.find(scene, tuned)) {
        BoxTree boxes = make_box_tree(family.bounds);
        if (schedule_.shares_rays && (boxes.longest_walk > safe_turns || family.code.loop_turns > 0)) continue;
        taken.insert(taken.end(), family.members.begin(), family.members.end());
        families.push_back(std::make_shared<const Code>(
            Code{Scene(), Tier::specialised, 0, false, std::move(family.code),
                 Members{family.members.size(), std::move(family.numbers), std::move(boxes)}}));
    }
    std::sort(taken.begin(), taken.end());
    remove(scene.root, taken);
    return families;
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
    compile_next(*missing.front(), scene);
    std::erase_if(missing, is_there);  // others may have the same code
    return static_cast<int>(missing.size());
}

void TracePrograms::select(const Scene& scene, Tier tier, Id tuned) {
    check_size(scene);
    std::vector<Part> parts;
    bool compiled = false;
    unsigned first = 0;
    for (const auto& code : codes(scene, tier, tuned)) {
        const GeneratedScene& generated = code->generated;
        const auto found = find(generated.key);
        if (found == cache_.end()) {
            if (!std::exchange(compiled, true) && !is_begun(*code)) compile_milliseconds_ = 0.0;
            while (find(generated.key) == cache_.end()) compile_next(*code, scene);
        } else {
            cache_.splice(cache_.begin(), cache_, found);
        }
        Part& part = parts.emplace_back();
        part.programs = cache_.front();
        part.code = code;
        part.first = first;
        part.parameters.upload(std::span<const float>(generated.parameters));
        if (code->members) {
            part.numbers.upload(std::span<const float>(code->members->numbers));
            part.boxes.upload(std::span<const BoxTree::Node>(code->members->boxes.nodes));
        }
        // Hits lie up to an epsilon before the surface; rays that run along the bounds must not lose them to rounding.
        const Box& marched = generated.marched_bounds;
        part.bounds = {marched.low - 0.01f * (1.0f + glm::abs(marched.low)),
                       marched.high + 0.01f * (1.0f + glm::abs(marched.high))};
        first += static_cast<unsigned>(part.members());
    }
    current_ = std::move(parts);
}

bool TracePrograms::is_begun(const Code& code) const { return begun_ && begun_->key == code.generated.key; }

void TracePrograms::compile_next(const Code& code, const Scene& scene) {
    if (is_begun(code))
        compile_surface(code, scene);
    else
        compile_march(code, scene);
}

void TracePrograms::compile_march(const Code& code, const Scene& scene) {
    const GeneratedScene& generated = code.generated;
    GLint largest_block = 0;
    glGetIntegerv(GL_MAX_UNIFORM_BLOCK_SIZE, &largest_block);
    if (generated.parameters.size() * sizeof(float) > static_cast<std::size_t>(largest_block))
        throw ShaderError(fmt::format("{} live parameters do not fit into this driver's uniform block of {} bytes",
                                      generated.parameters.size(), largest_block));
    gl::Program march =
        compiled(code, scene, "the scene's trace kernel", code.members ? "trace_family.glsl" : "trace.glsl");
    begun_ = Entry{generated.key, std::move(march), {}};
}

/// Of the part that has been begun.
void TracePrograms::compile_surface(const Code& code, const Scene& scene) {
    begun_->surface = compiled(code, scene, "the scene's surface kernel", "surface.glsl");
    ++compiles_;
    structures_.insert(
        std::hash<std::string>()(code.members ? code.generated.key : generate(code.part, Tier::live).key));
    cache_.push_front(std::make_shared<const Entry>(*std::exchange(begun_, {})));
    std::size_t most = cache_size;
    for (const Division& division : divisions_) most += division.codes.size();
    while (cache_.size() > most) cache_.pop_back();
}

gl::Program TracePrograms::compiled(const Code& code, const Scene& scene, const char* name, const char* file) {
    const auto start = std::chrono::steady_clock::now();
    std::optional<gl::Program> program;
    try {
        program.emplace(name, scene_kernel_source(file, code.generated, schedule_.shares_rays));
    } catch (const ShaderError& error) {
        throw ShaderError(explain(scene, code.generated, error.what()));
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

void TracePrograms::bind(const Part& part) {
    part.parameters.bind_uniform(binding::parameters);
    if (!part.code->members) return;
    part.numbers.bind_texels(binding::first_texels + binding::members, GL_RGBA32UI);
    part.boxes.bind_texels(binding::first_texels + binding::boxes, GL_RGBA32UI);
}

void TracePrograms::run(const gl::Program& kernel, std::size_t part, std::size_t count) const {
    bind(current_[part]);
    kernel.set("ray_count", static_cast<unsigned>(count));
    kernel.set("member_count", static_cast<unsigned>(current_[part].members()));
    kernel.run(count);
}

bool TracePrograms::claims_rays(const Part& part) const {
    return schedule_.shares_rays && part.code->generated.loop_turns > 0;
}

TracePrograms::Turns TracePrograms::turns(const Part& part) const {
    const GeneratedScene& generated = part.code->generated;
    const std::uint64_t each = 1 + std::min(generated.loop_turns, most_turns);
    const auto pause = static_cast<std::uint64_t>(schedule_.pause);
    const std::uint64_t march = pause * each + turns_of_march;
    return {each, march, std::min((march_limit(generated) / pause + 1) * march, most_turns)};
}

std::size_t TracePrograms::rays_each(std::size_t number, std::size_t count) const {
    const Part& part = current_[number];
    if (!part.code->members && !part.code->generated.marches) return 1;
    std::size_t most = claims_rays(part) ? 1 : schedule_.rays_each;
    if (const auto& members = part.code->members)
        most = std::min<std::size_t>(most, std::max<std::uint64_t>(safe_turns / members->boxes.longest_walk, 1));
    return std::clamp<std::size_t>(count / enough_invocations, 1, most);
}

std::size_t TracePrograms::claiming_evaluations(std::size_t number) const {
    const Part& part = current_[number];
    if (!claims_rays(part)) return 0;
    const Turns of = turns(part);
    return (most_turns - of.ray) / of.march * static_cast<std::size_t>(schedule_.pause);
}

void TracePrograms::march(std::size_t number, std::size_t count, bool any_hit) const {
    const Part& part = current_[number];
    const gl::Program& march = part.programs->march;
    const std::size_t each = rays_each(number, count);
    bind(part);
    march.set("ray_count", static_cast<unsigned>(count));
    if (claims_rays(part)) {
        queue_.clear();
        queue_.bind_storage(binding::queue);
        march.set("turns_each", static_cast<unsigned>(turns(part).evaluation));
        march.set("turns_of_ray", static_cast<unsigned>(turns(part).ray));
    } else if (schedule_.shares_rays) {
        march.set("rays_each", static_cast<unsigned>(each));
    }
    march.set("pause", schedule_.pause);
    march.set("part", part.first);
    march.set("any_hit", any_hit ? 1 : 0);
    if (part.code->members) {
        march.set("node_count", static_cast<unsigned>(part.code->members->boxes.size));
    } else {
        march.set("scene_low", part.bounds.low);
        march.set("scene_high", part.bounds.high);
    }
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
        surface.set("part", current_[part].first);
        run(surface, part, count);
    }
}

std::vector<gl::Program> TracePrograms::make_kernels(const char* file) const {
    std::vector<gl::Program> kernels;
    for (const Part& part : current_) kernels.emplace_back(file, scene_kernel_source(file, part.code->generated));
    return kernels;
}

}  // namespace farfield
