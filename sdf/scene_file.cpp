// Scene files on disk: bounded reading, atomic writing.
#include "sdf/scene_file.h"

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

class Descriptor {
public:
    explicit Descriptor(int fd) : fd_(fd) {}
    ~Descriptor() { close(); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    explicit operator bool() const { return fd_ >= 0; }
    int get() const { return fd_; }
    bool close() {
        if (fd_ < 0) return true;
        return ::close(std::exchange(fd_, -1)) == 0;
    }

private:
    int fd_;
};

/// The new file until it has its place; whatever happens before, it is removed.
struct TemporaryFile {
    fs::path path;
    ~TemporaryFile() {
        if (!path.empty()) ::unlink(path.c_str());
    }
};

[[noreturn]] void fail(const fs::path& file, const char* what) {
    const int error = errno;
    throw SceneFileError(file.string(), 0, "", fmt::format("{}: {}", what, std::strerror(error)));
}

/// Where a chain of symbolic links ends, whether or not something is there: saving through a link keeps the link.
fs::path without_links(fs::path file) {
    std::error_code ignored;
    for (int i = 0; i < 40 && fs::is_symlink(file, ignored); ++i)
        file = file.parent_path() / fs::read_symlink(file, ignored);
    return file;
}

void write_all(const Descriptor& to, std::string_view text, const fs::path& file) {
    while (!text.empty()) {
        const ssize_t written = ::write(to.get(), text.data(), text.size());
        if (written < 0 && errno != EINTR) fail(file, "cannot be written");
        if (written > 0) text.remove_prefix(static_cast<size_t>(written));
    }
}

}  // namespace

SceneFileError::SceneFileError(std::string in_file, int at_line, std::string at_path, std::string what_is_wrong)
    : std::runtime_error(message(in_file, at_line, at_path, what_is_wrong)),
      file(std::move(in_file)),
      line(at_line),
      path(std::move(at_path)),
      problem(std::move(what_is_wrong)) {}

Scene load_scene(const fs::path& file) {
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
    return parse_scene(text, file.string());
}

void save_scene(const Scene& scene, const fs::path& file) {
    const std::string text = to_text(scene);
    if (text.size() > format::largest_file)
        throw SceneFileError(
            file.string(), 0, "",
            fmt::format("would be too large, expected at most {} MB", format::largest_file / 1'000'000));
    parse_scene(text, file.string());  // never replace a good file by one that could not be loaded again

    const fs::path target = without_links(file);
    struct stat old {};
    const bool exists = ::stat(target.c_str(), &old) == 0;
    if (exists && !S_ISREG(old.st_mode))
        throw SceneFileError(file.string(), 0, "", "is not a regular file, expected a scene file");
    if (exists && ::access(target.c_str(), W_OK) != 0) fail(file, "cannot be written");

    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    TemporaryFile temporary;
    Descriptor to = [&] {
        for (int attempt = 0;; ++attempt) {
            const fs::path path = folder / fmt::format(".farfield-{}-{}.tmp", ::getpid(), attempt);
            const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            if (fd < 0 && errno == EEXIST && attempt < 100) continue;
            if (fd < 0) fail(file, "cannot be written");
            temporary.path = path;
            return Descriptor(fd);
        }
    }();
    if (exists) {
        // Owner first: changing it clears permission bits. Only root may give files away, for others it stays theirs.
        if (::fchown(to.get(), old.st_uid, old.st_gid) != 0 && errno != EPERM) fail(file, "cannot be written");
        if (::fchmod(to.get(), old.st_mode & 07777) != 0) fail(file, "cannot be written");
    }
    write_all(to, text, file);
    if (::fsync(to.get()) != 0 || !to.close()) fail(file, "cannot be written");
    if (::rename(temporary.path.c_str(), target.c_str()) != 0) fail(file, "cannot be replaced");
    temporary.path.clear();
    // The name is on disk once the folder is. A file system that cannot sync folders is no reason to report a failure.
    const Descriptor parent(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (parent) ::fsync(parent.get());
}

}  // namespace farfield
