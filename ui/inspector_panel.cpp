#include "ui/inspector_panel.h"

#include "ui/bookmark_list.h"
#include "ui/kind_menu.h"
#include "ui/material_edits.h"
#include "ui/tree_edits.h"
#include "ui/tree_panel.h"
#include "ui/value_row.h"

#include <fmt/format.h>
#include <imgui_stdlib.h>

namespace farfield {
namespace {

void name_row(Ui& ui, ObjectRef object, const std::string& name, const char* empty, Edits& edits) {
    ImGui::PushID(static_cast<int>(object.type));
    ImGui::PushID(static_cast<int>(object.id));
    row_label(ui, "Name", false);
    if (ui.focus_name && ui.inspected == ui.selection) {
        ImGui::SetKeyboardFocusHere();
        ui.focus_name = false;
    }
    // Shown from the scene until someone types; what was typed is an edit once the field is left.
    std::string text = name;
    const ImGuiID id = ImGui::GetID("##name");
    ImGuiStorage& storage = *ImGui::GetStateStorage();
    const bool typing = storage.GetBool(id);
    if (typing) text = ui.name_text;
    ImGui::InputTextWithHint("##name", empty, &text, ImGuiInputTextFlags_AutoSelectAll);
    ui.report.item("inspector", "name");
    ui.name_text = text;
    storage.SetBool(id, ImGui::IsItemActive());
    if (ImGui::IsItemDeactivatedAfterEdit() && text != name) edits.push_back(SetName{object, text});
    ImGui::PopID();
    ImGui::PopID();
}

void wrapped(ImU32 color, const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
}

void kind_row(Ui& ui, const Scene& scene, const Node& node, Edits& edits) {
    const KindInfo& kind = info(node.kind);
    row_label(ui, "Kind", false);
    const bool fixed = node.id == scene.root.id;
    ImGui::BeginDisabled(fixed);
    ImGui::SetNextWindowSizeConstraints({0.0f, 0.0f}, {FLT_MAX, FLT_MAX});
    const bool open = ImGui::BeginCombo("##kind", kind.label, ImGuiComboFlags_HeightLargest);
    ui.report.item("inspector", "kind");
    if (open) {
        const auto allowed = [&](const KindInfo& k) { return node.children.empty() || k.takes_children(); };
        if (const auto chosen = kind_menu(ui, "kind", allowed)) {
            if (*chosen != node.kind) edits.push_back(SetKind{node.id, *chosen});
            ImGui::CloseCurrentPopup();
        }
        ImGui::EndCombo();
    } else {
        tooltip(ui, kind.tip, kind.exact ? "Exact distance" : "Lower bound of the distance");
    }
    ImGui::EndDisabled();
}

/// Of an instance: what it shows, and the way there.
void definition_row(Ui& ui, const Scene& scene, const Node& node, Edits& edits) {
    row_label(ui, "Shows", false);
    const Node* definition = find_definition(scene, node.definition);
    const bool open = ImGui::BeginCombo("##definition", definition ? definition->name.c_str() : "");
    ui.report.item("inspector", "definition");
    if (open) {
        for (const Node& other : scene.definitions) {
            if (ImGui::Selectable(other.name.c_str(), other.id == node.definition) && other.id != node.definition)
                edits.push_back(SetDefinition{node.id, other.id});
            ui.report.item("definition", other.name);
        }
        ImGui::EndCombo();
    }
    row_label(ui, "", false);
    if (ImGui::Button("Go to definition", {-FLT_MIN, 0.0f})) go_to(ui, node.definition);
    ui.report.item("inspector", "go_to_definition");
}

void material_row(Ui& ui, const Scene& scene, const Node& node, Edits& edits) {
    row_label(ui, "Material", node.material != 0);
    const Material* material = find_material(scene, node.material);
    const float side = ImGui::GetFrameHeight();
    if (material) {
        if (ImGui::ColorButton("##open", display_color(material->albedo), ImGuiColorEditFlags_NoTooltip,
                               {side * 1.3f, side}))
            ui.select(select(ObjectRef{ObjectType::material, material->id}));
        ui.report.item("inspector", "material_open");
        tooltip(ui, "Edit this material");
        ImGui::SameLine(0.0f, ui.theme.px(4.0f));
        ImGui::SetNextItemWidth(-FLT_MIN);
    }
    const char* inherit = node.id == scene.root.id          ? "first in the list"
                          : find_definition(scene, node.id) ? "as each instance"
                                                            : "as its group";
    const bool open = ImGui::BeginCombo("##material", material ? material->name.c_str() : inherit);
    ui.report.item("inspector", "material");
    if (!open) {
        tooltip(ui, "The surface of this node and of everything in it that has no material of its own");
        return;
    }
    if (ImGui::Selectable(inherit, node.material == 0)) edits.push_back(SetMaterial{node.id, 0});
    ui.report.item("material", "inherit");
    if (ImGui::Selectable("New material")) edits = new_material(scene, node.id);
    ui.report.item("material", "new");
    ImGui::Separator();
    for (const Material& m : scene.materials) {
        ImGui::PushID(static_cast<int>(m.id));
        const float small = ImGui::GetTextLineHeight();
        ImGui::ColorButton("##swatch", display_color(m.albedo), ImGuiColorEditFlags_NoTooltip, {small, small});
        ImGui::SameLine();
        if (ImGui::Selectable(m.name.c_str(), node.material == m.id) && m.id != node.material)
            edits.push_back(SetMaterial{node.id, m.id});
        ui.report.item("material", m.name);
        ImGui::PopID();
    }
    ImGui::EndCombo();
}

void delete_button(Ui& ui, const Scene& scene, const char* label, bool enabled, Edits& edits) {
    ImGui::Dummy({0.0f, ui.theme.px(4.0f)});
    ImGui::BeginDisabled(!enabled);
    if (ImGui::Button(label, {-FLT_MIN, 0.0f})) edits = delete_selection(scene, ui.selected());
    ImGui::EndDisabled();
    ui.report.item("inspector", "delete");
}

/// Where the code of a custom node is, and whether it runs.
void code_rows(Ui& ui, const Node& node) {
    if (is_stopped(ui, node)) {
        ImGui::Dummy({0.0f, ui.theme.px(2.0f)});
        ImGui::PushStyleColor(ImGuiCol_Text, ui.theme.error);
        ImGui::PushTextWrapPos(0.0f);
        ImGui::TextUnformatted("This code comes from elsewhere and was not run, so nothing shows.");
        ImGui::PopTextWrapPos();
        ImGui::PopStyleColor();
        if (ImGui::Button("Run the code", {-FLT_MIN, 0.0f})) ui.run = node.code;
        ui.report.item("inspector", "run_code");
        tooltip(ui, "Gives it to the graphics driver to compile", "Read it first");
    }
    row_label(ui, "Code", false);
    const bool shown = ui.show_code && ui.edit_code;
    if (ImGui::Button(shown ? "Hide" : "Edit", {-FLT_MIN, 0.0f})) ui.show_code = ui.edit_code = !shown;
    ui.report.item("inspector", "edit_code");
    tooltip(ui, "The GLSL of this node; its uniforms are the values below");
}

std::string range_text(const Box& box) {
    std::string text = "In the world:";
    for (int axis = 0; axis < 3; ++axis)
        text += box.is_bounded(axis)
                    ? fmt::format("\n{} from {:.4g} to {:.4g} m", "xyz"[axis], box.low[axis], box.high[axis])
                    : fmt::format("\n{} without end", "xyz"[axis]);
    return text;
}

void slope_row(Ui& ui, const NodeAudit& audit) {
    row_label(ui, "Slope found", false);
    if (ui.audit.running()) {
        ImGui::TextDisabled("trying points ...");
    } else if (ui.audit.sampled()) {
        ImGui::AlignTextToFramePadding();
        if (audit.samples == 0)
            ImGui::TextDisabled("not tried: too much is in it");
        else if (audit.unsafe_slope)
            ImGui::Text("%.3g, made safe %.3f", *audit.unsafe_slope, audit.slope);
        else
            ImGui::Text("%.3f", audit.slope);
        ui.report.item("inspector", "slope");
        tooltip(ui,
                fmt::format("The steepest among {} pairs of points. At most 1 where steps are safe.", audit.samples),
                audit.unsafe_slope ? "Before it is made safe: at most the Lipschitz constant" : "");
    } else {
        if (ImGui::Button("Audit", {-FLT_MIN, 0.0f})) ui.audit.start();
        ui.report.item("inspector", "audit");
        tooltip(ui, "Tries points of every node for places that are steeper than promised",
                "In the background; what is found is marked in the tree");
    }
}

/// What is known about the node's distance field.
void field_block(Ui& ui, const Node& node, Edits& edits) {
    const NodeAudit* audit = ui.audit.find(node.id);
    if (!audit || (!audit->shows && node.children.empty())) return;
    section(ui, "Field");
    for (const Finding& warning : ui.audit.warnings(node.id)) {
        const ImVec2 start = ImGui::GetCursorScreenPos();
        draw_warning(ui, {start.x + ui.theme.px(7.0f), start.y + ImGui::GetTextLineHeight() * 0.5f});
        ImGui::Indent(ui.theme.px(20.0f));
        wrapped(ui.theme.warning, warning.message);
        ui.report.item("inspector", "warning");
        if (!warning.edits.empty()) {
            if (ImGui::Button(warning.fix.c_str()))
                edits.insert(edits.end(), warning.edits.begin(), warning.edits.end());
            ui.report.item("inspector", "fix");
        }
        ImGui::Unindent(ui.theme.px(20.0f));
    }
    if (!audit->shows) return;
    row_label(ui, "Bounds", false);
    ImGui::TextUnformatted(size_text(audit->world).c_str());
    tooltip(ui, range_text(audit->world));
    row_label(ui, "Lipschitz", audit->stretch > 1.0f);
    ImGui::Text("%.4g", audit->stretch);
    ui.report.item("inspector", "lipschitz");
    tooltip(ui, "How steep the field would be without care; steps are that much shorter",
            "1: a step as long as the distance is safe as it is");
    ImGui::PushFont(ui.theme.small_font);
    wrapped(ui.theme.dim, audit->origin);
    ImGui::PopFont();
    slope_row(ui, *audit);
}

/// How many nodes the rows below are about; 1 where they are about one alone.
std::size_t selected_count(const Ui& ui) {
    return ui.inspected == ui.selection ? selected_nodes(ui.selected()).size() : 1;
}

void several_note(Ui& ui, const Scene& scene, const Node& node, std::size_t count) {
    ImGui::PushStyleColor(ImGuiCol_Text, ui.theme.accent);
    ImGui::Text("%zu nodes selected", count);
    ImGui::PopStyleColor();
    ui.report.item("inspector", "several");
    ImGui::PushFont(ui.theme.small_font);
    wrapped(ui.theme.dim, fmt::format("The values are those of {}. What you change here changes in all: they get the "
                                      "same material, and the same values where they are of its kind; they move, turn "
                                      "and scale by as much.",
                                      display_name(scene, node)));
    ImGui::PopFont();
    ImGui::Dummy({0.0f, ui.theme.px(2.0f)});
}

/// Why the placement cannot be changed, and how it could be.
void locked_note(Ui& ui, const Scene& scene, const Node& node, Edits& edits) {
    const Node* lock = find_lock(scene, node.id);
    if (!lock) return;
    const bool own = lock->id == node.id;
    wrapped(ui.theme.dim,
            own ? "Locked: it stays where it is." : fmt::format("In {}, which is locked.", display_name(*lock)));
    if (ImGui::Button(own ? "Unlock" : fmt::format("Unlock {}", display_name(*lock)).c_str(), {-FLT_MIN, 0.0f}))
        edits.push_back(SetLocked{lock->id, false});
    ui.report.item("inspector", "unlock");
}

void inspect_node(Ui& ui, const Scene& scene, const Node& node, Edits& edits) {
    const std::size_t count = selected_count(ui);
    if (count > 1)
        several_note(ui, scene, node, count);
    else
        name_row(ui, ui.inspected, node.name, display_name(scene, node).c_str(), edits);
    kind_row(ui, scene, node, edits);
    if (node.kind == NodeKind::instance) definition_row(ui, scene, node, edits);
    if (find_definition(scene, node.id)) {
        const int uses = count_uses(scene, node.id);
        row_label(ui, "Shown by", false);
        ImGui::TextDisabled("%d %s", uses, uses == 1 ? "instance" : "instances");
    }
    material_row(ui, scene, node, edits);
    if (node.code) code_rows(ui, node);
    const std::size_t own = parameters(node).size();
    if (own > 0) section(ui, "Shape");
    value_rows(ui, "inspector", scene, ui.inspected, edits, 0, own);
    section(ui, "Placement");
    locked_note(ui, scene, node, edits);
    ImGui::BeginDisabled(find_lock(scene, node.id) != nullptr);
    value_rows(ui, "inspector", scene, ui.inspected, edits, own);
    ImGui::EndDisabled();
    if (info(node.kind).takes_children() && node.children.empty()) {
        ImGui::Dummy({0.0f, ui.theme.px(4.0f)});
        ImGui::PushTextWrapPos(0.0f);
        ImGui::TextDisabled("Nothing inside yet: it shows once it holds a shape. Press + Add, or drag nodes onto it.");
        ImGui::PopTextWrapPos();
    }
    field_block(ui, node, edits);
    if (find_definition(scene, node.id))
        delete_button(ui, scene, "Delete definition", count_uses(scene, node.id) == 0, edits);
    else if (node.id != scene.root.id)
        delete_button(ui, scene, count > 1 ? fmt::format("Delete {} nodes", count).c_str() : "Delete node",
                      !find_lock(scene, node.id), edits);
}

void inspect_material(Ui& ui, const Scene& scene, const Material& material, Edits& edits) {
    name_row(ui, ui.inspected, material.name, "a name is needed", edits);
    const std::vector<Id> users = material_users(scene, material.id);
    const int count = static_cast<int>(users.size());
    row_label(ui, "Used by", false);
    ImGui::BeginDisabled(users.empty());
    if (ImGui::Button(fmt::format("{} {}", count, count == 1 ? "node" : "nodes").c_str(), {-FLT_MIN, 0.0f}))
        ui.select(select(users));
    ImGui::EndDisabled();
    ui.report.item("inspector", "users");
    tooltip(ui, "Selects them");
    if (&material == scene.materials.data()) {
        row_label(ui, "", false);
        ImGui::PushFont(ui.theme.small_font);
        ImGui::TextDisabled("and by all nodes without one");
        ImGui::PopFont();
    }
    section(ui, "Surface");
    value_rows(ui, "inspector", scene, ui.inspected, edits);
    delete_button(ui, scene, "Delete material", scene.materials.size() > 1, edits);
    ImGui::PushFont(ui.theme.small_font);
    if (const std::string text = without_material(scene, material.id, count); !text.empty())
        wrapped(ui.theme.dim, text);
    ImGui::PopFont();
}

void inspect_light(Ui& ui, const Scene& scene, const Light& light, Edits& edits) {
    name_row(ui, ui.inspected, light.name, "a name is needed", edits);
    row_label(ui, "Kind", false);
    const auto label = [](int kind) { return label_of(light_kind_keys[kind]); };
    const bool open = ImGui::BeginCombo("##kind", label(static_cast<int>(light.kind)).c_str());
    ui.report.item("inspector", "kind");
    if (open) {
        for (int i = 0; i < static_cast<int>(std::size(light_kind_keys)); ++i) {
            const auto kind = static_cast<LightKind>(i);
            if (ImGui::Selectable(label(i).c_str(), light.kind == kind) && light.kind != kind)
                edits.push_back(SetLightKind{light.id, kind});
            ui.report.item("kind", light_kind_keys[i]);
        }
        ImGui::EndCombo();
    }
    section(ui, "Light");
    value_rows(ui, "inspector", scene, ui.inspected, edits);
    delete_button(ui, scene, "Delete light", true, edits);
}

}  // namespace

Edits inspector_panel(Ui& ui, const Scene& scene) {
    Edits edits;
    panel_title(ui, "Inspector");
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ui.theme.px(10.0f), ui.theme.px(8.0f)});
    begin_rows();
    const ObjectRef selection = ui.inspected;
    ImGui::PushID(static_cast<int>(selection.type));
    ImGui::PushID(static_cast<int>(selection.id));
    if (const Node* node = selection.type == ObjectType::node ? find_node(scene, selection.id) : nullptr) {
        inspect_node(ui, scene, *node, edits);
    } else if (const Material* material =
                   selection.type == ObjectType::material ? find_material(scene, selection.id) : nullptr) {
        inspect_material(ui, scene, *material, edits);
    } else if (const Light* light = selection.type == ObjectType::light ? find_light(scene, selection.id) : nullptr) {
        inspect_light(ui, scene, *light, edits);
    } else if (selection.type == ObjectType::sky || selection.type == ObjectType::camera) {
        section(ui, selection.type == ObjectType::sky ? "Sky radiance" : "Camera");
        value_rows(ui, "inspector", scene, selection, edits);
        if (selection.type == ObjectType::camera) bookmark_list(ui, scene, edits);
    } else {
        ImGui::PushTextWrapPos(0.0f);
        ImGui::TextDisabled(
            "Nothing is selected. Click a node in the tree, or a light or material below it, to edit it here.");
        ImGui::PopTextWrapPos();
    }
    ImGui::PopID();
    ImGui::PopID();
    ImGui::EndChild();
    ImGui::PopStyleVar();
    if (ui.inspected == ui.selection) ui.focus_name = false;  // what has no name has no field for it
    if (selected_count(ui) > 1) edits = for_all_selected(scene, ui.selected(), std::move(edits));
    ui.inspected = ui.selection;
    return edits;
}

}  // namespace farfield
