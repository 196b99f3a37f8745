#include "ui/report.h"

#include <imgui_internal.h>
#include <nlohmann/json.hpp>

#include <fstream>

namespace farfield {

void Report::item(std::string_view panel, std::string_view name) {
    if (file_.empty()) return;
    // What has just appeared is laid out for a frame before it is shown in its place.
    if (const ImGuiWindow* window = ImGui::GetCurrentWindowRead(); window->Hidden || window->RootWindow->Hidden) return;
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const ImVec2 middle{(low.x + high.x) * 0.5f, (low.y + high.y) * 0.5f};
    const ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImVec2 clip_low = draw.GetClipRectMin(), clip_high = draw.GetClipRectMax();
    if (middle.x < clip_low.x || middle.y < clip_low.y || middle.x >= clip_high.x || middle.y >= clip_high.y) return;
    rectangle(panel, name, low, high);
}

void Report::rectangle(std::string_view panel, std::string_view name, ImVec2 low, ImVec2 high) {
    if (file_.empty()) return;
    std::string key(panel);
    if (!name.empty()) key.append("/").append(name);
    const auto whole = [](float v) { return static_cast<int>(v); };
    controls_[std::move(key)] = {whole(low.x), whole(low.y), whole(high.x - low.x), whole(high.y - low.y)};
}

void Report::write(const ReportState& state, double now) {
    if (file_.empty() || now - last_write_ < 0.1) return;
    nlohmann::ordered_json json;
    const Statistics& s = state.statistics;
    json["revision"] = state.revision;
    json["saved"] = state.saved;
    json["file"] = state.file;
    json["error"] = state.error;
    json["notice"] = state.notice;
    json["selection"] = state.selection;
    json["selected"] = state.selected;
    json["step"] = state.step;
    if (state.code)
        json["code"] = {
            {"lines", state.code_lines}, {"selected", state.selected_lines}, {"inside", state.inside_lines}};
    json["typing"] = ImGui::GetIO().WantTextInput;
    json["pictures"] = state.pictures;
    json["view"] = state.view;
    json["beside"] = state.beside;
    json["structural_compiles"] = s.structural_compiles;
    json["specialisations"] = s.specialisations;
    json["specialised"] = s.specialised;
    json["frames"] = s.frames;
    json["samples"] = s.samples;
    json["frame_milliseconds"] = s.frame_milliseconds;
    json["ui_milliseconds"] = state.ui_milliseconds;
    json["edit_milliseconds"] = s.edit_milliseconds;
    for (const auto& [name, r] : controls_) json["controls"][name] = {r.x, r.y, r.width, r.height};
    // Names come from files and may hold anything: invalid UTF-8 is replaced.
    const std::string text = json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    if (text == written_) return;
    std::filesystem::path temporary = file_;
    temporary += ".tmp";
    std::ofstream(temporary, std::ios::binary) << text << '\n';
    std::error_code ignored;  // a report that cannot be written is no reason to stop editing
    std::filesystem::rename(temporary, file_, ignored);
    written_ = text;
    last_write_ = now;
}

}  // namespace farfield
