// The open scene: its history, its file, and whether the file holds what is on screen.
#pragma once

#include "sdf/code_trust.h"
#include "sdf/history.h"

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

namespace farfield {

/// What "New" starts with: nothing but light to see the first shape by.
Scene new_scene();

class Document {
public:
    /// `trust` says which code may run, and learns what is written here.
    explicit Document(CodeTrust& trust) : trust_(trust) { reset(); }

    const Scene& scene() const { return history_.scene(); }
    /// The current scene for the renderer, without code that may not run; the same object until something changes.
    std::shared_ptr<const Scene> snapshot();
    const History& history() const { return history_; }
    std::uint64_t revision() const { return history_.revision(); }

    /// All of them or none, as one step; see History.
    std::vector<Id> apply(const Edits& edits, unsigned gesture);
    const CodeTrust& trust() const { return trust_; }
    void accept(const CustomCode& code) { trust_.accept(code); }
    void undo() { history_.undo(); }
    void redo() { history_.redo(); }
    void go_to(std::size_t step) { history_.go_to(step); }
    void cancel(unsigned gesture) { history_.cancel(gesture); }

    /// A new document without a file.
    void reset(Scene scene = new_scene());
    /// The scene of `file` takes this one's place.
    void open(Scene scene, const std::filesystem::path& file);
    /// Work on `file` that was not saved takes its place.
    void recover(Scene scene, const std::filesystem::path& file);
    /// Another program has written the file: what it says now is one step of undo. What both have keeps its identity,
    /// and a camera that the other did not touch stays where it is here.
    void reload(Scene scene);
    /// Throws SceneFileError.
    void save(const std::filesystem::path& file);
    /// Whether the file is not there any more, and with it what was saved.
    void set_file_lost(bool lost) { file_lost_ = lost; }

    /// Where the camera was when the document was opened or begun.
    const Camera& first_camera() const { return first_camera_; }
    /// Changes when another document takes this one's place.
    std::uint64_t generation() const { return generation_; }
    const std::filesystem::path& file() const { return file_; }  ///< empty for a document that was never saved
    bool saved() const { return !file_lost_ && history_.revision() == saved_revision_; }
    /// Whether the file holds everything but where the camera stands.
    bool saved_but_for_camera() const;
    std::string name() const { return file_.empty() ? "untitled" : file_.filename().string(); }

private:
    void begin(Scene scene, const std::filesystem::path& file);

    CodeTrust& trust_;
    History history_;
    std::filesystem::path file_;
    Camera first_camera_;
    std::shared_ptr<const Scene> in_file_;  ///< what the file says; null where that is not known
    bool file_lost_ = false;
    std::uint64_t saved_revision_ = 0;  ///< 0: none
    std::uint64_t generation_ = 0;
    std::shared_ptr<const Scene> snapshot_;
    std::pair<std::uint64_t, std::size_t> snapshot_revision_;  ///< of the document and of what may run
};

}  // namespace farfield
