// New, open, save and quit, with the questions before unsaved work is lost and before code from elsewhere runs.
#pragma once

#include "app/document.h"
#include "app/file_dialog.h"

#include <functional>
#include <optional>
#include <string>

namespace farfield {

class FileActions {
public:
    explicit FileActions(Document& document) : document_(document) {}

    void create();
    void open();
    /// `trust_code`: what it holds may run.
    void open(const std::filesystem::path& file, bool trust_code = false);
    void save();
    void save_as();
    void quit();

    /// Draws what is being asked, if anything, and carries out the answer.
    void draw(Ui& ui);

    bool quits() const { return quits_; }
    bool wants_keyboard() const { return dialog_.wants_keyboard(); }
    /// Shown until what it is about has gone well, or until dismissed.
    const std::string& error() const { return error_; }
    void dismiss() { error_.clear(); }
    void edit_failed(std::string error) { fail(Failed::edit, std::move(error)); }
    /// The document was changed: whoever goes on working has seen what could not be done. Unsaved work is another
    /// matter.
    void edit_succeeded() {
        if (failed_ != Failed::save) error_.clear();
    }

private:
    using Action = std::function<void()>;
    enum class Failed { edit, open, save };
    void fail(Failed what, std::string error) {
        failed_ = what;
        error_ = std::move(error);
    }

    /// Does it at once, or after the user agreed to lose or save what is unsaved.
    void unless_unsaved(Action action);
    void load(const std::filesystem::path& file, bool trust_code = false);
    void ask_about_unsaved(Ui& ui);
    void ask_about_code(Ui& ui);
    bool write(const std::filesystem::path& file);

    Document& document_;
    FileDialog dialog_;
    FileDialog::Mode mode_ = FileDialog::Mode::open;
    Action waiting_;  ///< for the answer about unsaved work
    Action after_save_;
    bool ask_ = false, quits_ = false;
    /// A scene with code that may not run yet, until the user has decided.
    struct Foreign {
        std::filesystem::path file;
        Scene scene;
    };
    std::optional<Foreign> foreign_;
    std::string error_;
    Failed failed_ = Failed::edit;  ///< what the error is about
};

}  // namespace farfield
