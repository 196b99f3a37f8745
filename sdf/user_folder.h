// Where a user's own files are (XDG Base Directory Specification 0.8).
#pragma once

#include <cstdlib>
#include <filesystem>

namespace farfield {

/// The folder "farfield" in that of an environment variable, as "XDG_CONFIG_HOME", or in this one of the user's home,
/// as
/// ".config". Empty where there is none: relative paths do not count.
inline std::filesystem::path user_folder(const char* variable, const char* in_home) {
    const auto folder = [](const char* name) {
        const char* text = std::getenv(name);
        const std::filesystem::path path = text ? text : "";
        return path.is_absolute() ? path : std::filesystem::path();
    };
    std::filesystem::path base = folder(variable);
    if (base.empty() && !(base = folder("HOME")).empty()) base /= in_home;
    return base.empty() ? base : base / "farfield";
}

}  // namespace farfield
