// Notices when another program writes, removes or brings back the file of the open document. It asks the file system a
// few times a second: no service is needed, and network folders work like others.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include <sys/types.h>

namespace farfield {

class FileWatch {
public:
    enum class News { none, changed, gone, back };

    /// Watches `file`, which holds `text` as far as is known: another text is a change. Empty path: nothing.
    void follow(const std::filesystem::path& file, std::string_view text);
    /// What has happened since the last call; to be called often, `now` in seconds. A file that is being written is
    /// waited for, and one that another program replaces is not gone.
    News look(double now);
    /// Whether the file has another text at this very moment than when it was last looked at.
    bool is_other_now() const;

private:
    struct Stamp {
        std::int64_t seconds = 0, nanoseconds = 0, size = -1;
        ino_t inode = 0;
        bool operator==(const Stamp&) const = default;
    };
    struct Content {
        std::size_t size = 0, hash = 0;
        bool operator==(const Content&) const = default;
    };
    static Stamp stamp_of(const std::filesystem::path& file);
    static Content content_of(std::string_view text);
    Content read() const;

    std::filesystem::path file_;
    Content known_;
    Stamp seen_;     ///< with which the content was known
    Stamp arrived_;  ///< that may still change
    double next_ = 0.0, missing_since_ = 0.0;
    bool missing_ = false, gone_ = false;
};

}  // namespace farfield
