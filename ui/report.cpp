#include "ui/report.h"

#include <nlohmann/json.hpp>

#include <fstream>

namespace farfield {

void Report::item(std::string_view panel, std::string_view name) {
    if (file_.empty() || !ImGui::IsItemVisible()) return;
    rectangle(panel, name, ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
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
    json["selection"] = state.selection;
    json["pictures"] = state.pictures;
    json["structural_compiles"] = s.structural_compiles;
    json["specialisations"] = s.specialisations;
    json["specialised"] = s.specialised;
    json["frames"] = s.frames;
    json["samples"] = s.samples;
    json["frame_milliseconds"] = s.frame_milliseconds;
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
