#include "ui/settings_panel.h"

#include "ui/value_row.h"

#include <fmt/format.h>

#include <string_view>

namespace farfield {
namespace {

/// What a slider spans: the limits of the parameter, or the useful part of those that are nearly unlimited.
SliderRange slider_range(const Parameter& parameter) {
    using namespace std::string_view_literals;
    if (parameter.key == "ao_radius"sv) return {0.01f, 10.0f, true};
    if (parameter.key == "noise"sv) return {0.5f, 50.0f, true};
    if (parameter.key == "exposure"sv) return {-6.0f, 6.0f};
    return {parameter.lowest(), parameter.maximum};
}

void view_row(Ui& ui) {
    row_label(ui, "View", ui.view != View::result);
    const ViewInfo& shown = views()[static_cast<std::size_t>(ui.view)];
    const bool open = ImGui::BeginCombo("##view", shown.label, ImGuiComboFlags_HeightLargest);
    ui.report.item("settings", "view");
    if (!open) {
        tooltip(ui, shown.tip, "Number keys 1 to 9 switch views");
        return;
    }
    for (const ViewInfo& v : views()) {
        if (ImGui::Selectable(fmt::format("{}   {}", static_cast<int>(v.view) + 1, v.label).c_str(), v.view == ui.view))
            ui.view = v.view;
        ui.report.item("view", v.key);
        tooltip(ui, v.tip);
    }
    ImGui::EndCombo();
}

/// What the bounces are and what one more would add.
void bounces_row(Ui& ui, const Statistics& statistics) {
    const std::string text = bounces_text(statistics);
    row_label(ui, "", false);
    ImGui::PushFont(ui.theme.small_font);
    ImGui::TextDisabled("%s", text.c_str());
    ImGui::PopFont();
    ui.report.item("settings", "bounces/next");
    tooltip(ui, "What one more bounce would add to the mean of indirect light, measured on 4,096 paths");
}

}  // namespace

Edits settings_panel(Ui& ui, const Scene& scene, const Statistics& statistics) {
    using namespace std::string_view_literals;
    Edits edits;
    panel_title(ui, "Render");
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ui.theme.px(10.0f), ui.theme.px(8.0f)});
    begin_rows();
    view_row(ui);
    const ObjectRef settings{ObjectType::settings, 0};
    for (const Parameter& parameter : parameters(scene, settings)) {
        const SliderRange range = slider_range(parameter);
        if (const auto changed = value_row(ui, "settings", parameter, value(scene, settings, parameter.key), &range))
            edits.push_back(SetValue{settings, parameter.key, *changed});
        if (parameter.key == "bounces"sv) bounces_row(ui, statistics);
    }
    ImGui::EndChild();
    ImGui::PopStyleVar();
    return edits;
}

}  // namespace farfield
