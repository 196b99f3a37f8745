#include "app/file_dialog.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace farfield {
namespace fs = std::filesystem;

namespace {

constexpr const char* scenes[] = {".json"};
constexpr const char* pictures[] = {".png", ".exr"};

bool pressed(ImGuiKey key, bool repeat = true) { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key), repeat); }

std::string size_text(std::uintmax_t bytes) {
    if (bytes < 1000) return fmt::format("{} B", bytes);
    if (bytes < 1'000'000) return fmt::format("{:.1f} kB", static_cast<double>(bytes) * 1e-3);
    return fmt::format("{:.1f} MB", static_cast<double>(bytes) * 1e-6);
}

std::string time_text(std::time_t time) {
    std::tm local{};
    return ::localtime_r(&time, &local) ? fmt::format("{:%d %b %Y  %H:%M}", local) : "";
}

}  // namespace

std::span<const char* const> FileDialog::extensions() const {
    return mode_ == Mode::picture ? std::span<const char* const>(pictures) : std::span<const char* const>(scenes);
}

void FileDialog::show(Mode mode, const fs::path& start) {
    mode_ = mode;
    request_ = focus_ = picked_ = true;
    accepted_ = confirm_ = false;
    thumbnails_.forget();
    std::error_code failed;
    fs::path from = start.empty() ? fs::current_path(failed) : fs::absolute(start, failed);
    const bool is_folder = fs::is_directory(from, failed);
    enter(is_folder ? from : from.parent_path());
    text_ = mode == Mode::open ? "" : is_folder ? std::string("untitled") + extensions()[0] : from.filename().string();
}

void FileDialog::enter(const fs::path& folder) {
    folder_ = folder.lexically_normal();
    if (folder_.has_relative_path() && !folder_.has_filename()) folder_ = folder_.parent_path();
    problem_ = list_.read(folder_, extensions());
    marked_.reset();
    search_.clear();
}

fs::path FileDialog::typed() const {
    fs::path path = text_;
    if (const char* home = std::getenv("HOME"); home && (text_ == "~" || text_.starts_with("~/")))
        path = fs::path(home) / (text_.size() > 2 ? text_.substr(2) : "");
    return (path.is_absolute() ? path : folder_ / path).lexically_normal();
}

bool FileDialog::searches() const {
    return mode_ == Mode::open && !picked_ && !text_.starts_with("~") && text_.find('/') == std::string::npos;
}

void FileDialog::mark(std::size_t row) {
    marked_ = row;
    reveal_ = true;
    text_ = list_[row].name;
    picked_ = focus_ = true;
    confirm_ = false;
    problem_.clear();
    ImGui::ClearActiveID();  // the field would keep what it holds
}

