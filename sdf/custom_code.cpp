#include "sdf/custom_code.h"

#include "sdf/custom_compiler.h"
#include "sdf/fields.h"
#include "sdf/scene_format.h"
#include "sdf/shape_library.h"

#include <sha256.h>

#include <fmt/format.h>
#include <glslang/Include/intermediate.h>
#include <glslang/MachineIndependent/localintermediate.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <mutex>
#include <utility>

namespace farfield {
namespace {

constexpr std::string_view own_suffix = "own";  ///< marks names that the library has too
constexpr float largest_default_count = 1000.0f;
constexpr float steepest = 1e6f;

/// With signs in place of glslang's names of tokens, and without its stray spaces.
std::string readable(std::string message) {
    static const std::pair<const char*, const char*> names[] = {{"LEFT_BRACE", "{"},
                                                                {"RIGHT_BRACE", "}"},
                                                                {"LEFT_PAREN", "("},
                                                                {"RIGHT_PAREN", ")"},
                                                                {"LEFT_BRACKET", "["},
                                                                {"RIGHT_BRACKET", "]"},
                                                                {"SEMICOLON", ";"},
                                                                {"COMMA", ","},
                                                                {"EQUAL", "="},
                                                                {"IDENTIFIER", "a name"},
                                                                {"FLOATCONSTANT", "a number"},
                                                                {"INTCONSTANT", "a number"},
                                                                {"UINTCONSTANT", "a number"},
                                                                {"DOT", "."},
                                                                {"COLON", ":"},
                                                                {"QUESTION", "?"},
                                                                {"TYPE_NAME", "a type"},
                                                                {"$end", "the end of the code"}};
    for (const auto& [name, sign] : names) {
        const std::string whole = name;
        const auto is_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
        for (std::size_t at = message.find(whole); at != message.npos; at = message.find(whole, at + 1)) {
            const std::size_t end = at + whole.size();
            if ((at == 0 || !is_word(message[at - 1])) && (end == message.size() || !is_word(message[end])))
                message.replace(at, whole.size(), sign);
        }
    }
    std::string tidy;
    for (const char c : message) {
        const char last = tidy.empty() ? ' ' : tidy.back();
        if (c == ' ' && (last == ' ' || last == '(')) continue;
        if (c == ':' && last == ' ' && tidy.size() > 1) tidy.pop_back();
        tidy += c;
    }
    while (!tidy.empty() && tidy.back() == ' ') tidy.pop_back();
    return tidy;
}

/// From lines as "ERROR: 1:12: 'x' : undeclared identifier"; string 1 is the user's text.
std::vector<CodeError> read_log(std::string_view log, int lines) {
    constexpr std::string_view start = "ERROR: ";
    std::vector<CodeError> errors;
    while (!log.empty()) {
        const std::size_t end = std::min(log.find('\n'), log.size());
        std::string_view line = log.substr(0, end);
        log.remove_prefix(std::min(end + 1, log.size()));
        if (!line.starts_with(start)) continue;
        line.remove_prefix(start.size());
        int string = 0, number = 1;
        const char* const last = line.data() + line.size();
        const auto [colon, bad] = std::from_chars(line.data(), last, string);
        if (bad != std::errc() || colon == last || *colon != ':') continue;  // the number of errors
        const char* const rest = std::from_chars(colon + 1, last, number).ptr;
        std::string message(rest, last);
        if (message.starts_with(": ")) message.erase(0, 2);
        if (message.find("compilation terminated") != message.npos) continue;
        if (message.starts_with("'' : ")) message.erase(0, 5);
        const std::string mark = fmt::format("_{}'", own_suffix);
        for (std::size_t at = message.find(mark); at != message.npos; at = message.find(mark))
            message.replace(at, mark.size(), "'");
        errors.push_back({string == 1 ? std::clamp(number, 1, lines) : lines, readable(message)});
    }
    if (errors.empty()) errors.push_back({1, "the code does not compile"});
    return errors;
}

/// Constants of the global declarations by name, as floats.
std::map<std::string, std::vector<float>> global_values(TIntermNode* root) {
    std::map<std::string, std::vector<float>> values;
    glslang::TIntermAggregate* all = root->getAsAggregate();
    if (!all) return values;
    for (TIntermNode* part : all->getSequence()) {
        glslang::TIntermAggregate* objects = part ? part->getAsAggregate() : nullptr;
        if (!objects || objects->getOp() != glslang::EOpLinkerObjects) continue;
        for (TIntermNode* object : objects->getSequence())
            if (glslang::TIntermSymbol* symbol = object->getAsSymbolNode())
                for (int i = 0; i < symbol->getConstArray().size(); ++i) {
                    const glslang::TConstUnion& c = symbol->getConstArray()[i];
                    values[symbol->getName().c_str()].push_back(
                        c.getType() == glslang::EbtDouble ? static_cast<float>(c.getDConst())
                        : c.getType() == glslang::EbtInt  ? static_cast<float>(c.getIConst())
                        : c.getType() == glslang::EbtBool ? static_cast<float>(c.getBConst())
                                                          : 0.0f);
                }
    }
    return values;
}

/// Keys of a node in a scene file that no parameter can have.
bool is_reserved(std::string_view key) {
    for (const std::string_view taken :
         {format::kind, format::name, format::material, format::hidden, format::locked, format::children, format::code})
        if (key == taken) return true;
    for (const Parameter& parameter : info(NodeKind::custom).parameters)
        if (key == parameter.key) return true;
    const auto& transform = fields<Transform>();
    return std::any_of(transform.begin(), transform.end(),
                       [&](const Field<Transform>& field) { return key == field.parameter.key; });
}

Parameter described(const CustomUniform& uniform) {
    using P = ParameterType;
    Parameter parameter{"", "", P::number, uniform.unit};
    if (uniform.type == "int") parameter.type = P::integer;
    if (uniform.type == "bool") parameter.type = P::flag;
    if (uniform.type == "vec3") parameter.type = P::vector;
    if (uniform.type == "ivec3") parameter.type = P::count;
    if (uniform.type == "bvec3") parameter.type = P::flags;
    if (uniform.type == "int" || uniform.type == "ivec3")
        parameter.minimum = -largest_default_count, parameter.maximum = largest_default_count;
    if (uniform.has_range) parameter.minimum = uniform.minimum, parameter.maximum = uniform.maximum;
    if (uniform.type == "bool" || uniform.type == "bvec3") parameter.minimum = 0.0f, parameter.maximum = 1.0f;
    return parameter;
}

std::string declaration(const CustomUniform& uniform, const std::string& argument) {
    const bool plain = uniform.type == "float" || uniform.type == "vec3";
    return plain ? fmt::format("{} {{}} = {};", uniform.type, argument)
                 : fmt::format("{0} {{}} = {0}({1});", uniform.type, argument);
}

bool is_in_capitals(std::string_view name) {
    return name.size() > 1 && std::none_of(name.begin(), name.end(), [](unsigned char c) { return std::islower(c); });
}

/// glslang has state for the whole process; one text at a time is fast enough.
std::mutex& glslang_mutex() {
    static std::mutex mutex;
    static const bool initialised = glslang::InitializeProcess();
    (void)initialised;
    return mutex;
}

}  // namespace

CustomCode::CustomCode(std::string_view text) : text_(text) {
    char digits[SHA256_DIGEST_STRING_LENGTH];
    SHA256Data(reinterpret_cast<const std::uint8_t*>(text.data()), text.size(), digits);
    hash_ = digits;
}

CustomCode::Parsed CustomCode::parse(std::string_view text) {
    Parsed parsed;
    std::vector<CodeError>& errors = parsed.errors;
    const auto failed = [&] {
        std::stable_sort(errors.begin(), errors.end(), [](const auto& a, const auto& b) { return a.line < b.line; });
        return !errors.empty();
    };
    std::shared_ptr<CustomCode> code(new CustomCode(text));
    code->source_ = std::make_unique<CustomSource>(text, errors);
    if (failed()) return parsed;
    const CustomSource& source = *code->source_;

    Names clashing;
    for (const std::string& name : source.globals())
        if (!used_shapes(name).empty()) clashing.insert(name);
    const std::string library = "#version 430 core\n" + used_shapes(code->called());
    const std::string own = source.renamed(clashing, own_suffix);

    const std::lock_guard lock(glslang_mutex());
    glslang::TShader shader(EShLangCompute);
    const char* const strings[] = {library.c_str(), own.c_str()};
    shader.setStrings(strings, 2);
    if (!shader.parse(GetDefaultResources(), 430, ECoreProfile, false, false, EShMsgSuppressWarnings)) {
        errors = read_log(shader.getInfoLog(), source.lines());
        failed();
        return parsed;
    }
    TIntermNode* const root = shader.getIntermediate()->getTreeRoot();
    if (!root) errors.push_back({1, "there is no float sdf(vec3 p)"});
    if (failed()) return parsed;

    const auto globals = global_values(root);
    const auto value_of = [&](const std::string& name) {
        const auto found = globals.find(clashing.contains(name) ? fmt::format("{}_{}", name, own_suffix) : name);
        return found == globals.end() ? std::span<const float>() : std::span<const float>(found->second);
    };
    std::vector<CustomInput> inputs;
    for (const CustomUniform& uniform : source.uniforms()) {
        code->add_parameter(uniform, value_of(uniform.name), errors);
        const Parameter& parameter = code->parameters_.back();
        const std::string name =
            clashing.contains(uniform.name) ? fmt::format("{}_{}", uniform.name, own_suffix) : uniform.name;
        inputs.push_back({name, parameter.components(), parameter.minimum, parameter.maximum});
    }
    if (const std::span<const float> declared = value_of("lipschitz"); source.globals().contains("lipschitz")) {
        if (declared.size() == 1 && declared[0] > 0.0f && declared[0] <= steepest)
            code->lipschitz_ = declared[0];
        else
            errors.push_back({source.first_line("lipschitz"),
                              fmt::format("lipschitz is no constant number above 0 and at most {:g}", steepest)});
    }
    code->program_ = compile_custom(root, inputs, errors);
    if (failed()) return parsed;
    parsed.code = std::move(code);
    return parsed;
}

void CustomCode::add_parameter(const CustomUniform& uniform, std::span<const float> initial,
                               std::vector<CodeError>& errors) {
    Parameter& parameter = parameters_.emplace_back(described(uniform));
    parameter.key = strings_.emplace_back(uniform.name).c_str();
    parameter.tip = strings_.emplace_back(uniform.tip).c_str();
    for (std::size_t i = 0; i < initial.size() && i < 3; ++i) parameter.initial[static_cast<int>(i)] = initial[i];
    const auto fail = [&](const std::string& message) {
        errors.push_back({uniform.line, fmt::format("{}: {}", uniform.name, message)});
    };
    if (is_reserved(uniform.name)) return fail("every node has a value of this name");
    if (uniform.name == "lipschitz") return fail("this name belongs to the constant, as const float lipschitz = 1.5;");
    const float low = parameter.minimum, high = parameter.maximum;
    if (!(low >= -largest_value && high <= largest_value))
        return fail(fmt::format("the range goes beyond -{0:g} .. {0:g}", largest_value));
    if (parameter.is_whole() && (std::floor(low) != low || std::floor(high) != high))
        return fail("the range of whole numbers needs whole ends");
    if (const std::string why = why_refused(parameter, parameter.initial); !why.empty())
        fail(fmt::format("the initial value is out of range: {}", why));
}

std::string CustomCode::glsl(std::string_view suffix, std::span<const std::string> arguments) const {
    Names names = source_->globals();
    // The program around may have macros, which the text's own names in capitals must not become.
    for (const std::string& name : source_->foreign_names())
        if (is_in_capitals(name)) names.insert(name);
    std::vector<std::string> declarations;
    for (std::size_t i = 0; i < arguments.size(); ++i)
        declarations.push_back(declaration(source_->uniforms()[i], arguments[i]));
    return source_->renamed(names, suffix, declarations);
}

std::string CustomCode::called() const {
    std::string names;
    for (const std::string& name : source_->foreign_names()) names += name + " ";
    return names;
}

float CustomCode::evaluate(glm::vec3 p, std::span<const glm::vec3> values) const {
    std::array<Cell, 3 * most_uniforms> inputs;
    int count = 0;
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
        const Parameter& parameter = parameters_[i];
        const bool flag = source_->uniforms()[i].type[0] == 'b';
        for (int k = 0; k < parameter.components(); ++k) {
            float v = i < values.size() ? values[i][k] : parameter.initial[k];
            // Loops and indices rely on the range of whole numbers.
            if (parameter.is_whole()) v = v >= parameter.minimum ? std::min(v, parameter.maximum) : parameter.minimum;
            inputs[static_cast<std::size_t>(count++)] = flag ? static_cast<Cell>(v != 0.0f)
                                                        : parameter.is_whole()
                                                            ? static_cast<Cell>(static_cast<std::int32_t>(v))
                                                            : std::bit_cast<Cell>(v);
        }
    }
    const float point[3] = {p.x, p.y, p.z};
    return run(program_, point, inputs.data(), count);
}

}  // namespace farfield
