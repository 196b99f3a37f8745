// Drawing by gnuplot, which runs a script with the data in it.
#pragma once

#include <filesystem>
#include <string>

namespace farfield {

/// As a string of gnuplot's.
std::string quoted(const std::string& text);

/// Runs the script in its folder. Throws std::runtime_error, which says so where gnuplot is not installed.
void run_gnuplot(const std::filesystem::path& folder, const std::string& script);

}  // namespace farfield
