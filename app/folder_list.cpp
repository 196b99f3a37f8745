#include "app/folder_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include <sys/stat.h>

namespace farfield {
namespace {

namespace fs = std::filesystem;

std::string small_letters(std::string_view text) {
    std::string small(text);
    std::transform(small.begin(), small.end(), small.begin(), [](unsigned char c) { return std::tolower(c); });
    return small;
}

}  // namespace

std::string FolderList::read(const fs::path& folder, std::span<const char* const> extensions) {
    entries_.clear();
    filter_.clear();
    std::error_code failed;
    for (fs::directory_iterator it(folder, fs::directory_options::skip_permission_denied, failed), end;
         !failed && it != end; it.increment(failed)) {
        FolderEntry entry{.name = it->path().filename().string()};
        if (entry.name[0] == '.') continue;
        std::error_code ignored;
        entry.folder = it->is_directory(ignored);
        const std::string extension = small_letters(it->path().extension().string());
        if (!entry.folder && std::find(extensions.begin(), extensions.end(), extension) == extensions.end()) continue;
        struct stat status {};
        if (!entry.folder && ::stat(it->path().c_str(), &status) == 0) {
            entry.size = static_cast<std::uintmax_t>(status.st_size);
            entry.time = status.st_mtime;
        }
        entries_.push_back(std::move(entry));
    }
    arrange();
    return failed ? fmt::format("This folder cannot be read: {}", failed.message()) : "";
}

void FolderList::sort(bool newest_first) {
    if (newest_first_ == newest_first) return;
    newest_first_ = newest_first;
    arrange();
}

void FolderList::filter(std::string_view text) {
    std::string small = small_letters(text);
    if (small == filter_) return;
    filter_ = std::move(small);
    arrange();
}

void FolderList::arrange() {
    rows_.clear();
    for (std::size_t i = 0; i < entries_.size(); ++i)
        if (small_letters(entries_[i].name).find(filter_) != std::string::npos) rows_.push_back(i);
    std::sort(rows_.begin(), rows_.end(), [this](std::size_t left, std::size_t right) {
        const FolderEntry &a = entries_[left], &b = entries_[right];
        if (a.folder != b.folder) return a.folder;
        if (newest_first_ && !a.folder && a.time != b.time) return a.time > b.time;
        return a.name < b.name;
    });
}

}  // namespace farfield
