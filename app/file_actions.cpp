#include "app/file_actions.h"

#include "app/templates.h"
#include "sdf/scene_file.h"

#include <fmt/format.h>

namespace farfield {
namespace {

namespace fs = std::filesystem;

constexpr double notice_seconds = 6.0;

}  // namespace

FileActions::FileActions(Document& document, EditorState& state)
    : document_(document), state_(state), autosave_(Autosave::user_folder()), left_(autosave_.left()) {
    recovering_ = !left_.empty();
}

void FileActions::create() {
    unless_unsaved([this] {
        document_.reset();
        settle({}, "");
    });
}

void FileActions::open() {
    unless_unsaved([this] {
        mode_ = FileDialog::Mode::open;
        dialog_.show(mode_, document_.file().parent_path());
    });
}

void FileActions::open(const fs::path& file, bool trust_code) {
    unless_unsaved([this, file, trust_code] { load(file, trust_code); });
}

void FileActions::save() {
    if (document_.file().empty())
        save_as();
    else if (outdated_ || watch_.is_other_now())
        asked_ = AboutFile::replace;
    else
        write(document_.file());
}

void FileActions::save_as() {
    after_save_ = nullptr;
    mode_ = FileDialog::Mode::save;
    dialog_.show(mode_, document_.file());
}

void FileActions::export_picture() {
    mode_ = FileDialog::Mode::picture;
    fs::path start = last_export_;
    if (start.empty()) start = fs::path(document_.file()).replace_filename(fs::path(document_.name()).stem() += ".png");
    dialog_.show(mode_, start);
}

void FileActions::quit() {
    unless_unsaved([this] { quits_ = true; });
}

void FileActions::unless_unsaved(Action action) {
    after_save_ = nullptr;
    if (document_.saved() && drafts_.empty()) return action();
    waiting_ = std::move(action);
}

/// The document is as it is in `file`, or new.
void FileActions::settle(const fs::path& file, std::string_view text) {
    error_.clear();
    outdated_ = false;
    asked_ = AboutFile::nothing;
    watch_.follow(file, text);
    if (file.empty()) return;
    remember_file(state_, file, editor_state_file());
    want_thumbnail();
}

void FileActions::want_thumbnail() {
    if (const fs::path picture = Thumbnails::file_of(document_.file()); !picture.empty()) thumbnail_ = picture;
}

void FileActions::load(const fs::path& file, bool trust_code) {
    try {
        const std::string text = read_scene_text(file);
        Scene scene = parse_scene(text, file.string());
        error_.clear();
        const std::vector<UnknownCode> unknown = unknown_code(scene, document_.trust());
        if (!unknown.empty() && !trust_code) {
            foreign_ = Foreign{file, std::move(scene), text, false};
            return;
        }
        for (const UnknownCode& code : unknown) document_.accept(*code.node->code);
        show(std::move(scene), file, text);
    } catch (const SceneFileError& error) {
        fail(About::opening, error.what());
    }
}

void FileActions::show(Scene scene, const fs::path& file, std::string_view text) {
    document_.open(std::move(scene), file);
    settle(file, text);
    if (autosave_.is_open_elsewhere(file))
        fail(About::opening, fmt::format("{} is open in another Farfield too. Whoever saves last replaces what the "
                                         "other has saved.",
                                         file.string()));
}

bool FileActions::write(const fs::path& file) {
    try {
        document_.save(file);
        settle(file, to_text(document_.scene()));
        return true;
    } catch (const SceneFileError& error) {
        fail(About::saving, fmt::format("{}\nThe file is as it was, and your work is still here: make room, or save it "
                                        "elsewhere with File, Save as (Ctrl+Shift+S).",
                                        error.what()));
        return false;
    }
}

bool FileActions::refresh(const CodeDrafts& drafts, double now) {
    now_ = now;
    drafts_ = drafts;
    autosave_.refresh(document_, drafts, now);
    if (const std::string problem = autosave_.problem(); problem != autosave_problem_) {
        autosave_problem_ = problem;
        if (!problem.empty())
            fail(About::saving, fmt::format("Unsaved work cannot be kept for the case of a crash: {}", problem));
        news_ = true;
    }
    look_at_file(watch_.look(now));
    if (!notice_.empty() && now > notice_until_ && !exporting_) say("");
    return std::exchange(news_, false);
}

void FileActions::say(std::string notice) {
    notice_ = std::move(notice);
    notice_until_ = now_ + notice_seconds;
    news_ = true;
}

void FileActions::look_at_file(FileWatch::News news) {
    if (news == FileWatch::News::none) return;
    news_ = true;
    if (news == FileWatch::News::gone) {
        document_.set_file_lost(true);
        fail(About::saving, fmt::format("{} is not there any more. What it held is here: save it to have it back.",
                                        document_.file().string()));
    } else if (news == FileWatch::News::back) {
        document_.set_file_lost(false);
        error_.clear();
        say(fmt::format("{} is back", document_.name()));
    } else {
        read_theirs();
    }
}

/// What another program has written takes this document's place, if nothing is lost by that; otherwise it is asked.
void FileActions::read_theirs() {
    outdated_ = true;
    try {
        Scene scene = load_scene(document_.file());
        document_.set_file_lost(false);
        if (!document_.saved_but_for_camera() || !drafts_.empty())
            asked_ = AboutFile::changed;
        else
            take_theirs(std::move(scene));
    } catch (const SceneFileError& error) {
        fail(About::opening,
             fmt::format("{}\nAnother program has written this. The scene stays as it was before; it is "
                         "read again when the file changes.",
                         error.what()));
    }
}

void FileActions::take_theirs(Scene scene) {
    if (foreign_) return;
    const std::vector<UnknownCode> unknown = unknown_code(scene, document_.trust());
    if (!unknown.empty()) {
        foreign_ = Foreign{document_.file(), std::move(scene), "", true};
        return;
    }
    reload(std::move(scene));
}

void FileActions::reload(Scene scene) {
    document_.reload(std::move(scene));
    outdated_ = false;
    asked_ = AboutFile::nothing;
    error_.clear();
    want_thumbnail();
    say(fmt::format("{} was changed by another program and read again", document_.name()));
}

void FileActions::recover(const LeftWork& work) {
    try {
        RecoveredWork recovered = autosave_.recover(work);
        std::string text;
        std::error_code failed;
        if (fs::exists(recovered.file, failed)) {
            try {
                text = read_scene_text(recovered.file);
            } catch (const SceneFileError&) {  // it is replaced when the document is saved
            }
        }
        document_.recover(std::move(recovered.scene), recovered.file);
        settle(recovered.file, text);
        thumbnail_.reset();
        recovered_drafts_ = drafts_ = std::move(recovered.drafts);
        say(fmt::format("{} was recovered and is not saved yet", document_.name()));
    } catch (const std::runtime_error& error) {
        fail(About::opening, fmt::format("The work cannot be recovered: {}", error.what()));
    }
    left_ = autosave_.left();
}

void FileActions::exported(const WrittenPicture& picture) {
    exporting_ = false;
    if (picture.error.empty())
        say(fmt::format("The picture is in {}", picture.file.string()));
    else
        fail(About::opening, picture.error);
}

void FileActions::draw(Ui& ui) {
    if (const auto file = dialog_.draw(ui, state_)) {
        if (mode_ == FileDialog::Mode::open) {
            load(*file);
        } else if (mode_ == FileDialog::Mode::picture) {
            export_ = last_export_ = *file;
            exporting_ = true;
            say("Writing the picture...");
        } else if (write(*file) && after_save_) {
            std::exchange(after_save_, nullptr)();
        }
    }
    ask_about_unsaved(ui);
    ask_about_code(ui);
    ask_about_file(ui);
    ask_about_left(ui);
}

void FileActions::menu(Ui& ui, CommandId command) {
    if (command == CommandId::create) {
        const bool open = ImGui::BeginMenu("New from template");
        ui.report.item("menu/File", "template");
        if (!open) return;
        for (const SceneTemplate& entry : scene_templates()) {
            if (ImGui::MenuItem(entry.label))
                unless_unsaved([this, &entry] {
                    document_.reset(entry.make());
                    settle({}, "");
                });
            ui.report.item("menu/template", entry.key);
            tooltip(ui, entry.tip);
        }
        ImGui::EndMenu();
    } else if (command == CommandId::open) {
        const bool open = ImGui::BeginMenu("Open recent", !state_.recent.empty());
        ui.report.item("menu/File", "recent");
        if (!open) return;
        std::optional<fs::path> chosen;
        for (const fs::path& file : state_.recent) {
            if (ImGui::MenuItem(fmt::format("{}##{}", file.filename().string(), file.string()).c_str())) chosen = file;
            ui.report.item("menu/recent", file.filename().string());
            tooltip(ui, file.string());
        }
        ImGui::EndMenu();
        if (chosen) this->open(*chosen);
    }
}

}  // namespace farfield
