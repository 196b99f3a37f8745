#include "sdf/atomic_file.h"

#include "sdf/descriptor.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace farfield {
namespace {

namespace fs = std::filesystem;

/// The new file until it has its place; whatever happens before, it is removed.
struct TemporaryFile {
    fs::path path;
    Descriptor descriptor;
    ~TemporaryFile() {
        if (!path.empty()) ::unlink(path.c_str());
    }
};

[[noreturn]] void fail(const char* what) {
    const int error = errno;
    throw FileError(fmt::format("{}: {}", what, std::strerror(error)));
}

/// Where a chain of symbolic links ends, whether or not something is there: saving through a link keeps the link.
fs::path without_links(fs::path file) {
    std::error_code ignored;
    for (int i = 0; i < 40 && fs::is_symlink(file, ignored); ++i)
        file = file.parent_path() / fs::read_symlink(file, ignored);
    return file;
}

bool names(const fs::path& path, const Descriptor& file) {
    struct stat by_name {};
    struct stat opened {};
    return ::lstat(path.c_str(), &by_name) == 0 && ::fstat(file.get(), &opened) == 0 &&
           by_name.st_dev == opened.st_dev && by_name.st_ino == opened.st_ino && S_ISREG(opened.st_mode);
}

/// An empty file in `folder` that nobody else writes. What a killed program left there is used again, so that such
/// files do not pile up; a lock tells it from one that somebody is at.
void open_temporary(TemporaryFile& to, const fs::path& folder) {
    for (int attempt = 0; attempt < 100; ++attempt) {
        const fs::path path = folder / fmt::format(".farfield-{}.tmp", attempt);
        Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666));
        if (!file && (errno == ELOOP || errno == EISDIR || (errno == EACCES && ::access(folder.c_str(), W_OK) == 0)))
            continue;
        if (!file) fail(errno == EACCES || errno == EROFS ? "its folder cannot be written to" : "cannot be written");
        if (::flock(file.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) continue;
        if (!names(path, file)) continue;  // it was renamed or removed meanwhile
        if (::ftruncate(file.get(), 0) != 0) fail("cannot be written");
        to.path = path;
        to.descriptor = std::move(file);
        return;
    }
    throw FileError("cannot be written: too many unfinished files (.farfield-*.tmp) in its folder");
}

}  // namespace

void write_atomically(const fs::path& file, std::string_view text) {
    const fs::path target = without_links(file);
    struct stat old {};
    const bool exists = ::stat(target.c_str(), &old) == 0;
    if (exists && !S_ISREG(old.st_mode)) throw FileError("is not a regular file, expected a file to replace");
    if (exists && ::access(target.c_str(), W_OK) != 0) fail("cannot be written");

    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    TemporaryFile temporary;
    open_temporary(temporary, folder);
    const int to = temporary.descriptor.get();
    if (exists) {
        // Owner first: changing it clears permission bits. Only root may give files away, for others it stays theirs.
        if (::fchown(to, old.st_uid, old.st_gid) != 0 && errno != EPERM) fail("cannot be written");
        if (::fchmod(to, old.st_mode & 07777) != 0) fail("cannot be written");
    }
    while (!text.empty()) {
        const ssize_t written = ::write(to, text.data(), text.size());
        if (written < 0 && errno != EINTR) fail("cannot be written");
        if (written > 0) text.remove_prefix(static_cast<size_t>(written));
    }
    if (::fsync(to) != 0) fail("cannot be written");
    if (::rename(temporary.path.c_str(), target.c_str()) != 0) fail("cannot be replaced");
    temporary.path.clear();
    // The name is on disk once the folder is. A file system that cannot sync folders is no reason to report a failure.
    const Descriptor parent(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (parent) ::fsync(parent.get());
}

}  // namespace farfield
