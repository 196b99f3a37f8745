#include "ui/objects_panel.h"

#include "ui/material_edits.h"
#include "ui/tree_edits.h"
#include "ui/value_row.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace farfield {
namespace {

/// A selectable line with a swatch, a name and a note at its end. `color` null: no swatch.
class Row {
public:
    Row(Ui& ui, const char* group, ObjectRef object, const std::string& name, const ImVec4* color) : ui_(ui) {
        ImGui::PushID(static_cast<int>(object.type));
        ImGui::PushID(static_cast<int>(object.id));
        low_ = ImGui::GetCursorScreenPos();
        ImGui::PushStyleColor(
            ImGuiCol_HeaderHovered,
            ImGui::GetColorU32(ui.selection == object ? ImGuiCol_HeaderActive : ImGuiCol_HeaderHovered));
        pressed_ = ImGui::Selectable("##row", ui.selection == object, ImGuiSelectableFlags_AllowDoubleClick,
                                     {0.0f, ImGui::GetTextLineHeight()});
        ImGui::PopStyleColor();
        high_ = ImGui::GetItemRectMax();
        hovered_ = ImGui::IsItemHovered();
        if (object.id != 0 && ui.reveal == object.id) {
            ImGui::SetScrollHereY();
            ui.reveal = 0;
        }
        ui.report.item(group, name);
        ImDrawList& draw = *ImGui::GetWindowDrawList();
        const float side = ui.theme.px(11.0f), left = low_.x + ui.theme.px(5.0f), y = middle();
        if (color)
            draw.AddRectFilled({left, y - side * 0.5f}, {left + side, y + side * 0.5f},
                               ImGui::ColorConvertFloat4ToU32(*color), ui.theme.px(2.5f));
        draw.AddText({low_.x + ui.theme.px(23.0f), low_.y}, ui.theme.text, name.c_str());
        name_end_ = low_.x + ui.theme.px(31.0f) + ImGui::CalcTextSize(name.c_str()).x;
    }
    ~Row() {
        ImGui::PopID();
        ImGui::PopID();
    }
    Row(const Row&) = delete;
    Row& operator=(const Row&) = delete;

    bool hovered() const { return hovered_; }
    bool pressed() const { return pressed_; }

    /// At the end, where the name leaves room. Returns where it begins.
    float note(const char* text, ImU32 color) const {
        ImFont* font = ui_.theme.small_font;
        const float width = font->CalcTextSizeA(font->FontSize, 1e6f, 0.0f, text).x;
        const float from = high_.x - width - ui_.theme.px(8.0f);
        if (from > name_end_)
            ImGui::GetWindowDrawList()->AddText(font, font->FontSize, {from, middle() - font->FontSize * 0.5f}, color,
                                                text);
        return from;
    }

    /// A press selects, another names what has a name.
    void select(ObjectRef object) const {
        ui_.selection = object;
        if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left) && object.id != 0) ui_.focus_name = true;
    }

private:
    float middle() const { return low_.y + ImGui::GetTextLineHeight() * 0.5f; }

    Ui& ui_;
    ImVec2 low_, high_;
    float name_end_ = 0.0f;
    bool pressed_ = false, hovered_ = false;
};

void world_row(Ui& ui, ObjectRef object, const char* name, const ImVec4* color) {
    const Row row(ui, "world", object, name, color);
    if (row.pressed()) row.select(object);
}

/// What a menu of lights and materials ends with. `edits` is what comes of it.
void common_entries(Ui& ui, const Scene& scene, ObjectRef object, Edits& edits) {
    const auto entry = [&](const char* label, const char* key, Edits of_entry) {
        if (ImGui::MenuItem(label, key, false, !of_entry.empty())) edits = std::move(of_entry);
        ui.report.item("context", label);
    };
    entry("Duplicate", ui.selection == object ? "Ctrl+D" : "", duplicate_selection(scene, select(object)));
    if (ImGui::MenuItem("Rename")) {
        ui.select(select(object));
        ui.focus_name = true;
    }
    ui.report.item("context", "Rename");
    ImGui::Separator();
    entry("Delete", ui.selection == object ? "Del" : "", delete_selection(scene, select(object)));
}

void light_row(Ui& ui, const Scene& scene, const Light& light, Edits& edits) {
    const ObjectRef object{ObjectType::light, light.id};
    const ImVec4 color = display_color(light.intensity);
    const Row row(ui, "lights", object, light.name, &color);
    if (row.pressed()) row.select(object);
    if (ImGui::IsItemClicked(ImGuiMouseButton_Right)) ImGui::OpenPopup("menu");
    row.note(light_kind_keys[static_cast<int>(light.kind)], ui.theme.dim);
    const PopupMenu menu(ui, "menu");
    if (menu.is_open()) common_entries(ui, scene, object, edits);
}

