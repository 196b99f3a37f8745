// New, open, save, export and quit, with the questions before unsaved work is lost and before code from elsewhere runs;
// what happens to the file outside, and what is recovered after a crash.
#pragma once

#include "app/autosave.h"
#include "app/document.h"
#include "app/editor_commands.h"
#include "app/editor_state.h"
#include "app/file_dialog.h"
#include "app/file_watch.h"
#include "renderer/render_thread.h"

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace farfield {

class FileActions {
public:
    /// `state` has the recent files.
    FileActions(Document& document, EditorState& state);

    void create();
    void open();
    /// `trust_code`: what it holds may run.
    void open(const std::filesystem::path& file, bool trust_code = false);
    void save();
    void save_as();
    void export_picture();
    void quit();
    /// Offers the work that was left; see can_recover.
    void ask_to_recover() { recovering_ = true; }
    bool can_recover() const { return !left_.empty(); }
    /// After the last frame of an editor that was told to quit.
    void end() { autosave_.end(); }

    /// Keeps unsaved work and looks at the file; to be called often, `now` in seconds. `drafts`: code that was typed
    /// and not handed in. True when there is something new to show.
    bool refresh(const CodeDrafts& drafts, double now);
    /// Draws what is being asked, if anything, and carries out the answer.
    void draw(Ui& ui);
    /// What a menu has below a command: templates and recent files.
    void menu(Ui& ui, CommandId command);

    bool quits() const { return quits_; }
    bool wants_keyboard() const { return dialog_.wants_keyboard(); }
    /// Shown until what it is about has gone well, or until dismissed.
    const std::string& error() const { return error_; }
    void dismiss() { error_.clear(); }
    /// What has gone well, for some seconds.
    const std::string& notice() const { return notice_; }
    void edit_failed(std::string error) { fail(About::edit, std::move(error)); }
    /// The document was changed: whoever goes on working has seen what could not be done. Unsaved work is another
    /// matter.
    void edit_succeeded() {
        if (about_ != About::saving) error_.clear();
    }

    /// Drafts of a recovered document, once.
    CodeDrafts take_drafts() { return std::exchange(recovered_drafts_, {}); }
    /// Where the current picture is wanted, once.
    std::optional<std::filesystem::path> take_export() { return std::exchange(export_, std::nullopt); }
    void exported(const WrittenPicture& picture);
    /// Where a thumbnail of what was just opened or saved is wanted, once.
    std::optional<std::filesystem::path> take_thumbnail() { return std::exchange(thumbnail_, std::nullopt); }

private:
    using Action = std::function<void()>;
    enum class About { edit, opening, saving };
    void fail(About about, std::string error) {
        about_ = about;
        error_ = std::move(error);
        notice_.clear();
    }
    void say(std::string notice);

    /// Does it at once, or after the user agreed to lose or save what is unsaved.
    void unless_unsaved(Action action);
    void load(const std::filesystem::path& file, bool trust_code = false);
    void show(Scene scene, const std::filesystem::path& file, std::string_view text);
    bool write(const std::filesystem::path& file);
    void settle(const std::filesystem::path& file, std::string_view text);
    void want_thumbnail();
    void look_at_file(FileWatch::News news);
    void read_theirs();
    void take_theirs(Scene scene);
    void reload(Scene scene);
    void recover(const LeftWork& work);

    void ask_about_unsaved(Ui& ui);
    void ask_about_code(Ui& ui);
    void ask_about_file(Ui& ui);
    void ask_about_left(Ui& ui);

    Document& document_;
    EditorState& state_;
    Autosave autosave_;
    FileWatch watch_;
    FileDialog dialog_;
    FileDialog::Mode mode_ = FileDialog::Mode::open;
    CodeDrafts drafts_;
    Action waiting_;  ///< for the answer about unsaved work
    Action after_save_;
    bool quits_ = false;

    /// A scene with code that may not run yet, until the user has decided.
    struct Foreign {
        std::filesystem::path file;
        Scene scene;
        std::string text;
        bool reload;  ///< of the open document
    };
    std::optional<Foreign> foreign_;

    /// Another program has written the file, and what it wrote was not taken over.
    bool outdated_ = false;
    enum class AboutFile { nothing, changed, replace } asked_ = AboutFile::nothing;

    std::vector<LeftWork> left_;
    std::set<std::filesystem::path> unwanted_;  ///< copies of these that go when the question is answered
    bool recovering_ = false;
    CodeDrafts recovered_drafts_;

    std::optional<std::filesystem::path> export_, thumbnail_;
    std::filesystem::path last_export_;
    bool exporting_ = false;
    std::string error_, notice_, autosave_problem_;
    About about_ = About::edit;  ///< the error
    double now_ = 0.0, notice_until_ = 0.0;
    bool news_ = false;
};

}  // namespace farfield
