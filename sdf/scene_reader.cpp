// Scene from text. What a scene file may hold is told by node_kinds and fields; here is only how the tables meet JSON.
#include "sdf/custom_code.h"
#include "sdf/fields.h"
#include "sdf/located_json.h"
#include "sdf/scene_format.h"
#include "sdf/suggestion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

namespace farfield {
namespace {

using Keys = std::vector<std::string_view>;

float narrowed(double number) {
    // A double beyond float's range has no defined conversion.
    constexpr double largest = std::numeric_limits<float>::max();
    if (std::abs(number) > largest)
        return std::copysign(std::numeric_limits<float>::infinity(), static_cast<float>(number > 0) - 0.5f);
    return static_cast<float>(number);
}

class Reader {
public:
    explicit Reader(const std::string& file) : file_(file) {}

    Scene read(const Json& document) {
        const JsonPath top;
        const Json::Object& object = object_in(document, top, "a scene");
        check_version(document, top);
        check_keys(object, top,
                   {format::schema, format::version_key, format::camera, format::bookmarks, format::settings,
                    format::sky, format::materials, format::lights, format::definitions, format::root});
        if (const Json* schema = document.find(format::schema)) {
            const auto* text = schema->as<std::string>();
            if (!text) unexpected({&top, format::schema}, *schema, "a text, where the format's JSON Schema is");
            scene_.schema = *text;
        }
        read_section(document, top, format::camera, scene_.camera);
        if (const Json* bookmarks = document.find(format::bookmarks))
            read_bookmarks(*bookmarks, {&top, format::bookmarks});
        read_section(document, top, format::settings, scene_.settings);
        read_section(document, top, format::sky, scene_.sky);
        if (const Json* materials = document.find(format::materials))
            read_materials(*materials, {&top, format::materials});
        else
            material_ids_.emplace(scene_.materials.front().name, scene_.materials.front().id);
        if (const Json* lights = document.find(format::lights)) read_lights(*lights, {&top, format::lights});
        const JsonPath definitions_path{&top, format::definitions};
        const Json* definitions = document.find(format::definitions);
        if (definitions) read_definitions(*definitions, definitions_path);
        const Json* root = document.find(format::root);
        if (!root) fail(top, document.line, "has no \"root\", expected the union that holds the scene's nodes");
        scene_.root = read_node(*root, {&top, format::root, -1, root});
        if (scene_.root.kind != NodeKind::union_)
            fail({&top, format::root}, root->line,
                 fmt::format("is a {}, expected a union", info(scene_.root.kind).key));
        if (const auto problem = find_nesting_problem(scene_)) {
            report(*problem, *root, {&top, format::root, -1, root}, scene_.root);
            const auto& array = *definitions->as<Json::Array>();
            for (size_t i = 0; i < array.size(); ++i)
                report(*problem, array[i], {&definitions_path, {}, static_cast<int>(i), &array[i]},
                       scene_.definitions[i]);
        }
        return std::move(scene_);
    }

private:
    [[noreturn]] void fail(const JsonPath& path, int line, const std::string& problem) const {
        throw SceneFileError(file_, line, path.text(), problem);
    }
    [[noreturn]] void unexpected(const JsonPath& path, const Json& found, std::string_view expected) const {
        fail(path, found.line, fmt::format("found {}, expected {}", description(found), expected));
    }

    const Json::Object& object_in(const Json& json, const JsonPath& path, std::string_view what) const {
        const auto* object = json.as<Json::Object>();
        if (!object) unexpected(path, json, fmt::format("an object that describes {}", what));
        return *object;
    }

    void check_version(const Json& document, const JsonPath& top) const {
        const Json* version = document.find(format::version_key);
        if (!version)
            fail(top, document.line,
                 fmt::format("has no \"{}\", expected the format's version, which is {}", format::version_key,
                             format::version));
        const double* number = version->as<double>();
        const JsonPath path{&top, format::version_key};
        if (number && *number > format::version && *number == std::floor(*number))
            fail(path, version->line,
                 fmt::format("the file has version {}, expected at most {}: it needs a newer Farfield",
                             description(*version), format::version));
        if (!number || *number != format::version)
            unexpected(path, *version, fmt::format("version {}", format::version));
    }

