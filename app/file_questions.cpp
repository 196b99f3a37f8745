// What is asked about files, each in a dialog of its own, one at a time.
#include "app/file_actions.h"

#include "sdf/scene_file.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <unordered_set>

namespace farfield {
namespace {

/// Shows the dialog as soon as no other is open and nothing is being dragged.
void open_question(const char* title) {
    if (may_open_dialog() && !ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel))
        ImGui::OpenPopup(title);
}

/// Begins the dialog while it `asks`; then EndPopup is to be called.
bool begin_question(const char* title, bool asks) {
    if (asks) open_question(title);
    ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Always, {0.5f, 0.5f});
    if (!ImGui::BeginPopupModal(
            title, nullptr,
            ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove))
        return false;
    if (asks) return true;
    ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
    return false;
}

bool escape() { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)); }

bool button(Ui& ui, const char* label, const char* question, const char* answer) {
    const bool pressed = ImGui::Button(label, {ui.theme.px(124.0f), 0.0f});
    ui.report.item(question, answer);
    return pressed;
}

/// "14:03", with the day where it is not today's.
std::string time_text(std::int64_t seconds) {
    const auto then = static_cast<std::time_t>(seconds), now = std::time(nullptr);
    std::tm time{}, today{};
    if (!::localtime_r(&then, &time) || !::localtime_r(&now, &today)) return "";
    const bool same_day = time.tm_yday == today.tm_yday && time.tm_year == today.tm_year;
    return same_day ? fmt::format("today {:%H:%M:%S}", time) : fmt::format("{:%d %b %Y  %H:%M}", time);
}

}  // namespace

void FileActions::ask_about_code(Ui& ui) {
    const char* title = "Code from elsewhere";
    if (!foreign_) return;
    open_question(title);
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
    if (run || without || cancel) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
    if (!run && !without && !cancel) return;
    Foreign answered = *std::exchange(foreign_, std::nullopt);
    if (cancel) return;
    if (answered.reload)
        reload(std::move(answered.scene));
    else
        show(std::move(answered.scene), answered.file, answered.text);
}

void FileActions::ask_about_unsaved(Ui& ui) {
    if (!begin_question("Unsaved changes", waiting_ != nullptr)) return;
    const bool saved = document_.saved();
    if (!saved) ImGui::Text("%s has changes that are not saved.", document_.name().c_str());
    if (!drafts_.empty()) {
        std::string names;
        for (const auto& [id, text] : drafts_)
            if (const Node* node = find_node(document_.scene(), id))
                names += fmt::format("{}{}", names.empty() ? "" : ", ", display_name(*node));
        ImGui::TextUnformatted(fmt::format("The code of {} was changed and not compiled.", names).c_str());
        ImGui::TextDisabled("A file keeps compiled code alone. Cancel, and press Ctrl+Enter in the code, to keep it.");
    }
    ImGui::Dummy({0.0f, ui.theme.px(6.0f)});
    bool save_first = false;
    if (!saved) {
        save_first = button(ui, "Save", "unsaved", "save");
        ImGui::SameLine();
    }
    const bool discard = button(ui, "Discard", "unsaved", "discard");
    ImGui::SameLine();
    const bool cancel = button(ui, "Cancel", "unsaved", "cancel") || escape();
    Action then;
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
    } else if (save_first && (outdated_ || watch_.is_other_now())) {
        asked_ = AboutFile::replace;
        after_save_ = std::move(then);
    } else if (save_first && write(document_.file())) {
        then();
    }
}

void FileActions::ask_about_file(Ui& ui) {
    if (!begin_question("Changed by another program", asked_ != AboutFile::nothing)) return;
    const bool replace = asked_ == AboutFile::replace;
    ImGui::TextUnformatted(
        fmt::format("Another program has written {}{}", document_.name(),
                    replace ? ".\nSaving replaces what it wrote." : ",\nand there are changes here that are not saved.")
            .c_str());
    ImGui::TextDisabled("Taking theirs is a step that undo takes back.");
    ImGui::Dummy({0.0f, ui.theme.px(6.0f)});
    const bool theirs = button(ui, "Take theirs", "changed", "theirs");
    ImGui::SameLine();
    const bool mine = button(ui, replace ? "Replace theirs" : "Keep mine", "changed", "mine");
    bool cancel = false;
    if (replace) {
        ImGui::SameLine();
        cancel = button(ui, "Cancel", "changed", "cancel") || escape();
    }
    if (theirs || mine || cancel) {
        asked_ = AboutFile::nothing;
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
    const Action then = theirs || mine || cancel ? std::exchange(after_save_, nullptr) : nullptr;
    if (theirs) {
        try {
            take_theirs(load_scene(document_.file()));
        } catch (const SceneFileError& error) {
            fail(About::opening, error.what());
        }
    } else if (mine && replace) {
        if (write(document_.file()) && then) then();
    } else if (mine) {
        outdated_ = false;
        document_.set_file_lost(true);  // what is on disk is not what was saved
    }
}

void FileActions::ask_about_left(Ui& ui) {
    if (!begin_question("Work from before a crash", recovering_)) return;
    ImGui::TextUnformatted("Farfield ended without saving this. What was done until a few seconds before is here:");
    ImGui::Dummy({0.0f, ui.theme.px(4.0f)});
    std::optional<LeftWork> wanted;
    if (ImGui::BeginTable("left", 4, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg)) {
        for (std::size_t i = 0; i < left_.size(); ++i) {
            const LeftWork& work = left_[i];
            const std::string number = fmt::format("{}", i);
            const bool unwanted = unwanted_.contains(work.copy);
            ImGui::PushID(number.c_str());
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            ImGui::AlignTextToFramePadding();
            ImGui::PushStyleColor(ImGuiCol_Text, unwanted ? ui.theme.dim : ui.theme.text);
            ImGui::TextUnformatted(work.file.empty() ? "untitled" : work.file.filename().c_str());
            ImGui::PopStyleColor();
            tooltip(ui, work.file.empty() ? "It was never saved to a file" : work.file.string());
            ImGui::TableNextColumn();
            ImGui::TextDisabled("%s", time_text(work.time).c_str());
            ImGui::TableNextColumn();
            ImGui::TextDisabled("%d %s", work.nodes, work.nodes == 1 ? "node" : "nodes");
            ImGui::TableNextColumn();
            if (button(ui, "Recover", "recover/open", number.c_str())) wanted = work;
            ImGui::SameLine();
            if (button(ui, unwanted ? "Keep it" : "Discard", "recover/discard", number.c_str()))
                unwanted ? void(unwanted_.erase(work.copy)) : void(unwanted_.insert(work.copy));
            ImGui::PopID();
        }
        ImGui::EndTable();
    }
    ImGui::Dummy({0.0f, ui.theme.px(4.0f)});
    const bool all = unwanted_.size() == left_.size();
    const bool escaped = escape();
    const char* label = all ? "Discard all" : unwanted_.empty() ? "Later" : "Done";
    const bool close = button(ui, label, "recover", "later") || escaped;
    if (unwanted_.empty()) {
        ImGui::SameLine();
        ImGui::TextDisabled("File, Recover unsaved work asks again");
    }
    if (wanted || close) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
    if (!wanted && !close) return;
    recovering_ = false;
    if (escaped) unwanted_.clear();
    if (wanted) unwanted_.erase(wanted->copy);
    for (const LeftWork& work : left_)
        if (unwanted_.contains(work.copy)) autosave_.discard(work);
    unwanted_.clear();
    left_ = autosave_.left();
    if (wanted) unless_unsaved([this, work = *wanted] { recover(work); });
}

}  // namespace farfield
