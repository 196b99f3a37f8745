// The description of one editable value. Node kinds, materials, lights, sky, camera and settings all describe
// their values this way; the file format, the inspector, the code generator and the tests read the description.
#pragma once

#include <glm/vec3.hpp>

#include <span>
#include <string>
#include <string_view>

namespace farfield {

enum class ParameterType {
    number,   ///< one real number, stored in x
    integer,  ///< one whole number, stored in x
    vector,   ///< three real numbers
    count,    ///< three whole numbers
    color,    ///< linear Rec. 709, three numbers >= 0; above 1 where the range allows it (emission, lights)
    flag,     ///< one switch, 0 or 1, stored in x
    flags,    ///< three switches, 0 or 1, one for each axis
    choice,   ///< index into `choices`, stored in x; written by name in files
};

/// Units as files and the user interface show them. Generated code takes radians: see `to_code_units`.
enum class Unit { none, metres, degrees, degrees_per_metre, per_metre, stops, percent };

/// Lengths, positions and radiances beyond this magnitude are refused everywhere: single precision is useless there.
inline constexpr float largest_value = 1e6f;

struct Parameter {
    const char* key;  ///< name in files and of the GLSL argument
    const char* tip;  ///< one sentence for the tooltip and the format's documentation
    ParameterType type = ParameterType::number;
    Unit unit = Unit::none;
    float minimum = -largest_value;  ///< inclusive hard limit of every component: files and edits beyond it are refused
    float maximum = largest_value;
    glm::vec3 initial{0.0f};  ///< the default; x alone counts for one-component types
    std::span<const char* const> choices = {};
    /// What else one number takes, as "auto"; stored as minimum - 1 where it is whole, else as 0, which is below
    /// minimum.
    const char* word = nullptr;

    float lowest() const { return !word ? minimum : is_whole() ? minimum - 1.0f : 0.0f; }  ///< stored
    bool is_word(float value) const { return word && value < minimum; }
    int components() const;  ///< 1 or 3
    bool is_whole() const;   ///< values are whole numbers
    bool is_switch() const { return type == ParameterType::flag || type == ParameterType::flags; }
};

/// The value as the generated code takes it: degrees become radians, everything else stays.
glm::vec3 to_code_units(const Parameter& parameter, glm::vec3 value);

/// Empty when `value` is finite, in range and whole where it must be; otherwise what was expected, as
/// "expected a number between 0 and 1e+06".
std::string why_refused(const Parameter& parameter, glm::vec3 value);

/// What the parameter takes, as "a number between 0 and 1" or "three numbers, each at least 0".
std::string expectation(const Parameter& parameter);

/// `value` brought into the range, rounded where it must be whole; NaN becomes the default.
glm::vec3 clamped(const Parameter& parameter, glm::vec3 value);

std::string_view unit_symbol(Unit unit);  ///< "m", "°", "°/m", "1/m", "stops", "%" or ""

}  // namespace farfield