    void check_keys(const Json::Object& object, const JsonPath& path, const Keys& known) const {
        for (const JsonMember& member : object)
            if (std::find(known.begin(), known.end(), member.key) == known.end())
                fail({&path, member.key}, member.line, "unknown key, " + expected_one_of(known, member.key));
    }

    /// A member that must be there and be one of a list of names; returns its index.
    size_t read_name_of(const Keys& known, const Json& object, const JsonPath& path, const char* key) const {
        const Json* json = object.find(key);
        if (!json) fail(path, object.line, fmt::format("has no \"{}\", {}", key, expected_one_of(known, "")));
        return index_of_name(known, *json, {&path, key});
    }

    size_t index_of_name(const Keys& known, const Json& json, const JsonPath& path) const {
        const auto* name = json.as<std::string>();
        auto found = name ? std::find(known.begin(), known.end(), *name) : known.end();
        if (found == known.end())
            fail(path, json.line,
                 fmt::format("found {}, {}", description(json), expected_one_of(known, name ? *name : "")));
        return static_cast<size_t>(found - known.begin());
    }

    void check_name(const std::string& name, const JsonPath& path, int line) const {
        if (name.empty()) fail(path, line, "the name is empty, expected at least one character");
        if (std::any_of(name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }))
            fail(path, line, "the name holds a control character, expected printable text");
    }

    float read_component(const Json& json, const Parameter& parameter, const JsonPath& path) const {
        if (parameter.is_switch()) {
            const bool* flag = json.as<bool>();
            if (!flag) unexpected(path, json, "true or false");
            return *flag ? 1.0f : 0.0f;
        }
        if (const auto* text = json.as<std::string>(); text && parameter.word && *text == parameter.word)
            return parameter.lowest();
        const double* number = json.as<double>();
        if (!number) unexpected(path, json, parameter.components() == 1 ? expectation(parameter) : "a number");
        if (parameter.is_whole() && *number != std::floor(*number)) unexpected(path, json, expectation(parameter));
        const float component = narrowed(*number);
        if (parameter.is_word(component)) unexpected(path, json, expectation(parameter));
        // The same value in all places asks about one component alone, so that the message names its line.
        if (std::string why = why_refused(parameter, glm::vec3(component)); !why.empty())
            fail(path, json.line, fmt::format("found {}, {}", description(json), why));
        return component;
    }

    glm::vec3 read_value(const Json& json, const Parameter& parameter, const JsonPath& path) const {
        if (parameter.type == ParameterType::choice) {
            const Keys known(parameter.choices.begin(), parameter.choices.end());
            return glm::vec3(static_cast<float>(index_of_name(known, json, path)), 0.0f, 0.0f);
        }
        if (parameter.components() == 1) return glm::vec3(read_component(json, parameter, path), 0.0f, 0.0f);
        const auto* array = json.as<Json::Array>();
        if (!array || array->size() != 3) unexpected(path, json, expectation(parameter));
        glm::vec3 value;
        for (int i = 0; i < 3; ++i) value[i] = read_component((*array)[size_t(i)], parameter, {&path, {}, i});
        if (std::string why = why_refused(parameter, value); !why.empty())
            fail(path, json.line, fmt::format("found {}, {}", description(json), why));
        return value;
    }

    template <class T, class Applies>
    void read_fields(const Json& object, const JsonPath& path, T& target, Applies applies) const {
        for (const Field<T>& field : fields<T>())
            if (const Json* json = applies(field.parameter.key) ? object.find(field.parameter.key) : nullptr)
                field.set(target, read_value(*json, field.parameter, {&path, field.parameter.key}));
    }

