#include "sdf/parameter.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>

namespace farfield {

int Parameter::components() const {
    switch (type) {
        case ParameterType::number:
        case ParameterType::integer:
        case ParameterType::flag:
        case ParameterType::choice:
            return 1;
        default:
            return 3;
    }
}

bool Parameter::is_whole() const {
    return type == ParameterType::integer || type == ParameterType::count || type == ParameterType::choice ||
           is_switch();
}

glm::vec3 to_code_units(const Parameter& parameter, glm::vec3 value) {
    const bool angle = parameter.unit == Unit::degrees || parameter.unit == Unit::degrees_per_metre;
    return angle ? glm::radians(value) : value;
}

std::string expectation(const Parameter& parameter) {
    switch (parameter.type) {
        case ParameterType::flag:
            return "true or false";
        case ParameterType::flags:
            return "three of true or false";
        case ParameterType::choice:
            return fmt::format("one of {}", fmt::join(parameter.choices, ", "));
        default:
            break;
    }
    const char* kind = parameter.is_whole() ? "whole number" : "number";
    std::string text = parameter.components() == 1 ? fmt::format("a {}", kind) : fmt::format("three {}s, each", kind);
    if (parameter.maximum >= largest_value && parameter.minimum > -largest_value)
        return text + fmt::format(" at least {} (and at most {:g})", parameter.minimum, parameter.maximum);
    text += fmt::format(" between {:g} and {:g}", parameter.minimum, parameter.maximum);
    return parameter.word ? fmt::format("{}, or \"{}\"", text, parameter.word) : text;
}

std::string why_refused(const Parameter& parameter, glm::vec3 value) {
    for (int i = 0; i < parameter.components(); ++i) {
        const float v = value[i];
        const bool whole = !parameter.is_whole() || v == std::floor(v);
        const bool inside = (v >= parameter.minimum && v <= parameter.maximum) || v == parameter.lowest();
        if (!inside || !whole) return "expected " + expectation(parameter);
    }
    return {};
}

glm::vec3 clamped(const Parameter& parameter, glm::vec3 value) {
    for (int i = 0; i < 3; ++i) {
        if (std::isnan(value[i])) value[i] = parameter.initial[i];
        if (i >= parameter.components()) continue;
        const bool is_word = parameter.word && value[i] < 0.5f * (parameter.lowest() + parameter.minimum);
        value[i] = is_word ? parameter.lowest() : glm::clamp(value[i], parameter.minimum, parameter.maximum);
        if (parameter.is_whole()) value[i] = std::round(value[i]);
    }
    return value;
}

std::string_view unit_symbol(Unit unit) {
    switch (unit) {
        case Unit::metres:
            return "m";
        case Unit::degrees:
            return "°";
        case Unit::degrees_per_metre:
            return "°/m";
        case Unit::per_metre:
            return "1/m";
        case Unit::stops:
            return "stops";
        case Unit::percent:
            return "%";
        case Unit::none:
            break;
    }
    return "";
}

}  // namespace farfield
