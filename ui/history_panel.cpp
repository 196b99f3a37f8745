#include "ui/history_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace farfield {

std::optional<std::size_t> history_panel(Ui& ui, const History& history) {
    if (!ui.show_history) return std::nullopt;
    std::optional<std::size_t> wanted;
    const ImGuiViewport& screen = *ImGui::GetMainViewport();
    ImGui::SetNextWindowPos({screen.WorkPos.x + ui.theme.px(270.0f), screen.WorkPos.y + ui.theme.px(60.0f)},
                            ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize({ui.theme.px(270.0f), ui.theme.px(330.0f)}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSizeConstraints({ui.theme.px(180.0f), ui.theme.px(120.0f)}, {FLT_MAX, FLT_MAX});
    if (ImGui::Begin("History", &ui.show_history, ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoCollapse)) {
        // The current step comes into sight whenever it has become another.
        ImGuiStorage& storage = *ImGui::GetStateStorage();
        const ImGuiID last = ImGui::GetID("last");
        const int position = static_cast<int>(history.position());
        const bool moved = storage.GetInt(last, -1) != position;
        storage.SetInt(last, position);
        ImGuiListClipper clipper;
        clipper.Begin(static_cast<int>(history.size()) + 1);
        if (moved) clipper.ForceDisplayRangeByIndices(position, position + 1);
        while (clipper.Step())
            for (int step = clipper.DisplayStart; step < clipper.DisplayEnd; ++step) {
                std::string label =
                    step == 0 ? "As it was opened" : history.description(static_cast<std::size_t>(step));
                label[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(label[0])));
                ImGui::PushID(step);
                ImGui::PushStyleColor(ImGuiCol_Text, step == position  ? ui.theme.accent
                                                     : step > position ? ui.theme.dim
                                                                       : ui.theme.text);
                if (ImGui::Selectable("##step", step == position)) wanted = static_cast<std::size_t>(step);
                ui.report.item("history", fmt::format("{}", step));
                if (moved && step == position) ImGui::SetScrollHereY();
                const ImVec2 low = ImGui::GetItemRectMin();
                // Drawn by hand: a name may hold what ImGui reads as an id.
                ImGui::GetWindowDrawList()->AddText(
                    {low.x + ui.theme.px(6.0f), low.y + ImGui::GetStyle().ItemSpacing.y * 0.5f},
                    ImGui::GetColorU32(ImGuiCol_Text), label.c_str());
                ImGui::PopStyleColor();
                ImGui::PopID();
            }
    }
    ImGui::End();
    return wanted;
}

}  // namespace farfield