    template <class T, class Applies>
    static void add_keys(Keys& keys, Applies applies) {
        for (const Field<T>& field : fields<T>())
            if (applies(field.parameter.key)) keys.push_back(field.parameter.key);
    }

    /// An object that holds the fields of T, after the keys in `keys`.
    template <class T, class Applies>
    void read_object(const Json& json, const JsonPath& path, T& target, Keys keys, Applies applies) const {
        add_keys<T>(keys, applies);
        check_keys(*json.as<Json::Object>(), path, keys);
        read_fields(json, path, target, applies);
    }

    static bool always(std::string_view) { return true; }

    template <class T>
    void read_section(const Json& document, const JsonPath& top, const char* key, T& target) const {
        const Json* json = document.find(key);
        if (!json) return;
        const JsonPath path{&top, key};
        object_in(*json, path, fmt::format("the {}", key));
        read_object(*json, path, target, {}, always);
    }

    void read_bookmarks(const Json& json, const JsonPath& path) {
        for (const JsonMember& member : object_in(json, path, "the bookmarks by name")) {
            const JsonPath here{&path, member.key};
            check_name(member.key, here, member.line);
            object_in(member.value, here, "a camera");
            Bookmark& bookmark = scene_.bookmarks.emplace_back();
            bookmark.id = scene_.new_id();
            bookmark.name = member.key;
            read_object(member.value, here, bookmark.camera, {}, always);
        }
    }

    void read_materials(const Json& json, const JsonPath& path) {
        const Json::Object& object = object_in(json, path, "the materials by name");
        if (object.empty()) fail(path, json.line, "is empty, expected at least one material");
        scene_.materials.clear();
        for (const JsonMember& member : object) {
            const JsonPath here{&path, member.key};
            check_name(member.key, here, member.line);
            if (scene_.materials.size() == largest_material_count)
                fail(here, member.line,
                     fmt::format("is one material too many, expected at most {}", largest_material_count));
            object_in(member.value, here, "a material");
            Material& material = scene_.materials.emplace_back();
            material.id = scene_.new_id();
            material.name = member.key;
            read_object(member.value, here, material, {}, always);
            material_ids_.emplace(material.name, material.id);
        }
    }

    void read_lights(const Json& json, const JsonPath& path) {
        for (const JsonMember& member : object_in(json, path, "the lights by name")) {
            const JsonPath here{&path, member.key};
            check_name(member.key, here, member.line);
            object_in(member.value, here, "a light");
            const Keys kinds(std::begin(light_kind_keys), std::end(light_kind_keys));
            Light& light = scene_.lights.emplace_back();
            light.id = scene_.new_id();
            light.name = member.key;
            light.kind = static_cast<LightKind>(read_name_of(kinds, member.value, here, format::kind));
            read_object(member.value, here, light, {format::kind},
                        [&](std::string_view key) { return applies(light, key); });
            if (light.kind == LightKind::directional && light.direction == glm::vec3(0.0f))
                fail({&here, "direction"}, member.value.find("direction")->line,
                     "found a vector of length 0, expected a direction");
        }
    }

    /// Names come first: a node may refer to a definition that comes later.
    void read_definitions(const Json& json, const JsonPath& path) {
        const auto* array = json.as<Json::Array>();
        if (!array) unexpected(path, json, "an array of nodes");
        std::vector<Id> ids;
        for (const Json& definition : *array) {
            ids.push_back(scene_.new_id());
            const auto* object = definition.as<Json::Object>();
            const Json* name = object ? definition.find(format::name) : nullptr;
            if (const auto* text = name ? name->as<std::string>() : nullptr)
                if (definition_ids_.emplace(*text, ids.back()).second) definition_names_.push_back(*text);
        }
        for (size_t i = 0; i < array->size(); ++i) {
            const JsonPath here{&path, {}, static_cast<int>(i), &(*array)[i]};
            Node definition = read_node((*array)[i], here);
            if (definition.name.empty())
                fail(here, (*array)[i].line, "has no \"name\", expected one, by which instances refer to it");
            definition.id = ids[i];
            scene_.definitions.push_back(std::move(definition));
        }
    }

