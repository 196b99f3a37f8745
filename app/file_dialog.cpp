#include "app/file_dialog.h"

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cstdlib>

namespace farfield {
namespace fs = std::filesystem;

namespace {

constexpr const char* extension = ".json";

}  // namespace

void FileDialog::show(Mode mode, const fs::path& start) {
    mode_ = mode;
    request_ = focus_ = picked_ = true;
    accepted_ = confirm_ = false;
    std::error_code failed;
    fs::path from = start.empty() ? fs::current_path(failed) : fs::absolute(start, failed);
    const bool is_folder = fs::is_directory(from, failed);
    enter(is_folder ? from : from.parent_path());
    text_ = mode == Mode::save ? (is_folder ? std::string("untitled") + extension : from.filename().string()) : "";
}

void FileDialog::enter(const fs::path& folder) {
    folder_ = folder.lexically_normal();
    if (folder_.has_relative_path() && !folder_.has_filename()) folder_ = folder_.parent_path();
    entries_.clear();
    problem_.clear();
    std::error_code failed;
    for (fs::directory_iterator it(folder_, fs::directory_options::skip_permission_denied, failed), end;
         !failed && it != end; it.increment(failed)) {
        const std::string name = it->path().filename().string();
        std::error_code ignored;
        const bool is_folder = it->is_directory(ignored);
        if (name[0] == '.' || (!is_folder && it->path().extension() != extension)) continue;
        entries_.push_back({name, is_folder});
    }
    if (failed) problem_ = fmt::format("This folder cannot be read: {}", failed.message());
    std::sort(entries_.begin(), entries_.end(),
              [](const Entry& a, const Entry& b) { return a.folder != b.folder ? a.folder : a.name < b.name; });
}

fs::path FileDialog::typed() const {
    fs::path path = text_;
    if (const char* home = std::getenv("HOME"); home && (text_ == "~" || text_.starts_with("~/")))
        path = fs::path(home) / (text_.size() > 2 ? text_.substr(2) : "");
    return (path.is_absolute() ? path : folder_ / path).lexically_normal();
}

std::optional<fs::path> FileDialog::accept() {
    accepted_ = false;
    if (text_.empty()) return std::nullopt;
    fs::path path = typed();
    std::error_code failed;
    if (fs::is_directory(path, failed)) {
        enter(path);
        text_.clear();
        return std::nullopt;
    }
    if (mode_ == Mode::open) {
        if (fs::exists(path, failed)) return path;
        problem_ = fmt::format("There is no file {}", path.filename().string());
        return std::nullopt;
    }
    if (!path.has_extension()) path += extension;
    if (!fs::is_directory(path.parent_path(), failed)) {
        problem_ = fmt::format("There is no folder {}", path.parent_path().string());
        return std::nullopt;
    }
    if (fs::exists(path, failed) && !confirm_) {
        confirm_ = true;
        return std::nullopt;
    }
    return path;
}

void FileDialog::draw_path_bar(Ui& ui) {
    ImGui::BeginDisabled(!folder_.has_relative_path());
    if (ImGui::Button("Up")) enter(folder_.parent_path());
    ImGui::EndDisabled();
    ui.report.item("dialog", "up");
    // Each folder of the path is a button.
    fs::path so_far, wanted;
    for (const fs::path& part : folder_) {
        so_far /= part;
        if (ImGui::GetItemRectMax().x >
            ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x - ui.theme.px(90.0f))
            ImGui::NewLine();
        ImGui::SameLine(0.0f, ui.theme.px(3.0f));
        ImGui::PushID(so_far.c_str());
        if (ImGui::Button(part.c_str())) wanted = so_far;
        ImGui::PopID();
    }
    if (!wanted.empty()) enter(wanted);
}

void FileDialog::draw_entries(Ui& ui) {
    const float below =
        2.0f * ImGui::GetFrameHeightWithSpacing() + ImGui::GetTextLineHeightWithSpacing() + ui.theme.px(6.0f);
    ImGui::PushStyleColor(ImGuiCol_ChildBg, ImGui::GetColorU32(ImGuiCol_WindowBg));
    ImGui::BeginChild("entries", {0.0f, -below}, false, ImGuiWindowFlags_AlwaysUseWindowPadding);
    std::string wanted;
    for (const Entry& entry : entries_) {
        const std::string label = entry.folder ? entry.name + "/" : entry.name;
        ImGui::PushStyleColor(ImGuiCol_Text, entry.folder ? ui.theme.role(Role::primitive) : ui.theme.text);
        if (ImGui::Selectable(label.c_str(), text_ == entry.name,
                              ImGuiSelectableFlags_AllowDoubleClick | ImGuiSelectableFlags_DontClosePopups)) {
            const bool twice = ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left);
            focus_ = true;  // Enter accepts what was picked
            if (!entry.folder)
                text_ = entry.name, accepted_ = twice, picked_ = true, confirm_ = false;
            else if (twice)
                wanted = entry.name;
        }
        ui.report.item("dialog/entry", entry.name);
        ImGui::PopStyleColor();
    }
    if (entries_.empty()) ImGui::TextDisabled("No scenes (*%s) or folders here", extension);
    ImGui::EndChild();
    ImGui::PopStyleColor();
    if (!wanted.empty()) enter(folder_ / wanted);
}

