#include "app/file_actions.h"

#include "sdf/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <unordered_set>
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

void FileActions::open(const std::filesystem::path& file, bool trust_code) {
    unless_unsaved([this, file, trust_code] { load(file, trust_code); });
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

void FileActions::load(const std::filesystem::path& file, bool trust_code) {
    try {
        Scene scene = load_scene(file);
        error_.clear();
        const std::vector<UnknownCode> unknown = unknown_code(scene, document_.trust());
        if (!unknown.empty() && !trust_code) {
            foreign_ = Foreign{file, std::move(scene)};
            return;
        }
        for (const UnknownCode& code : unknown) document_.accept(*code.node->code);
        document_.open(std::move(scene), file);
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
    ask_about_unsaved(ui);
    ask_about_code(ui);
}

void FileActions::ask_about_code(Ui& ui) {
    if (!foreign_) return;
    const char* title = "Code from elsewhere";
    if (!ImGui::IsPopupOpen(title)) ImGui::OpenPopup(title);
    const ImVec2 room = ImGui::GetMainViewport()->Size;
    const ImVec2 size{std::min(ui.theme.px(760.0f), 0.94f * room.x), std::min(ui.theme.px(560.0f), 0.94f * room.y)};
    ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Appearing, {0.5f, 0.5f});
    ImGui::SetNextWindowSize(size, ImGuiCond_Appearing);
    if (!ImGui::BeginPopupModal(title, nullptr, ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoScrollbar))
        return;

    const std::vector<UnknownCode> unknown = unknown_code(foreign_->scene, document_.trust());
    std::string nodes;
    for (std::size_t i = 0; i < std::min<std::size_t>(unknown.size(), 8); ++i)
        nodes += fmt::format("{}{}", i > 0 ? ", " : "", display_name(*unknown[i].node));
    if (unknown.size() > 8) nodes += fmt::format(" and {} more", unknown.size() - 8);
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextUnformatted(
        fmt::format("{} holds GLSL code that was not written here: {}. It was checked, but to run it "
                    "your graphics driver has to compile it. Run it if you trust where it comes from.",
                    foreign_->file.filename().string(), nodes)
            .c_str());
    ImGui::PopTextWrapPos();
    ImGui::Dummy({0.0f, ui.theme.px(4.0f)});
    ImGui::PushStyleColor(ImGuiCol_ChildBg, ImGui::GetColorU32(ImGuiCol_FrameBg));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ui.theme.px(10.0f), ui.theme.px(8.0f)});
    ImGui::BeginChild("code", {0.0f, -ImGui::GetFrameHeightWithSpacing() - ui.theme.px(12.0f)}, false,
                      ImGuiWindowFlags_HorizontalScrollbar | ImGuiWindowFlags_AlwaysUseWindowPadding);
    std::unordered_set<std::string_view> shown;
    for (const UnknownCode& code : unknown) {
        if (!shown.insert(code.node->code->text()).second) continue;
        ImGui::TextDisabled("%s", code.path.c_str());
        ImGui::PushFont(ui.theme.mono);
        ImGui::TextUnformatted(code.node->code->text().c_str());
        ImGui::PopFont();
        ImGui::Dummy({0.0f, ui.theme.px(8.0f)});
    }
    ImGui::EndChild();
    ImGui::PopStyleVar();
    ImGui::PopStyleColor();
    ImGui::Dummy({0.0f, ui.theme.px(2.0f)});

    const ImVec2 button{ui.theme.px(140.0f), 0.0f};
    const bool run = ImGui::Button("Run the code", button);
    ui.report.item("foreign", "run");
    ImGui::SameLine();
    const bool without = ImGui::Button("Open without it", button);
    ui.report.item("foreign", "without");
    tooltip(ui, "Its nodes stay in the scene and show nothing", "Each can be run later");
    ImGui::SameLine();
    const bool cancel = ImGui::Button("Cancel", button) || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
    ui.report.item("foreign", "cancel");
    if (run)
        for (const UnknownCode& code : unknown) document_.accept(*code.node->code);
    if (run || without) document_.open(std::move(foreign_->scene), foreign_->file);
    if (run || without || cancel) {
        foreign_.reset();
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}

void FileActions::ask_about_unsaved(Ui& ui) {
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
