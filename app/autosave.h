// Work that is not saved is kept in the user's folder of state while it is being done, so that a crash costs seconds.
//
// Each running editor has two files there: NAME.lock, locked as long as the editor lives, which names the document that
// is open; and NAME.work, a copy of the document while it has changes that are not saved. Copies are written on a
// thread of their own, the first at once and then as often as the interval says. A clean end and a save remove the
// copy. One whose lock nobody holds was left by an editor that did not end cleanly.
#pragma once

#include "app/document.h"
#include "sdf/code_drafts.h"
#include "sdf/descriptor.h"

#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

namespace farfield {

/// What an editor left that did not end cleanly.
struct LeftWork {
    std::filesystem::path copy;
    std::filesystem::path file;  ///< of the document; empty where it never had one
    std::int64_t time = 0;       ///< of the copy, seconds since 1970
    int nodes = 0;               ///< without the root
};

struct RecoveredWork {
    Scene scene;
    CodeDrafts drafts;
    std::filesystem::path file;
};

class Autosave {
public:
    /// Where copies are kept; empty where there is no such folder. Then nothing is kept.
    static std::filesystem::path user_folder();
    explicit Autosave(std::filesystem::path folder, double interval = 2.0);
    /// Leaves what there is: only `end` says that nothing is to be recovered.
    ~Autosave();
    Autosave(const Autosave&) = delete;
    Autosave& operator=(const Autosave&) = delete;

    /// To be called often; `now` in seconds.
    void refresh(const Document& document, const CodeDrafts& drafts, double now);
    /// A clean end: what is not saved is not wanted.
    void end();
    /// Why the last copy could not be written; empty when it could.
    std::string problem() const;

    /// The newest first. Copies that say the same as their file are removed, not told.
    std::vector<LeftWork> left() const;
    /// The copy becomes this editor's own. Throws FileError, and the copy stays where it is.
    RecoveredWork recover(const LeftWork& work);
    void discard(const LeftWork& work) const;

    /// Whether another editor has the document of this file open.
    bool is_open_elsewhere(const std::filesystem::path& file) const;

private:
    struct Copy {
        std::shared_ptr<const Scene> scene;  ///< null: the copy is to be removed
        CodeDrafts drafts;
        std::filesystem::path file;
    };
    void hand_over(Copy copy);
    void wait_until_idle();
    void run();

    std::filesystem::path folder_;
    std::filesystem::path lock_file_, own_;
    Descriptor lock_;
    double interval_;

    std::optional<std::filesystem::path> told_;  ///< what the lock says is open
    std::pair<std::uint64_t, CodeDrafts> kept_;  ///< revision and drafts that were handed over last
    bool keeps_ = false;                         ///< there is a copy, or will be
    double next_ = 0.0;

    mutable std::mutex mutex_;  ///< guards the rest
    std::condition_variable wake_, idle_;
    std::optional<Copy> waiting_;
    bool busy_ = false, stop_ = false;
    std::string problem_;
    std::thread thread_;
};

}  // namespace farfield
