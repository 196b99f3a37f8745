// Scene files on disk: bounded reading, writing of what could be read again.
#include "sdf/scene_file.h"

#include "sdf/atomic_file.h"
#include "sdf/descriptor.h"
#include "sdf/scene_format.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace farfield {
namespace {

namespace fs = std::filesystem;

std::string message(const std::string& file, int line, const std::string& path, const std::string& problem) {
    std::string text = file;
    if (line > 0) text += fmt::format(":{}", line);
    if (!path.empty()) text += ": " + path;
    return text + ": " + problem;
}

[[noreturn]] void fail(const fs::path& file, const char* what) {
    const int error = errno;
    throw SceneFileError(file.string(), 0, "", fmt::format("{}: {}", what, std::strerror(error)));
}

}  // namespace

SceneFileError::SceneFileError(std::string in_file, int at_line, std::string at_path, std::string what_is_wrong)
    : std::runtime_error(message(in_file, at_line, at_path, what_is_wrong)),
      file(std::move(in_file)),
      line(at_line),
      path(std::move(at_path)),
      problem(std::move(what_is_wrong)) {}

std::string read_scene_text(const fs::path& file) {
    const Descriptor from(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
    if (!from) fail(file, "cannot be opened");
    struct stat status {};
    if (::fstat(from.get(), &status) == 0 && S_ISDIR(status.st_mode))
        throw SceneFileError(file.string(), 0, "", "is a folder, expected a scene file");

    std::string text;
    char block[65536];
    for (;;) {
        const ssize_t got = ::read(from.get(), block, sizeof block);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail(file, "cannot be read");
        if (got == 0) break;
        text.append(block, static_cast<size_t>(got));
        if (text.size() > format::largest_file)
            throw SceneFileError(file.string(), 0, "",
                                 fmt::format("is too large, expected at most {} MB", format::largest_file / 1'000'000));
    }
    return text;
}

Scene load_scene(const fs::path& file) { return parse_scene(read_scene_text(file), file.string()); }

void save_scene(const Scene& scene, const fs::path& file) {
    const std::string text = to_text(scene);
    if (text.size() > format::largest_file)
        throw SceneFileError(
            file.string(), 0, "",
            fmt::format("would be too large, expected at most {} MB", format::largest_file / 1'000'000));
    parse_scene(text, file.string());  // never replace a good file by one that could not be loaded again

    try {
        write_atomically(file, text);
    } catch (const FileError& error) {
        throw SceneFileError(file.string(), 0, "", error.what());
    }
}

}  // namespace farfield
