// What the parts of the table of node kinds share: the functions of shapes.glsl and operations.glsl as C++, adapters to
// the table's signatures, and parameters. Included by *_kinds.cpp alone.
#pragma once

#include "sdf/node_kinds.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <type_traits>
#include <utility>

namespace farfield {

// In this order they make the table; so does NodeKind.
void add_primitives(std::vector<KindInfo>& table);
void add_combinations(std::vector<KindInfo>& table);
void add_modifiers(std::vector<KindInfo>& table);

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"  // GLSL has no parameters without a name
#pragma GCC diagnostic ignored "-Wunused-function"   // each part uses its own
namespace {
namespace shapes {
using namespace glm;
#include "sdf/shapes.glsl"
#include "sdf/operations.glsl"
}  // namespace shapes

// Adapters from the functions of shapes.glsl and operations.glsl to the uniform signatures of the table: the arguments
// that follow the fixed ones are taken from the parameter values in order, x for a float and all of a vec3.
template <class T>
T argument(glm::vec3 v) {
    if constexpr (std::is_same_v<T, float>)
        return v.x;
    else
        return v;
}

template <class Signature, class... Fixed>
struct Rest;
template <class R, class... All, class... Fixed>
struct Rest<R (*)(All...), Fixed...> {
    static constexpr std::size_t count = sizeof...(All) - sizeof...(Fixed);
    template <std::size_t I>
    using type = std::tuple_element_t<I + sizeof...(Fixed), std::tuple<All...>>;
};

template <auto F, class... Fixed>
auto call(Values v, Fixed... fixed) {
    using Arguments = Rest<decltype(F), Fixed...>;
    return [&]<std::size_t... I>(std::index_sequence<I...>) {
        return F(fixed..., argument<typename Arguments::template type<I>>(v[I])...);
    }
    (std::make_index_sequence<Arguments::count>());
}

template <auto F>
float primitive(glm::vec3 p, Values v) {
    return call<F>(v, p);
}
template <auto F>
glm::vec2 slope(glm::vec3 p, glm::vec3 direction, Values v) {
    return call<F>(v, p, direction);
}
template <auto F>
float stay(glm::vec3 p, glm::vec3 direction, float depth, Values v) {
    return call<F>(v, p, direction, depth);
}
template <auto F>
float combine(float a, float b, Values v) {
    return call<F>(v, a, b);
}
template <auto F>
glm::vec3 domain(glm::vec3 p, Values v, int) {
    return call<F>(v, p);
}
template <auto F>
float modify(float d, glm::vec3, Values v) {
    return call<F>(v, d);
}
template <auto F>
float safe_distance(float d, glm::vec3 p, Values v) {
    return call<F>(v, d, p);
}

constexpr auto metres = Unit::metres;
constexpr auto number = ParameterType::number;
constexpr auto vector = ParameterType::vector;

Parameter length(const char* key, const char* tip, float initial, float minimum = 0.0f) {
    return {key, tip, number, metres, minimum, largest_value, glm::vec3(initial, 0.0f, 0.0f)};
}
Parameter lengths(const char* key, const char* tip, float initial, float minimum = 0.0f) {
    return {key, tip, vector, metres, minimum, largest_value, glm::vec3(initial)};
}

Parameter angle(const char* key, const char* tip, float initial) {
    return {key, tip, number, Unit::degrees, 0.0f, 360.0f, glm::vec3(initial, 0.0f, 0.0f)};
}

Parameter rate(const char* tip, float initial) {
    return {"rate", tip, number, Unit::degrees_per_metre, -36000.0f, 36000.0f, {initial, 0.0f, 0.0f}};
}

Parameter whole(const char* key, const char* tip, float initial, float minimum = 1.0f) {
    return {key, tip, ParameterType::integer, Unit::none, minimum, 1000.0f, glm::vec3(initial, 0.0f, 0.0f)};
}

using Warnings = std::vector<std::string>;

/// Of unions and displacements: the most that they add, where that is the first parameter.
float first_parameter(Values v) { return v[0].x; }
}  // namespace
#pragma GCC diagnostic pop

}  // namespace farfield

/// A function's name in GLSL and the function.
#define FUNCTION(adapter, name) #name, adapter < shapes::name>
