// The program as scripts run it, for tests of the command line.
#pragma once

#include <fmt/format.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

namespace farfield {

struct Outcome {
    int status = -1;
    std::string output;  ///< stdout and stderr
};

/// `before`: shell commands to run first.
inline Outcome farfield_command(const std::string& arguments, const char* before = "") {
    Outcome outcome;
    const std::string command = fmt::format("exec 2>&1; {}/usr/bin/env -u DISPLAY -u WAYLAND_DISPLAY '{}' {}", before,
                                            FARFIELD_PROGRAM, arguments);
    FILE* pipe = popen(command.c_str(), "r");
    if (!pipe) return outcome;
    std::array<char, 4096> buffer{};
    while (const std::size_t n = fread(buffer.data(), 1, buffer.size(), pipe)) outcome.output.append(buffer.data(), n);
    const int status = pclose(pipe);
    if (WIFEXITED(status)) outcome.status = WEXITSTATUS(status);
    return outcome;
}

inline std::string scene(const char* name) { return fmt::format("'{}/{}.json'", FARFIELD_SCENES, name); }

}  // namespace farfield