void material_menu(Ui& ui, const Scene& scene, const Material& material, int uses, Edits& edits) {
    const PopupMenu menu(ui, "menu");
    if (!menu.is_open()) return;
    const std::string users = uses == 1 ? "Select its node" : fmt::format("Select its {} nodes", uses);
    if (ImGui::MenuItem(uses == 0 ? "Select its nodes" : users.c_str(), "", false, uses > 0))
        ui.select(select(material_users(scene, material.id)));
    ui.report.item("context", "users");
    Edits given = give_material(scene, ui.selected(), material.id);
    if (ImGui::MenuItem("Give to what is selected", "", false, !given.empty())) edits = std::move(given);
    ui.report.item("context", "give");
    ImGui::Separator();
    common_entries(ui, scene, {ObjectType::material, material.id}, edits);
}

/// A press selects it; on the word at the end, which comes under the mouse while nodes are selected that do not have
/// it, they get it. It can be dragged onto nodes.
void material_row(Ui& ui, const Scene& scene, const Material& material, int uses, Edits& edits) {
    const ObjectRef object{ObjectType::material, material.id};
    const bool emits = material.emission != glm::vec3(0.0f);
    const ImVec4 color = display_color(emits ? material.emission : material.albedo);
    const Row row(ui, "materials", object, material.name, &color);
    if (ImGui::IsItemClicked(ImGuiMouseButton_Right)) ImGui::OpenPopup("menu");
    if (ImGui::BeginDragDropSource()) {
        ImGui::SetDragDropPayload(material_payload, &material.id, sizeof material.id);
        const float side = ImGui::GetTextLineHeight();
        ImGui::ColorButton("##swatch", color, ImGuiColorEditFlags_NoTooltip, {side, side});
        ImGui::SameLine();
        ImGui::TextUnformatted(material.name.c_str());
        ImGui::EndDragDropSource();
    }
    Edits given = row.hovered() ? give_material(scene, ui.selected(), material.id) : Edits{};
    const bool first = &material == scene.materials.data();
    const std::string note = fmt::format("{}{}", emits ? "emits   " : "",
                                         !first      ? fmt::format("{}", uses)
                                         : uses == 0 ? "all others"
                                                     : fmt::format("{} + others", uses));
    const float from = given.empty() ? row.note(note.c_str(), ui.theme.dim) : row.note("assign", ui.theme.accent);
    const bool assigns = !given.empty() && ImGui::GetIO().MousePos.x >= from;
    if (row.pressed() && assigns)
        edits = std::move(given);
    else if (row.pressed())
        row.select(object);
    if (assigns)
        tooltip(ui, "Gives it to what is selected");
    else if (row.hovered() && given.empty())  // or it would lie on the word
        tooltip(ui,
                fmt::format("{} {} it{}. Drag it onto a shape in the picture or in the tree.", uses,
                            uses == 1 ? "node has" : "nodes have", first ? ", and all that have none" : ""),
                "Right-click for more");
    material_menu(ui, scene, material, uses, edits);
}

}  // namespace

Light light_in_view(const Camera& camera) {
    const auto rounded = [](float v, float unit) { return std::round(v / unit) * unit; };
    const glm::vec3 back = camera.position - camera.target;
    const float distance = std::clamp(glm::length(back), 1e-4f, 1e4f);
    const float unit = std::pow(10.0f, std::floor(std::log10(distance)) - 1.0f);
    Light light;
    const glm::vec3 position = camera.target + 0.25f * back + glm::vec3(0.0f, 0.2f * distance, 0.0f);
    for (int axis = 0; axis < 3; ++axis) light.position[axis] = rounded(position[axis], unit);
    // As bright on what is looked at however far that is.
    light.intensity = glm::vec3(rounded(0.3f * distance * distance, unit * unit));
    for (const Field<Light>& field : fields<Light>()) field.set(light, clamped(field.parameter, field.get(light)));
    return light;
}

Edits objects_panel(Ui& ui, const Scene& scene) {
    Edits edits;
    panel_title(ui, "Light and materials");
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ui.theme.px(8.0f), ui.theme.px(2.0f)});
    begin_rows();
    section(ui, "World");
    const ImVec4 sky = display_color(scene.sky.zenith);
    world_row(ui, {ObjectType::sky, 0}, "Sky", &sky);
    world_row(ui, {ObjectType::camera, 0}, "Camera", nullptr);
    if (heading(ui, "Lights", "objects", "add_light", "Adds a point light in the middle of the view"))
        edits.push_back(AddLight{light_in_view(scene.camera)});
    for (const Light& light : scene.lights) light_row(ui, scene, light, edits);
    if (scene.lights.empty()) {
        ImGui::PushTextWrapPos(0.0f);
        ImGui::TextDisabled("None. Sky and emission still light the scene.");
        ImGui::PopTextWrapPos();
    }
    if (heading(ui, "Materials", "objects", "add_material", "Adds a material")) edits.push_back(AddMaterial{});
    const std::unordered_map<Id, int> uses = material_uses(scene);
    for (const Material& material : scene.materials) {
        const auto found = uses.find(material.id);
        material_row(ui, scene, material, found == uses.end() ? 0 : found->second, edits);
    }
    ImGui::EndChild();
    ImGui::PopStyleVar();
    return edits;
}

}  // namespace farfield