    /// Fails at the node with the problem, if that is below `node`.
    void report(const NestingProblem& problem, const Json& json, const JsonPath& path, const Node& node) const {
        if (node.id == problem.node && problem.endless)
            fail({&path, format::of}, json.find(format::of)->line,
                 fmt::format("found {}, expected a definition that does not contain this instance itself",
                             description(*json.find(format::of))));
        if (node.id == problem.node)
            fail(path, json.line,
                 fmt::format("is too deep, expected at most {} nodes inside one another, instances "
                             "counted with what they show",
                             largest_depth));
        const Json* children = json.find(format::children);
        const JsonPath inside{&path, format::children};
        for (size_t i = 0; i < node.children.size(); ++i) {
            const Json& child = (*children->as<Json::Array>())[i];
            report(problem, child, {&inside, {}, static_cast<int>(i), &child}, node.children[i]);
        }
    }

    Node read_node(const Json& json, const JsonPath& path) {
        const Json::Object& object = object_in(json, path, "a node");
        Keys kinds;
        for (const KindInfo& kind : node_kinds()) kinds.push_back(kind.key);
        const KindInfo& kind = node_kinds()[read_name_of(kinds, json, path, format::kind)];

        if (const Json* children = kind.takes_children() ? nullptr : json.find(format::children))
            fail({&path, format::children}, children->line,
                 fmt::format("found {}, expected none: {} {} has no children", description(*children),
                             std::string_view("aeiou").find(kind.key[0]) == std::string_view::npos ? "a" : "an",
                             kind.key));
        Keys keys{format::kind, format::name, format::material, format::hidden, format::locked};
        if (kind.role == Role::instance) keys.push_back(format::of);
        Node node = make_node(kind.kind);
        if (kind.kind == NodeKind::custom) {
            keys.push_back(format::code);
            if (const Json* code = json.find(format::code)) read_code(*code, {&path, format::code}, node);
        }
        const std::vector<Parameter> list = parameters(node);
        for (const Parameter& parameter : list) keys.push_back(parameter.key);
        add_keys<Transform>(keys, always);
        if (kind.takes_children()) keys.push_back(format::children);
        check_keys(object, path, keys);

        node.id = scene_.new_id();
        node.name = read_node_name(json, path);
        node.material = read_material_reference(json, path);
        node.hidden = read_flag(json, path, format::hidden);
        node.locked = read_flag(json, path, format::locked);
        if (kind.role == Role::instance) node.definition = read_definition_reference(json, path);
        for (size_t i = 0; i < list.size(); ++i)
            if (const Json* value = json.find(list[i].key))
                node.values[i] = read_value(*value, list[i], {&path, list[i].key});
        read_fields(json, path, node.transform, always);
        if (const Json* children = json.find(format::children))
            read_children(*children, {&path, format::children}, node);
        return node;
    }

    /// Gives the node its code, with the code's values.
    void read_code(const Json& json, const JsonPath& path, Node& node) {
        const auto* array = json.as<Json::Array>();
        if (!array || array->empty()) unexpected(path, json, "an array of the lines of GLSL code");
        std::string text;
        for (size_t i = 0; i < array->size(); ++i) {
            const Json& line = (*array)[i];
            const auto* characters = line.as<std::string>();
            const JsonPath here{&path, {}, static_cast<int>(i)};
            if (!characters) unexpected(here, line, "a line of GLSL code as text");
            if (characters->find('\n') != characters->npos)
                fail(here, line.line, "found a text with a line break, expected one for each line of code");
            if (i > 0) text += '\n';
            text += *characters;
        }
        auto& code = codes_[text];
        if (!code) {
            if (codes_.size() > format::most_codes)
                fail(path, json.line,
                     fmt::format("is one code too many, expected at most {} different ones", format::most_codes));
            const CustomCode::Parsed parsed = CustomCode::parse(text);
            if (!parsed.code) {
                const CodeError& error = parsed.errors.front();
                const size_t at = std::min(static_cast<size_t>(error.line), array->size()) - 1;
                fail({&path, {}, static_cast<int>(at)}, (*array)[at].line,
                     fmt::format("line {} of the code: {}", error.line, error.message));
            }
            code = parsed.code;
        }
        node.code = code;
        node.values.resize(info(node.kind).parameters.size());
        for (const Parameter& parameter : code->parameters()) node.values.push_back(parameter.initial);
    }

