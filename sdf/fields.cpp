#include "sdf/fields.h"

#include <fmt/format.h>

#include <stdexcept>

namespace farfield {
namespace {

using glm::vec3;

vec3 pack(float v) { return {v, 0.0f, 0.0f}; }
vec3 pack(int v) { return {static_cast<float>(v), 0.0f, 0.0f}; }
vec3 pack(vec3 v) { return v; }
vec3 pack(Method v) { return pack(static_cast<int>(v)); }
void unpack(vec3 v, float& out) { out = v.x; }
void unpack(vec3 v, int& out) { out = static_cast<int>(v.x); }
void unpack(vec3 v, vec3& out) { out = v; }
void unpack(vec3 v, Method& out) { out = static_cast<Method>(static_cast<int>(v.x)); }

template <class M>
struct MemberOf;
template <class T, class V>
struct MemberOf<V T::*> {
    using type = T;
};

/// The field for a pointer to member; its default is that of a default-constructed object.
template <auto M, class T = typename MemberOf<decltype(M)>::type>
Field<T> field(Parameter parameter) {
    parameter.initial = pack(T{}.*M);
    return {parameter, [](const T& object) { return pack(object.*M); },
            [](T& object, vec3 v) { unpack(v, object.*M); }};
}

constexpr float big = largest_value;
using P = ParameterType;

}  // namespace

template <>
std::span<const Field<Transform>> fields<Transform>() {
    static const std::vector<Field<Transform>> table = {
        field<&Transform::translate>({"translate", "Moves the node in its parent's frame", P::vector, Unit::metres}),
        field<&Transform::rotate>(
            {"rotate", "Turns about x, then y, then z", P::vector, Unit::degrees, -36000.0f, 36000.0f}),
        field<&Transform::scale>({"scale", "Uniform scale", P::number, Unit::none, 1e-4f, 1e4f}),
    };
    return table;
}

template <>
std::span<const Field<Material>> fields<Material>() {
    static const std::vector<Field<Material>> table = {
        field<&Material::albedo>(
            {"albedo", "Fraction of light that is diffusely reflected", P::color, Unit::none, 0.0f, 1.0f}),
        field<&Material::specular>(
            {"specular", "Fraction of direct light in the Phong highlight", P::number, Unit::none, 0.0f, 1.0f}),
        field<&Material::exponent>(
            {"exponent", "Phong exponent: the higher, the smaller the highlight", P::number, Unit::none, 1.0f, 1e4f}),
        field<&Material::emission>({"emission", "Emitted radiance, W/(m² sr)", P::color, Unit::none, 0.0f, big}),
    };
    return table;
}

template <>
std::span<const Field<Light>> fields<Light>() {
    static const std::vector<Field<Light>> table = {
        field<&Light::position>({"position", "Where the light stands", P::vector, Unit::metres}),
        field<&Light::direction>({"direction", "The way the light travels", P::vector, Unit::none}),
        field<&Light::intensity>({"intensity", "Point light: W/sr. Directional light: W/m² across the beam", P::color,
                                  Unit::none, 0.0f, big}),
    };
    return table;
}

template <>
std::span<const Field<Sky>> fields<Sky>() {
    static const std::vector<Field<Sky>> table = {
        field<&Sky::horizon>({"horizon", "Radiance from the horizon and below", P::color, Unit::none, 0.0f, big}),
        field<&Sky::zenith>({"zenith", "Radiance from straight above", P::color, Unit::none, 0.0f, big}),
    };
    return table;
}

template <>
std::span<const Field<Camera>> fields<Camera>() {
    static const std::vector<Field<Camera>> table = {
        field<&Camera::position>({"position", "Where the camera stands", P::vector, Unit::metres}),
        field<&Camera::target>({"target", "What it looks at", P::vector, Unit::metres}),
        field<&Camera::field_of_view>(
            {"field_of_view", "Vertical angle of view", P::number, Unit::degrees, 1.0f, 170.0f}),
    };
    return table;
}

template <>
std::span<const Field<Settings>> fields<Settings>() {
    static const std::vector<Field<Settings>> table = {
        field<&Settings::method>(
            {"method",
             "farfield: far light filtered apart from near light, right in the limit. paper: filtered far "
             "light x ambient occlusion. reference: unfiltered path tracing",
             P::choice,
             Unit::none,
             0.0f,
             2.0f,
             {},
             method_keys}),
        field<&Settings::samples>(
            {"samples", "Hemisphere rays per pixel and frame", P::integer, Unit::none, 1.0f, 64.0f}),
        field<&Settings::noise>({"noise",
                                 "Frames are added until the error of indirect light, RMSE / mean as estimated, is at "
                                 "most so much; off: for ever",
                                 P::number,
                                 Unit::percent,
                                 0.1f,
                                 100.0f,
                                 {},
                                 {},
                                 "off"}),
        field<&Settings::bounces>({"bounces",
                                   "Diffuse bounces of far light; auto stops when the next would add less than 0.5 %",
                                   P::integer,
                                   Unit::none,
                                   1.0f,
                                   8.0f,
                                   {},
                                   {},
                                   "auto"}),
        field<&Settings::blur_levels>({"blur_levels",
                                       "How far far light is averaged, doubling with each level; 0 leaves it as it is; "
                                       "auto goes by the size of the picture: 3 at 256 pixels, 4 at 512",
                                       P::integer,
                                       Unit::none,
                                       0.0f,
                                       8.0f,
                                       {},
                                       {},
                                       "auto"}),
        field<&Settings::ao_radius>(
            {"ao_radius", "How far ambient occlusion looks", P::number, Unit::metres, 1e-3f, 1e3f}),
        field<&Settings::exposure>(
            {"exposure", "Brightness of the picture; one stop doubles it", P::number, Unit::stops, -20.0f, 20.0f}),
    };
    return table;
}

bool applies(const Light& light, std::string_view key) {
    if (key == "position") return light.kind == LightKind::point;
    if (key == "direction") return light.kind == LightKind::directional;
    return true;
}

namespace {

/// Calls `visit(object)` with the addressed node, material, light, sky, camera or settings; with a bookmark's
/// camera for that. False for an unknown id.
template <class S, class Visitor>
bool visit_object(S& scene, ObjectRef ref, Visitor visit) {
    switch (ref.type) {
        case ObjectType::node:
            if (auto* node = find_node(scene, ref.id)) return visit(*node), true;
            return false;
        case ObjectType::material:
            for (auto& material : scene.materials)
                if (material.id == ref.id) return visit(material), true;
            return false;
        case ObjectType::light:
            for (auto& light : scene.lights)
                if (light.id == ref.id) return visit(light), true;
            return false;
        case ObjectType::sky:
            return visit(scene.sky), true;
        case ObjectType::camera:
            return visit(scene.camera), true;
        case ObjectType::bookmark:
            for (auto& bookmark : scene.bookmarks)
                if (bookmark.id == ref.id) return visit(bookmark.camera), true;
            return false;
        case ObjectType::settings:
            return visit(scene.settings), true;
    }
    return false;
}

/// Finds `key` in `object` and calls `use(parameter, get, set)`, where set works on non-const objects only.
template <class T, class Use>
bool use_field(T& object, std::string_view key, Use use) {
    using Plain = std::remove_const_t<T>;
    if constexpr (std::is_same_v<Plain, Node>) {
        const std::vector<Parameter> list = parameters(object);
        for (std::size_t i = 0; i < list.size(); ++i)
            if (key == list[i].key) return use(list[i], object.values[i]), true;
        return use_field(object.transform, key, use);
    } else {
        for (const Field<Plain>& f : fields<Plain>()) {
            if (key != f.parameter.key) continue;
            vec3 v = f.get(object);
            use(f.parameter, v);
            if constexpr (!std::is_const_v<T>) f.set(object, v);
            return true;
        }
        return false;
    }
}

[[noreturn]] void unknown(ObjectRef ref, std::string_view key) {
    throw std::out_of_range(
        fmt::format("object {} of type {} has no value \"{}\"", ref.id, static_cast<int>(ref.type), key));
}

}  // namespace

std::vector<Parameter> parameters(const Scene& scene, ObjectRef ref) {
    std::vector<Parameter> list;
    visit_object(scene, ref, [&]<class T>(const T& object) {
        if constexpr (std::is_same_v<T, Node>) {
            list = parameters(object);
            for (const auto& f : fields<Transform>()) list.push_back(f.parameter);
        } else {
            for (const Field<T>& f : fields<T>()) {
                if constexpr (std::is_same_v<T, Light>)
                    if (!applies(object, f.parameter.key)) continue;
                list.push_back(f.parameter);
            }
        }
    });
    return list;
}

vec3 value(const Scene& scene, ObjectRef ref, std::string_view key) {
    vec3 result{0.0f};
    bool found = false;
    visit_object(scene, ref, [&](const auto& object) {
        found = use_field(object, key, [&](const Parameter&, const vec3& v) { result = v; });
    });
    if (!found) unknown(ref, key);
    return result;
}

void set_value(Scene& scene, ObjectRef ref, std::string_view key, vec3 value) {
    bool found = false;
    visit_object(scene, ref, [&](auto& object) {
        found = use_field(object, key, [&](const Parameter& parameter, vec3& v) {
            if (const std::string problem = why_refused(parameter, value); !problem.empty())
                throw std::invalid_argument(fmt::format("{}: {}", key, problem));
            v = value;
        });
    });
    if (!found) unknown(ref, key);
}

}  // namespace farfield
