#include "sdf/scene_schema.h"

#include "sdf/fields.h"
#include "sdf/scene_format.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdlib>

namespace farfield {
namespace {

using Schema = nlohmann::ordered_json;

/// The number that a file would hold: 0.1 for 0.1f, and 5 for 5.0f.
Schema number(float value) {
    if (value == std::floor(value)) return static_cast<std::int64_t>(value);
    return std::strtod(fmt::format("{}", value).c_str(), nullptr);
}

Schema reference(std::string_view definition) { return {{"$ref", fmt::format("#/definitions/{}", definition)}}; }

/// One component, or all of a parameter that has one.
Schema component(const Parameter& parameter) {
    if (parameter.is_switch()) return {{"type", "boolean"}};
    const Schema numbers{{"type", parameter.is_whole() ? "integer" : "number"},
                         {"minimum", number(parameter.minimum)},
                         {"maximum", number(parameter.maximum)}};
    return parameter.word ? Schema{{"anyOf", {numbers, {{"const", parameter.word}}}}} : numbers;
}

Schema initial(const Parameter& parameter) {
    const glm::vec3 v = parameter.initial;
    if (parameter.type == ParameterType::choice) return parameter.choices[static_cast<std::size_t>(v.x)];
    if (parameter.type == ParameterType::flag) return v.x != 0.0f;
    if (parameter.is_word(v.x)) return parameter.word;
    if (parameter.components() == 1) return number(v.x);
    if (parameter.type == ParameterType::flags) return Schema::array({v.x != 0.0f, v.y != 0.0f, v.z != 0.0f});
    return Schema::array({number(v.x), number(v.y), number(v.z)});
}

Schema value(const Parameter& parameter) {
    const std::string_view unit = unit_symbol(parameter.unit);
    Schema schema{{"description", unit.empty() ? parameter.tip : fmt::format("{} ({})", parameter.tip, unit)}};
    if (parameter.type == ParameterType::choice)
        schema["enum"] = std::vector<std::string>(parameter.choices.begin(), parameter.choices.end());
    else if (parameter.components() == 1)
        schema.update(component(parameter));
    else
        schema.update({{"type", "array"}, {"items", component(parameter)}, {"minItems", 3}, {"maxItems", 3}});
    schema["default"] = initial(parameter);
    return schema;
}

template <class T, class Applies>
void add_fields(Schema& properties, Applies applies) {
    for (const Field<T>& field : fields<T>())
        if (applies(field.parameter.key)) properties[field.parameter.key] = value(field.parameter);
}

Schema object(const char* description, Schema properties) {
    return {{"description", description},
            {"type", "object"},
            {"properties", std::move(properties)},
            {"additionalProperties", false}};
}

template <class T>
Schema section(const char* description) {
    Schema properties = Schema::object();
    add_fields<T>(properties, [](std::string_view) { return true; });
    return object(description, std::move(properties));
}

/// An object whose `kind` decides which keys it may have: those of the definition of that name.
Schema by_kind(const char* description, const std::vector<std::string>& kinds, const std::vector<std::string>& tips) {
    Schema schema{{"description", description},
                  {"type", "object"},
                  {"properties", {{format::kind, {{"enum", kinds}}}}},
                  {"required", {format::kind}},
                  {"allOf", Schema::array()}};
    // Not of the standard, but what Visual Studio Code shows beside the choices.
    if (!tips.empty()) schema["properties"][format::kind]["enumDescriptions"] = tips;
    for (const std::string& kind : kinds)
        schema["allOf"].push_back(
            {{"if", {{"properties", {{format::kind, {{"const", kind}}}}}}}, {"then", reference(kind)}});
    return schema;
}

Schema light(LightKind kind) {
    Light light;
    light.kind = kind;
    Schema properties{{format::kind, true}};
    add_fields<Light>(properties, [&](std::string_view key) { return applies(light, key); });
    if (kind == LightKind::directional) properties["direction"]["not"] = {{"const", {0, 0, 0}}};
    return object(kind == LightKind::point ? "Shines from a point" : "Shines from far away", std::move(properties));
}

/// The keys that all nodes have are described with the node; a kind only admits them.
Schema node(const KindInfo& kind) {
    Schema properties{{format::kind, true},
                      {format::name, true},
                      {format::material, true},
                      {format::hidden, true},
                      {format::locked, true}};
    for (const Parameter& parameter : kind.parameters) properties[parameter.key] = value(parameter);
    for (const Field<Transform>& field : fields<Transform>()) properties[field.parameter.key] = true;
    if (kind.takes_children()) properties[format::children] = true;
    if (kind.role == Role::instance) {
        properties[format::of] = {{"description", "Name of the definition"}, {"type", "string"}};
        Schema instance = object(kind.tip, std::move(properties));
        instance["required"] = {format::of};
        return instance;
    }
    if (kind.kind != NodeKind::custom) return object(kind.tip, std::move(properties));
    properties[format::code] = {{"description", "The lines of its GLSL code; without it a ball in waves"},
                                {"type", "array"},
                                {"items", {{"type", "string"}, {"pattern", "^[^\\n]*$"}}},
                                {"minItems", 1}};
    Schema schema = object(kind.tip, std::move(properties));
    // What the code declares, in as far as a schema can tell.
    const Schema numbers{
        {"type", "array"}, {"items", {{"type", {"number", "boolean"}}}}, {"minItems", 3}, {"maxItems", 3}};
    schema["additionalProperties"] = {{"anyOf", {{{"type", {"number", "boolean"}}}, numbers}}};
    return schema;
}

Schema any_node() {
    std::vector<std::string> kinds, tips;
    for (const KindInfo& kind : node_kinds()) kinds.push_back(kind.key), tips.push_back(kind.tip);
    Schema schema = by_kind("A shape, or an operation on its children", kinds, tips);
    Schema& properties = schema["properties"];
    properties[format::name] = reference("name");
    properties[format::material] = {
        {"description", "Name of a material; without it that of the nearest node above that has one"},
        {"type", "string"}};
    properties[format::hidden] = {
        {"description", "Counts as not there, with all below it"}, {"type", "boolean"}, {"default", false}};
    properties[format::locked] = {{"description", "Kept in the editor from being picked, moved and deleted"},
                                  {"type", "boolean"},
                                  {"default", false}};
    add_fields<Transform>(properties, [](std::string_view) { return true; });
    properties[format::children] = {{"type", "array"}, {"items", reference("node")}};
    return schema;
}

/// By the name of their kind where they belong to one, so the table's keys must not be "node" and the like.
Schema definitions() {
    Schema all;
    all["name"] = {{"description", "Printable text, unique in its list"},
                   {"type", "string"},
                   {"minLength", 1},
                   {"not", {{"pattern", "[\\u0000-\\u001f\\u007f]"}}}};
    all["camera"] = section<Camera>("Where the picture is taken from");
    all["material"] = section<Material>("How a surface reflects and emits light");
    all["light"] = by_kind("A light", {std::begin(light_kind_keys), std::end(light_kind_keys)}, {});
    for (std::size_t i = 0; i < std::size(light_kind_keys); ++i)
        all[light_kind_keys[i]] = light(static_cast<LightKind>(i));
    all["node"] = any_node();
    for (const KindInfo& kind : node_kinds()) all[kind.key] = node(kind);
    return all;
}

Schema scene() {
    Schema properties;
    properties[format::schema] = {{"description", "Where an editor of text finds this schema"}, {"type", "string"}};
    properties[format::version_key] = {{"description", "Version of the format"}, {"const", format::version}};
    properties[format::camera] = reference("camera");
    properties[format::bookmarks] = {{"description", "Cameras to come back to, by name"},
                                     {"type", "object"},
                                     {"propertyNames", reference("name")},
                                     {"additionalProperties", reference("camera")}};
    properties[format::settings] = section<Settings>("How it is rendered");
    properties[format::sky] = section<Sky>("Radiance from where there is nothing");
    properties[format::materials] = {
        {"description", "By name; the first one is for nodes that name none"},
        {"type", "object"},
        {"minProperties", 1},
        {"maxProperties", largest_material_count},
        {"propertyNames", reference("name")},
        {"additionalProperties", reference("material")},
    };
    properties[format::lights] = {{"description", "By name"},
                                  {"type", "object"},
                                  {"propertyNames", reference("name")},
                                  {"additionalProperties", reference("light")}};
    properties[format::definitions] = {{"description", "Subtrees that show where instances of them are"},
                                       {"type", "array"},
                                       {"items", {{"allOf", {reference("node"), {{"required", {format::name}}}}}}}};
    properties[format::root] = {
        {"description", "The union that holds all other nodes"},
        {"allOf", {reference("node"), {{"properties", {{format::kind, {{"const", info(NodeKind::union_).key}}}}}}}}};
    Schema schema{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "Farfield scene"}};
    schema.update(object("A scene of signed distance fields; see scenes/README.md", std::move(properties)));
    schema["required"] = {format::version_key, format::root};
    schema["definitions"] = definitions();
    return schema;
}

/// What fits is on one line, everything else has a line for each member.
std::string text_of(const Schema& schema, std::size_t indent, std::size_t column) {
    if (!schema.is_structured()) return schema.dump();
    constexpr std::size_t widest = 120;
    const bool is_object = schema.is_object();
    const auto listed = [&](const std::string& before, const std::string& between, const std::string& after) {
        std::string text;
        for (const auto& [name, member] : schema.items()) {
            const std::string key = is_object ? Schema(name).dump() + ": " : "";
            text += (text.empty() ? before : between) + key + text_of(member, indent + 2, indent + 2 + key.size());
        }
        return (is_object ? "{" : "[") + text + (text.empty() ? "" : after) + (is_object ? "}" : "]");
    };
    const std::string line = listed("", ", ", "");
    if (column + line.size() < widest && line.find('\n') == line.npos) return line;
    const std::string inside = '\n' + std::string(indent + 2, ' ');
    return listed(inside, "," + inside, '\n' + std::string(indent, ' '));
}

}  // namespace

std::string scene_schema() { return text_of(scene(), 0, 0) + '\n'; }

}  // namespace farfield
