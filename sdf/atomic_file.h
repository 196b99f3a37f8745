// Files that are whole whatever happens: the new text is written beside the old file, synced and renamed over it, so
// that a kill, a full disk or a power failure leaves either the old file or the new one.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string_view>

namespace farfield {

struct FileError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Replaces `file`, or makes it. Permissions and, where the system lets us, the owner of the old file stay; so does a
/// symbolic link, whose target is replaced. Throws FileError that says what is wrong, without the file's name; the old
/// file survives any failure.
void write_atomically(const std::filesystem::path& file, std::string_view text);

}  // namespace farfield
