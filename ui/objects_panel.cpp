#include "ui/objects_panel.h"

#include "ui/value_row.h"

namespace farfield {
namespace {

/// One selectable line with a swatch. `color` null: no swatch.
void row(Ui& ui, const char* group, ObjectRef object, const std::string& name, const ImVec4* color, const char* note) {
    ImGui::PushID(static_cast<int>(object.type));
    ImGui::PushID(static_cast<int>(object.id));
    const ImVec2 start = ImGui::GetCursorScreenPos();
    if (ImGui::Selectable("##row", ui.selection == object, ImGuiSelectableFlags_AllowDoubleClick,
                          {0.0f, ImGui::GetTextLineHeight()})) {
        ui.selection = object;
        if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left) && object.id != 0) ui.focus_name = true;
    }
    if (object.id != 0 && ui.reveal == object.id) {
        ImGui::SetScrollHereY();
        ui.reveal = 0;
    }
    ui.report.item(group, name);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImVec2 high = ImGui::GetItemRectMax();
    const float side = ui.theme.px(11.0f), y = start.y + ImGui::GetTextLineHeight() * 0.5f;
    if (color)
        draw.AddRectFilled({start.x + ui.theme.px(5.0f), y - side * 0.5f},
                           {start.x + ui.theme.px(5.0f) + side, y + side * 0.5f},
                           ImGui::ColorConvertFloat4ToU32(*color), ui.theme.px(2.5f));
    draw.AddText({start.x + ui.theme.px(23.0f), start.y}, ui.theme.text, name.c_str());
    ImFont* font = ui.theme.small_font;
    const float width = font->CalcTextSizeA(font->FontSize, 1e6f, 0.0f, note).x;
    if (high.x - width - ui.theme.px(8.0f) > start.x + ui.theme.px(31.0f) + ImGui::CalcTextSize(name.c_str()).x)
        draw.AddText(font, font->FontSize, {high.x - width - ui.theme.px(8.0f), y - font->FontSize * 0.5f},
                     ui.theme.dim, note);
    ImGui::PopID();
    ImGui::PopID();
}

}  // namespace

Edits objects_panel(Ui& ui, const Scene& scene) {
    Edits edits;
    panel_title(ui, "Light and materials");
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ui.theme.px(8.0f), ui.theme.px(2.0f)});
    ImGui::BeginChild("rows", {0.0f, 0.0f}, false, ImGuiWindowFlags_AlwaysUseWindowPadding);
    section(ui, "World");
    const ImVec4 sky = display_color(scene.sky.zenith);
    row(ui, "world", {ObjectType::sky, 0}, "Sky", &sky, "");
    row(ui, "world", {ObjectType::camera, 0}, "Camera", nullptr, "");
    if (heading(ui, "Lights", "objects", "add_light", "Adds a point light")) edits.push_back(AddLight{});
    for (const Light& light : scene.lights) {
        const ImVec4 color = display_color(light.intensity);
        row(ui, "lights", {ObjectType::light, light.id}, light.name, &color,
            light_kind_keys[static_cast<int>(light.kind)]);
    }
    if (scene.lights.empty()) {
        ImGui::PushTextWrapPos(0.0f);
        ImGui::TextDisabled("None. Sky and emission still light the scene.");
        ImGui::PopTextWrapPos();
    }
    if (heading(ui, "Materials", "objects", "add_material", "Adds a material")) edits.push_back(AddMaterial{});
    for (const Material& material : scene.materials) {
        const bool emits = material.emission != glm::vec3(0.0f);
        const ImVec4 color = display_color(emits ? material.emission : material.albedo);
        row(ui, "materials", {ObjectType::material, material.id}, material.name, &color, emits ? "emits" : "");
    }
    ImGui::EndChild();
    ImGui::PopStyleVar();
    return edits;
}

}  // namespace farfield
