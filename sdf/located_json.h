// JSON with the line of every value, for errors that point into the file. Parsing is nlohmann's; the tree is ours
// because his does not keep lines. Beyond JSON's own rules a key must not be given twice, numbers must be finite in
// double precision, and nesting is limited, so that no file can exhaust the stack of whoever walks the tree.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace farfield {

struct JsonMember;

struct Json {
    using Array = std::vector<Json>;
    using Object = std::vector<JsonMember>;  ///< in the file's order

    std::variant<std::nullptr_t, bool, double, std::string, Array, Object> value;
    int line = 0;  ///< of the last character of a scalar, of the opening bracket of the others

    template <class T>
    const T* as() const {
        return std::get_if<T>(&value);
    }
    const Json* find(std::string_view key) const;  ///< the member of an object; null when there is none
};

struct JsonMember {
    std::string key;
    int line;  ///< of the key
    Json value;
};

/// Where a value stands in the document; a chain on the stack of whoever walks the tree, turned to text for errors
/// only.
struct JsonPath {
    const JsonPath* parent = nullptr;
    std::string_view key;         ///< of a member
    int index = -1;               ///< of an array's element, otherwise negative
    const Json* value = nullptr;  ///< an object's "name", where it has one, is part of the text

    std::string text() const;  ///< as root/children[2] "ring"/radius
};

struct JsonError : std::runtime_error {
    JsonError(int at_line, std::string at_path, const std::string& problem)
        : std::runtime_error(problem), line(at_line), path(std::move(at_path)) {}
    int line;
    std::string path;
};

inline constexpr int deepest_json = 1000;  ///< arrays and objects inside one another

/// Throws JsonError.
Json parse_json(std::string_view text);

/// What a value is, for messages, as `"abc"`, `3`, `an array of 2` or `an object`.
std::string description(const Json& json);

/// Text in quotes for a message: shortened, without control characters and invalid UTF-8.
std::string in_quotes(std::string_view text);

}  // namespace farfield