    void read_children(const Json& json, const JsonPath& path, Node& node) {
        const auto* array = json.as<Json::Array>();
        if (!array) unexpected(path, json, "an array of nodes");
        node.children.reserve(array->size());
        for (size_t i = 0; i < array->size(); ++i)
            node.children.push_back(read_node((*array)[i], {&path, {}, static_cast<int>(i), &(*array)[i]}));
    }

    std::string read_node_name(const Json& node, const JsonPath& node_path) {
        const Json* json = node.find(format::name);
        if (!json) return {};
        const JsonPath path{&node_path, format::name};
        const auto* name = json->as<std::string>();
        if (!name) unexpected(path, *json, "a text");
        check_name(*name, path, json->line);
        if (auto [first, fresh] = node_lines_.try_emplace(*name, json->line); !fresh)
            fail(path, json->line,
                 fmt::format("found {} again, expected a name of its own (the first is on line {})", description(*json),
                             first->second));
        return *name;
    }

    bool read_flag(const Json& node, const JsonPath& node_path, const char* key) const {
        const Json* json = node.find(key);
        if (json && !json->as<bool>()) unexpected({&node_path, key}, *json, "true or false");
        return json && *json->as<bool>();
    }

    Id read_material_reference(const Json& node, const JsonPath& node_path) const {
        const Json* json = node.find(format::material);
        if (!json) return 0;
        const JsonPath path{&node_path, format::material};
        const auto* name = json->as<std::string>();
        if (!name) unexpected(path, *json, "the name of a material");
        if (auto found = material_ids_.find(*name); found != material_ids_.end()) return found->second;
        Keys known;
        for (const Material& material : scene_.materials) known.push_back(material.name);
        if (known.size() > 20) known.resize(20);
        fail(path, json->line,
             fmt::format("there is no material {}, {}", description(*json), expected_one_of(known, *name)));
    }

    Id read_definition_reference(const Json& node, const JsonPath& node_path) const {
        const Json* json = node.find(format::of);
        if (!json)
            fail(node_path, node.line, fmt::format("has no \"{}\", expected the name of a definition", format::of));
        const JsonPath path{&node_path, format::of};
        const auto* name = json->as<std::string>();
        if (!name) unexpected(path, *json, "the name of a definition");
        if (auto found = definition_ids_.find(*name); found != definition_ids_.end()) return found->second;
        if (definition_names_.empty())
            fail(path, json->line,
                 fmt::format("there is no definition {}: the file has no \"{}\"", description(*json),
                             format::definitions));
        const Keys known(definition_names_.begin(),
                         definition_names_.begin() + std::min<std::ptrdiff_t>(20, std::ssize(definition_names_)));
        fail(path, json->line,
             fmt::format("there is no definition {}, {}", description(*json), expected_one_of(known, *name)));
    }

    const std::string& file_;
    Scene scene_;
    std::unordered_map<std::string, Id> material_ids_;
    std::unordered_map<std::string, std::shared_ptr<const CustomCode>> codes_;  ///< by their text
    std::unordered_map<std::string, Id> definition_ids_;
    std::vector<std::string> definition_names_;
    std::unordered_map<std::string, int> node_lines_;  ///< names that are taken and where
};

}  // namespace

Scene parse_scene(std::string_view text, const std::string& file) {
    try {
        const Json document = parse_json(text);
        return Reader(file).read(document);
    } catch (const JsonError& error) {
        throw SceneFileError(file, error.line, error.path, error.what());
    }
}

}  // namespace farfield
