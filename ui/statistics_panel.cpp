#include "ui/statistics_panel.h"

#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>

namespace farfield {
namespace {

std::string duration(double ms) {
    if (ms >= 1e4) return fmt::format("{:.1f} s", ms * 1e-3);
    return ms < 10.0 ? fmt::format("{:.2f} ms", ms) : fmt::format("{:.0f} ms", ms);
}

std::string count(std::uint64_t n) {
    if (n < 10'000) return fmt::format("{}", n);
    return n < 1'000'000 ? fmt::format("{:.1f} k", static_cast<double>(n) * 1e-3)
                         : fmt::format("{:.1f} M", static_cast<double>(n) * 1e-6);
}

void line(const Ui& ui, const char* label, const std::string& value, bool strong = false) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::PushStyleColor(ImGuiCol_Text, strong ? ui.theme.text : ui.theme.dim);
    ImGui::TextUnformatted(label);
    ImGui::PopStyleColor();
    ImGui::TableNextColumn();
    const float width = ImGui::CalcTextSize(value.c_str()).x;
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(0.0f, ImGui::GetContentRegionAvail().x - width));
    ImGui::TextUnformatted(value.c_str());
}

}  // namespace

void statistics_overlay(Ui& ui, const Statistics& s, ImVec2 corner, ImVec2 room) {
    const float width = ui.theme.px(212.0f);
    // A question that waits for its answer is not covered.
    if (room.x < width || room.y < ui.theme.px(60.0f) || ImGui::GetTopMostPopupModal()) return;
    ImGui::SetNextWindowPos({corner.x - width, corner.y});
    ImGui::SetNextWindowSizeConstraints({width, 0.0f}, {width, room.y});
    ImGui::PushStyleColor(ImGuiCol_WindowBg, ui.theme.overlay);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
    ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, {ui.theme.px(2.0f), ui.theme.px(1.0f)});
    ImGui::PushFont(ui.theme.small_font);
    const ImGuiWindowFlags flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                                   ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoFocusOnAppearing |
                                   ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoSavedSettings;
    ImGui::Begin("##statistics", nullptr, flags);
    if (ImGui::BeginTable("lines", 2, ImGuiTableFlags_SizingStretchProp)) {
        line(ui, "Samples", fmt::format("{}  ({} {})", s.samples, s.frames, s.frames == 1 ? "frame" : "frames"), true);
        line(ui, "Speed", fmt::format("{:.{}f} frames/s", s.frames_per_second, s.frames_per_second < 1.0 ? 2 : 1),
             true);
        line(ui, "Frame", duration(s.frame_milliseconds), true);
        for (const PassTime& pass : s.passes) line(ui, ("   " + pass.name).c_str(), duration(pass.milliseconds));
        if (s.rays > 0) line(ui, "Rays", count(s.rays), true);
        if (s.exhausted_rays > 0) line(ui, "   out of steps", count(s.exhausted_rays));
        line(ui, "Edit to picture", duration(s.edit_milliseconds), true);
        line(ui, "Interface, 95 %", duration(ui.frame_milliseconds));
        line(ui, "Compile", duration(s.compile_milliseconds), true);
        line(ui, "   for structure", fmt::format("{}", s.structural_compiles));
        line(ui, "   specialised", fmt::format("{}{}", s.specialisations, s.specialised ? "  (in use)" : ""));
        ImGui::EndTable();
    }
    if (!s.device.empty()) {
        ImGui::PushTextWrapPos(0.0f);
        ImGui::TextDisabled("%s", s.device.c_str());
        ImGui::PopTextWrapPos();
    }
    ImGui::End();
    ImGui::PopFont();
    ImGui::PopStyleVar(2);
    ImGui::PopStyleColor();
}

}  // namespace farfield
