// What a file dialog shows of a folder: its folders and then its files of some types, in an order, filtered by a text.
#pragma once

#include <cstdint>
#include <ctime>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace farfield {

struct FolderEntry {
    std::string name;
    bool folder = false;
    std::uintmax_t size = 0;  ///< bytes
    std::time_t time = 0;     ///< of the last change
};

class FolderList {
public:
    /// Reads the folder anew. Hidden files are left out. Returns why it could not be read, empty when it could.
    std::string read(const std::filesystem::path& folder, std::span<const char* const> extensions);
    /// Folders go by name in either order.
    void sort(bool newest_first);
    /// Leaves names with `text` in them, whatever the case of letters; all for an empty text.
    void filter(std::string_view text);

    std::size_t size() const { return rows_.size(); }
    const FolderEntry& operator[](std::size_t row) const { return entries_[rows_[row]]; }

private:
    void arrange();

    std::vector<FolderEntry> entries_;
    std::vector<std::size_t> rows_;  ///< entries in order, those that the filter leaves
    bool newest_first_ = false;
    std::string filter_;  ///< in small letters
};

}  // namespace farfield