std::optional<fs::path> FileDialog::accept() {
    accepted_ = false;
    if (text_.empty()) return std::nullopt;
    std::error_code failed;
    if (searches() && !fs::exists(typed(), failed) && list_.size() > 0) text_ = list_[0].name;
    fs::path path = typed();
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
    if (!path.has_extension()) path += extensions()[0];
    if (mode_ == Mode::picture &&
        std::find(std::begin(pictures), std::end(pictures), path.extension()) == std::end(pictures)) {
        problem_ = fmt::format("A picture's name ends in {}", fmt::join(pictures, " or "));
        return std::nullopt;
    }
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

/// Up and Down go through the list while the path has the keyboard; Backspace in an empty path goes to the folder
/// above.
void FileDialog::keyboard() {
    if (text_.empty() && pressed(ImGuiKey_Backspace, false) && folder_.has_relative_path())
        enter(folder_.parent_path());
    const int page = 8;
    const int by = pressed(ImGuiKey_DownArrow)  ? 1
                   : pressed(ImGuiKey_UpArrow)  ? -1
                   : pressed(ImGuiKey_PageDown) ? page
                   : pressed(ImGuiKey_PageUp)   ? -page
                                                : 0;
    if (by == 0 || list_.size() == 0) return;
    const int last = static_cast<int>(list_.size()) - 1;
    const int row = marked_ ? std::clamp(static_cast<int>(*marked_) + by, 0, last) : by > 0 ? 0 : last;
    mark(static_cast<std::size_t>(row));
}

void FileDialog::draw_path_bar(Ui& ui, EditorState& state) {
    ImGui::BeginDisabled(!folder_.has_relative_path());
    if (ImGui::Button("Up")) enter(folder_.parent_path());
    ImGui::EndDisabled();
    ui.report.item("dialog", "up");
    const float end = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
    const float order = ui.theme.px(150.0f);
    // Each folder of the path is a button; of a long path the last ones.
    std::vector<fs::path> folders;
    for (const fs::path& part : folder_) folders.push_back(folders.empty() ? part : folders.back() / part);
    const auto label = [](const fs::path& path) { return path.has_filename() ? path.filename().string() : "/"; };
    const float gap = ui.theme.px(3.0f), padding = 2.0f * ImGui::GetStyle().FramePadding.x;
    float room = end - order - ImGui::GetItemRectMax().x - ui.theme.px(30.0f);
    std::size_t first = folders.size();
    while (first > 0 && (first == folders.size() || room > 0.0f)) {
        room -= ImGui::CalcTextSize(label(folders[first - 1]).c_str()).x + padding + gap;
        if (room <= 0.0f && first != folders.size()) break;
        --first;
    }
    fs::path wanted;
    if (first > 0) {
        ImGui::SameLine(0.0f, gap);
        ImGui::TextDisabled("...");
    }
    for (std::size_t i = first; i < folders.size(); ++i) {
        ImGui::SameLine(0.0f, gap);
        ImGui::PushID(folders[i].c_str());
        if (ImGui::Button(label(folders[i]).c_str())) wanted = folders[i];
        ui.report.item("dialog/folder", folders[i].string());
        ImGui::PopID();
    }
    if (!wanted.empty()) enter(wanted);

    ImGui::SameLine();
    ImGui::SetCursorPosX(ImGui::GetWindowContentRegionMax().x - order);
    ImGui::SetNextItemWidth(order);
    if (ImGui::BeginCombo("##order", state.newest_first ? "Newest first" : "By name")) {
        if (ImGui::Selectable("By name", !state.newest_first)) state.newest_first = false;
        ui.report.item("dialog/order", "name");
        if (ImGui::Selectable("Newest first", state.newest_first)) state.newest_first = true;
        ui.report.item("dialog/order", "time");
        ImGui::EndCombo();
        marked_.reset();
    }
    ui.report.item("dialog", "order");
}

void FileDialog::draw_recent(Ui& ui, const EditorState& state) {
    ImGui::TextDisabled("Recent");
    for (const fs::path& file : state.recent) {
        const float room = ImGui::GetContentRegionAvail().x;
        ImGui::PushID(file.c_str());
        if (ImGui::Selectable("##recent", false, ImGuiSelectableFlags_DontClosePopups, {room, 0.0f}))
            chosen_recent_ = file;
        const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
        ImDrawList& draw = *ImGui::GetWindowDrawList();
        draw.PushClipRect(low, high, true);
        draw.AddText({low.x + ui.theme.px(4.0f), low.y + ImGui::GetStyle().ItemSpacing.y * 0.5f}, ui.theme.text,
                     file.filename().c_str());
        draw.PopClipRect();
        ImGui::PopID();
        ui.report.item("dialog/recent", file.filename().string());
        tooltip(ui, file.string());
    }
}

void FileDialog::draw_row(const Ui& ui, const FolderEntry& entry, ImVec2 low, float height) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float pad = ui.theme.px(4.0f), line = ImGui::GetTextLineHeight();
    float x = low.x + pad;
    if (mode_ != Mode::picture) {
        const ImVec2 room{std::floor((height - 2.0f * pad) * 1.5f), height - 2.0f * pad}, corner{x, low.y + pad};
        if (entry.folder) {
            const float w = room.y * 1.05f, left = corner.x + (room.x - w) * 0.5f, top = corner.y + room.y * 0.14f;
            const ImU32 color = ui.theme.role(Role::primitive);
            draw.AddRectFilled({left, top}, {left + w * 0.45f, top + room.y * 0.3f}, color, pad * 0.5f);
            draw.AddRectFilled({left, top + room.y * 0.12f}, {left + w, top + room.y * 0.72f}, color, pad * 0.5f);
        } else {
            draw.AddRectFilled(corner, {corner.x + room.x, corner.y + room.y}, ui.theme.header, pad * 0.5f);
            if (const gl::Texture* picture = thumbnails_.find(folder_ / entry.name)) {
                const glm::vec2 size(picture->size());
                const float scale = std::min(room.x / size.x, room.y / size.y);
                const ImVec2 at{corner.x + (room.x - size.x * scale) * 0.5f,
                                corner.y + (room.y - size.y * scale) * 0.5f};
                draw.AddImage((ImTextureID) static_cast<std::intptr_t>(picture->name()), at,
                              {at.x + size.x * scale, at.y + size.y * scale});
            }
        }
        x += room.x + 2.5f * pad;
    }
    const bool two_lines = !entry.folder && height > 1.9f * line;
    const float y = low.y + std::floor((height - (two_lines ? 2.0f : 1.0f) * line) * 0.5f);
    draw.AddText({x, y}, entry.folder ? ui.theme.role(Role::primitive) : ui.theme.text, entry.name.c_str());
    if (two_lines)
        draw.AddText(ui.theme.small_font, ui.theme.small_font->FontSize, {x, y + line}, ui.theme.dim,
                     fmt::format("{}   {}", time_text(entry.time), size_text(entry.size)).c_str());
}

