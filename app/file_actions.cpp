#include "app/file_actions.h"

#include "sdf/scene_file.h"

#include <utility>

namespace farfield {

void FileActions::create() {
    unless_unsaved([this] {
        document_.reset();
        error_.clear();
    });
}

void FileActions::open() {
    unless_unsaved([this] {
        mode_ = FileDialog::Mode::open;
        dialog_.show(mode_, document_.file().parent_path());
    });
}

void FileActions::open(const std::filesystem::path& file) {
    unless_unsaved([this, file] { load(file); });
}

void FileActions::save() {
    if (document_.file().empty())
        save_as();
    else
        write(document_.file());
}

void FileActions::save_as() {
    after_save_ = nullptr;
    mode_ = FileDialog::Mode::save;
    dialog_.show(mode_, document_.file());
}

void FileActions::quit() {
    unless_unsaved([this] { quits_ = true; });
}

void FileActions::unless_unsaved(Action action) {
    after_save_ = nullptr;
    if (document_.saved()) return action();
    waiting_ = std::move(action);
    ask_ = true;
}

void FileActions::load(const std::filesystem::path& file) {
    try {
        document_.open(file);
        error_.clear();
    } catch (const SceneFileError& error) {
        fail(Failed::open, error.what());
    }
}

bool FileActions::write(const std::filesystem::path& file) {
    try {
        document_.save(file);
        error_.clear();
        return true;
    } catch (const SceneFileError& error) {
        fail(Failed::save, error.what());
        return false;
    }
}

void FileActions::draw(Ui& ui) {
    if (const auto file = dialog_.draw(ui)) {
        if (mode_ == FileDialog::Mode::open)
            load(*file);
        else if (write(*file) && after_save_)
            std::exchange(after_save_, nullptr)();
    }

    const char* title = "Unsaved changes";
    if (std::exchange(ask_, false)) ImGui::OpenPopup(title);
    ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Appearing, {0.5f, 0.5f});
    if (!ImGui::BeginPopupModal(title, nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings))
        return;
    ImGui::Text("%s has changes that are not saved.", document_.name().c_str());
    ImGui::Dummy({0.0f, ui.theme.px(6.0f)});
    const ImVec2 size{ui.theme.px(110.0f), 0.0f};
    Action then;
    const bool save_first = ImGui::Button("Save", size);
    ui.report.item("unsaved", "save");
    ImGui::SameLine();
    const bool discard = ImGui::Button("Discard", size);
    ui.report.item("unsaved", "discard");
    ImGui::SameLine();
    const bool cancel = ImGui::Button("Cancel", size) || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
    ui.report.item("unsaved", "cancel");
    if (save_first || discard || cancel) {
        then = std::exchange(waiting_, nullptr);
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
    if (discard) {
        then();
    } else if (save_first && document_.file().empty()) {
        save_as();
        after_save_ = std::move(then);
    } else if (save_first && write(document_.file())) {
        then();
    }
}

}  // namespace farfield
