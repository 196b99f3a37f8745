#include "app/file_watch.h"

#include "sdf/scene_file.h"

#include <cerrno>
#include <functional>
#include <utility>

#include <sys/stat.h>

namespace farfield {
namespace {

constexpr double interval = 0.25;  // seconds between looks; what has not changed for so long is not being written
constexpr double grace = 1.0;      // for programs that remove a file before they write it anew

}  // namespace

FileWatch::Stamp FileWatch::stamp_of(const std::filesystem::path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) return {};
    return {status.st_mtim.tv_sec, status.st_mtim.tv_nsec, status.st_size, status.st_ino};
}

FileWatch::Content FileWatch::content_of(std::string_view text) {
    return {text.size(), std::hash<std::string_view>()(text)};
}

FileWatch::Content FileWatch::read() const {
    try {
        return content_of(read_scene_text(file_));
    } catch (const SceneFileError&) {
        return {};  // whoever loads it says why
    }
}

void FileWatch::follow(const std::filesystem::path& file, std::string_view text) {
    file_ = file;
    known_ = content_of(text);
    seen_ = arrived_ = {};
    missing_ = gone_ = false;
}

FileWatch::News FileWatch::look(double now) {
    if (file_.empty() || now < next_) return News::none;
    next_ = now + interval;
    errno = 0;
    const Stamp stamp = stamp_of(file_);
    if (stamp == Stamp()) {
        if (errno != ENOENT && errno != ENOTDIR) return News::none;
        if (!std::exchange(missing_, true)) missing_since_ = now;
        if (gone_ || now - missing_since_ < grace) return News::none;
        gone_ = true;
        return News::gone;
    }
    missing_ = false;
    if (stamp == seen_ && !gone_) return News::none;
    if (stamp != std::exchange(arrived_, stamp)) return News::none;
    seen_ = stamp;
    const bool back = std::exchange(gone_, false);
    const Content content = read();
    if (content == known_) return back ? News::back : News::none;
    known_ = content;
    return News::changed;
}

bool FileWatch::is_other_now() const {
    if (file_.empty()) return false;
    const Stamp stamp = stamp_of(file_);
    return stamp != Stamp() && stamp != seen_ && read() != known_;
}

}  // namespace farfield