void FileDialog::draw_entries(Ui& ui) {
    const float height =
        std::floor(mode_ == Mode::picture ? ImGui::GetTextLineHeightWithSpacing() : ui.theme.px(46.0f));
    std::string wanted;
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0.0f, 0.0f});
    // Only what is in sight is drawn: a folder of ten thousand files costs what others cost.
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(list_.size()), height);
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
            const auto row = static_cast<std::size_t>(i);
            const FolderEntry& entry = list_[row];
            const ImVec2 low = ImGui::GetCursorScreenPos();
            ImGui::PushID(i);
            if (ImGui::Selectable("##row", marked_ == row || text_ == entry.name,
                                  ImGuiSelectableFlags_AllowDoubleClick | ImGuiSelectableFlags_DontClosePopups,
                                  {0.0f, height})) {
                const bool twice = ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left);
                if (entry.folder && twice)
                    wanted = entry.name;
                else if (entry.folder)
                    marked_ = row;
                else
                    mark(row), accepted_ = twice;
                focus_ = true;  // Enter accepts what was picked
                reveal_ = false;
            }
            ui.report.item("dialog/entry", entry.name);
            ImGui::PopID();
            draw_row(ui, entry, low, height);
        }
    clipper.End();
    ImGui::PopStyleVar();
    if (std::exchange(reveal_, false) && marked_) {
        const float top = height * static_cast<float>(*marked_), room = ImGui::GetWindowHeight() - 2.0f * height;
        ImGui::SetScrollY(std::clamp(ImGui::GetScrollY(), top - room, top));
    }
    if (list_.size() == 0)
        ImGui::TextDisabled(
            "%s", !search_.empty()
                      ? "No such name here"
                      : fmt::format("No files (*{}) or folders here", fmt::join(extensions(), ", *")).c_str());
    if (!wanted.empty()) enter(folder_ / wanted);
}