std::optional<fs::path> FileDialog::draw(Ui& ui) {
    const char* title = mode_ == Mode::open ? "Open scene###file_dialog" : "Save scene as###file_dialog";
    if (request_) ImGui::OpenPopup(title);
    request_ = false;
    const ImVec2 centre = ImGui::GetMainViewport()->GetCenter();
    ImGui::SetNextWindowPos(centre, ImGuiCond_Appearing, {0.5f, 0.5f});
    const ImVec2 room = ImGui::GetMainViewport()->WorkSize;
    ImGui::SetNextWindowSizeConstraints({0.0f, 0.0f}, room);
    ImGui::SetNextWindowSize({std::min(ui.theme.px(620.0f), room.x), std::min(ui.theme.px(430.0f), room.y)},
                             ImGuiCond_Appearing);
    if (!ImGui::BeginPopupModal(title, nullptr, ImGuiWindowFlags_NoSavedSettings)) {
        focus_ = false;
        return std::nullopt;
    }

    draw_path_bar(ui);
    draw_entries(ui);
    if (focus_) ImGui::SetKeyboardFocusHere();
    focus_ = false;
    ImGui::SetNextItemWidth(-FLT_MIN);
    // A name that nobody typed gives way to the first key.
    const bool entered =
        ImGui::InputTextWithHint("##path", "File name or path", &text_,
                                 ImGuiInputTextFlags_EnterReturnsTrue |
                                     (picked_ ? ImGuiInputTextFlags_AutoSelectAll : ImGuiInputTextFlags_None));
    if (ImGui::IsItemEdited()) confirm_ = picked_ = false, problem_.clear();
    accepted_ |= entered;
    ui.report.item("dialog", "path");
    ImGui::PushStyleColor(ImGuiCol_Text, confirm_ ? ui.theme.accent : ui.theme.error);
    ImGui::TextUnformatted(confirm_ ? fmt::format("{} exists. Replace it?", typed().filename().string()).c_str()
                                    : problem_.c_str());
    ImGui::PopStyleColor();

    const char* action = mode_ == Mode::open ? "Open" : confirm_ ? "Replace" : "Save";
    const float width = ui.theme.px(96.0f);
    ImGui::SetCursorPosX(ImGui::GetWindowContentRegionMax().x - 2.0f * width - ImGui::GetStyle().ItemSpacing.x);
    const bool cancelled =
        ImGui::Button("Cancel", {width, 0.0f}) || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
    ui.report.item("dialog", "cancel");
    ImGui::SameLine();
    ImGui::BeginDisabled(text_.empty());
    accepted_ |= ImGui::Button(action, {width, 0.0f});
    ImGui::EndDisabled();
    ui.report.item("dialog", "ok");

    std::optional<fs::path> result;
    if (accepted_) {
        result = accept();
        focus_ = !result;
    }
    if (result || cancelled) {
        focus_ = false;
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
    return cancelled ? std::nullopt : result;
}

}  // namespace farfield