/// The field and what is said about it; true when Enter was pressed in it.
bool FileDialog::draw_path(Ui& ui) {
    if (focus_) ImGui::SetKeyboardFocusHere();
    focus_ = false;
    ImGui::SetNextItemWidth(-FLT_MIN);
    // A name that nobody typed gives way to the first key.
    const bool entered = ImGui::InputTextWithHint(
        "##path", mode_ == Mode::open ? "Search, file name or path" : "File name or path", &text_,
        ImGuiInputTextFlags_EnterReturnsTrue |
            (picked_ ? ImGuiInputTextFlags_AutoSelectAll : ImGuiInputTextFlags_None));
    if (ImGui::IsItemEdited()) {
        confirm_ = picked_ = false;
        problem_.clear();
        marked_.reset();
        search_ = searches() ? text_ : "";
    }
    ui.report.item("dialog", "path");
    std::string said = problem_;
    ImU32 color = ui.theme.error;
    if (confirm_) {
        said = fmt::format("{} exists. Replace it?", typed().filename().string());
        color = ui.theme.accent;
    } else if (said.empty() && mode_ == Mode::picture) {
        said = "PNG: as shown, 8 bits.  EXR: linear, every view a layer.";
        color = ui.theme.dim;
    }
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::TextUnformatted(said.c_str());
    ImGui::PopStyleColor();
    return entered;
}

std::optional<fs::path> FileDialog::draw(Ui& ui, EditorState& state) {
    constexpr const char* titles[] = {"Open scene###file_dialog", "Save scene as###file_dialog",
                                      "Export picture###file_dialog"};
    const char* title = titles[static_cast<int>(mode_)];
    if (request_ && may_open_dialog()) {
        request_ = false;
        ImGui::OpenPopup(title);
    }
    const ImVec2 centre = ImGui::GetMainViewport()->GetCenter();
    ImGui::SetNextWindowPos(centre, ImGuiCond_Appearing, {0.5f, 0.5f});
    const ImVec2 room = ImGui::GetMainViewport()->WorkSize;
    ImGui::SetNextWindowSizeConstraints({0.0f, 0.0f}, room);
    ImGui::SetNextWindowSize({std::min(ui.theme.px(760.0f), room.x), std::min(ui.theme.px(520.0f), room.y)},
                             ImGuiCond_Appearing);
    if (!ImGui::BeginPopupModal(title, nullptr, ImGuiWindowFlags_NoSavedSettings)) {
        focus_ = request_;
        return std::nullopt;
    }
    keyboard();
    thumbnails_.begin_frame();
    list_.filter(search_);
    list_.sort(state.newest_first);

    draw_path_bar(ui, state);
    const float below =
        2.0f * ImGui::GetFrameHeightWithSpacing() + ImGui::GetTextLineHeightWithSpacing() + ui.theme.px(6.0f);
    ImGui::PushStyleColor(ImGuiCol_ChildBg, ImGui::GetColorU32(ImGuiCol_WindowBg));
    chosen_recent_.clear();
    if (mode_ == Mode::open && !state.recent.empty()) {
        ImGui::BeginChild("recent", {ui.theme.px(170.0f), -below}, false, ImGuiWindowFlags_AlwaysUseWindowPadding);
        draw_recent(ui, state);
        ImGui::EndChild();
        ImGui::SameLine();
    }
    ImGui::BeginChild("entries", {0.0f, -below}, false, ImGuiWindowFlags_AlwaysUseWindowPadding);
    draw_entries(ui);
    ImGui::EndChild();
    ImGui::PopStyleColor();
    accepted_ |= draw_path(ui);

    const char* action = mode_ == Mode::open ? "Open" : confirm_ ? "Replace" : mode_ == Mode::save ? "Save" : "Export";
    const float width = ui.theme.px(96.0f);
    ImGui::SetCursorPosX(ImGui::GetWindowContentRegionMax().x - 2.0f * width - ImGui::GetStyle().ItemSpacing.x);
    const bool cancelled = ImGui::Button("Cancel", {width, 0.0f}) || pressed(ImGuiKey_Escape);
    ui.report.item("dialog", "cancel");
    ImGui::SameLine();
    ImGui::BeginDisabled(text_.empty());
    accepted_ |= ImGui::Button(action, {width, 0.0f});
    ImGui::EndDisabled();
    ui.report.item("dialog", "ok");

    std::optional<fs::path> result;
    if (!chosen_recent_.empty()) {
        result = chosen_recent_;
    } else if (accepted_) {
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
