#include "ui/tree_panel.h"

#include "ui/kind_menu.h"

#include <algorithm>
#include <string>

namespace farfield {
namespace {

constexpr const char* payload_type = "node";

int index_in(const Node& parent, Id child) {
    const auto it =
        std::find_if(parent.children.begin(), parent.children.end(), [&](const Node& n) { return n.id == child; });
    return static_cast<int>(it - parent.children.begin());
}

bool contains(const Node& node, Id id) {
    return node.id == id ||
           std::any_of(node.children.begin(), node.children.end(), [&](const Node& n) { return contains(n, id); });
}

const Node* selected_node(const Ui& ui, const Scene& scene) {
    return ui.selection.type == ObjectType::node ? find_node(scene, ui.selection.id) : nullptr;
}

class Tree {
public:
    Tree(Ui& ui, const Scene& scene) : ui_(ui), scene_(scene) {}

    void row(const Node& node, const Node* parent) {
        const bool leaf = node.children.empty();
        const bool selected = ui_.selection == ObjectRef{ObjectType::node, node.id};
        ImGuiTreeNodeFlags flags = ImGuiTreeNodeFlags_OpenOnArrow | ImGuiTreeNodeFlags_SpanAvailWidth |
                                   ImGuiTreeNodeFlags_DefaultOpen | ImGuiTreeNodeFlags_FramePadding;
        if (leaf) flags |= ImGuiTreeNodeFlags_Leaf;
        if (selected) flags |= ImGuiTreeNodeFlags_Selected;
        if (ui_.reveal != 0 && !leaf && ui_.reveal != node.id && contains(node, ui_.reveal))
            ImGui::SetNextItemOpen(true);
        const float left = ImGui::GetCursorScreenPos().x;
        const bool open =
            ImGui::TreeNodeEx(reinterpret_cast<void*>(static_cast<std::uintptr_t>(node.id)), flags, "%s", "");
        const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
        const std::string name = display_name(scene_, node);
        ui_.report.item("tree", name);
        if (ui_.reveal == node.id) {
            ImGui::SetScrollHereY();
            ui_.reveal = 0;
        }
        // A press selects, except on the arrow; a right-click selects what its menu is about.
        if ((ImGui::IsItemClicked() && !ImGui::IsItemToggledOpen()) || ImGui::IsItemClicked(ImGuiMouseButton_Right))
            ui_.selection = {ObjectType::node, node.id};
        if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left) &&
            !ImGui::IsItemToggledOpen()) {
            if (node.kind == NodeKind::instance)
                go_to(ui_, node.definition);
            else
                ui_.focus_name = true;
        }
        drag_and_drop(node, parent, low, high);
        context_menu(node, parent);
        decorate(node, name, left, low, high);
        if (!open) return;
        for (const Node& child : node.children) row(child, &node);
        ImGui::TreePop();
    }

    Edits edits;

private:
    void decorate(const Node& node, const std::string& name, float left, ImVec2 low, ImVec2 high) const {
        const KindInfo& kind = info(node.kind);
        const bool warned = !ui_.audit.warnings(node.id).empty() && !(node.children.empty() && &node == &scene_.root);
        const float middle = (low.y + high.y) * 0.5f;
        const float x = left + ImGui::GetTreeNodeToLabelSpacing();
        draw_icon(ui_, kind.role, {x + ui_.theme.px(3.0f), middle});
        ImDrawList& draw = *ImGui::GetWindowDrawList();
        const ImVec2 text{x + ui_.theme.px(15.0f), middle - ImGui::GetTextLineHeight() * 0.5f};
        draw.PushClipRect(low, high, true);
        const bool stopped = is_stopped(ui_, node);
        draw.AddText(text, stopped ? ui_.theme.error : ui_.theme.text, name.c_str());
        // The kind beside a name that does not tell it, where there is room.
        ImFont* font = ui_.theme.small_font;
        const char* label = stopped ? "not run" : kind.label;
        const float width = font->CalcTextSizeA(font->FontSize, 1e6f, 0.0f, label).x;
        const float right = high.x - (warned ? ui_.theme.px(18.0f) : 0.0f);
        const float from = right - width - ui_.theme.px(8.0f);
        if ((stopped || !node.name.empty()) && from > text.x + ImGui::CalcTextSize(name.c_str()).x + ui_.theme.px(8.0f))
            draw.AddText(font, font->FontSize, {from, middle - font->FontSize * 0.5f},
                         stopped ? ui_.theme.error : ui_.theme.dim, label);
        draw.PopClipRect();
        if (warned) warning_mark(node.id, name, {high.x - ui_.theme.px(11.0f), middle}, high.y - low.y);
    }

    void warning_mark(Id node, const std::string& name, ImVec2 centre, float height) const {
        const ImVec2 half{ui_.theme.px(9.0f), height * 0.5f};
        const ImVec2 low{centre.x - half.x, centre.y - half.y}, high{centre.x + half.x, centre.y + half.y};
        draw_warning(ui_, centre);
        ui_.report.rectangle("tree_warning", name, low, high);
        if (!ImGui::IsMouseHoveringRect(low, high)) return;
        std::string text;
        for (const std::string& warning : ui_.audit.warnings(node)) text += (text.empty() ? "" : "\n") + warning;
        tooltip(ui_, text);
    }

    void drag_and_drop(const Node& node, const Node* parent, ImVec2 low, ImVec2 high) {
        if (node.id != scene_.root.id && ImGui::BeginDragDropSource()) {
            ImGui::SetDragDropPayload(payload_type, &node.id, sizeof node.id);
            ImGui::TextUnformatted(((parent ? "" : "instance of ") + display_name(scene_, node)).c_str());
            ImGui::EndDragDropSource();
        }
        if (!ImGui::BeginDragDropTarget()) return;
        const ImGuiPayload* payload = ImGui::AcceptDragDropPayload(
            payload_type, ImGuiDragDropFlags_AcceptBeforeDelivery | ImGuiDragDropFlags_AcceptNoDrawDefaultRect);
        if (payload) {
            const Id dragged = *static_cast<const Id*>(payload->Data);
            const float where = (ImGui::GetMousePos().y - low.y) / (high.y - low.y);
            const bool inside = info(node.kind).takes_children() && (!parent || (where > 0.28f && where < 0.72f));
            const Node* source = find_node(scene_, dragged);
            const Node* target = inside ? &node : parent;
            if (source && target && !contains(*source, target->id)) {
                ImDrawList& draw = *ImGui::GetForegroundDrawList();
                const float rounding = ui_.theme.px(3.0f), thickness = ui_.theme.px(2.0f);
                const float y = where < 0.5f ? low.y - 1.0f : high.y + 1.0f;
                if (inside)
                    draw.AddRect(low, high, ui_.theme.accent, rounding, 0, thickness);
                else
                    draw.AddLine({low.x, y}, {high.x, y}, ui_.theme.accent, thickness);
                const int index = inside ? -1 : index_in(*target, node.id) + (where < 0.5f ? 0 : 1);
                if (payload->IsDelivery()) {
                    if (find_definition(scene_, dragged))
                        edits.push_back(InsertNode{target->id, index, make_instance(*source)});
                    else
                        edits.push_back(MoveNode{dragged, target->id, index});
                }
            }
        }
        ImGui::EndDragDropTarget();
    }

    void context_menu(const Node& node, const Node* parent) {
        // The rows stand closer than a menu's.
        ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ui_.theme.px(10.0f), ui_.theme.px(8.0f)});
        ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ui_.theme.px(7.0f), ui_.theme.px(6.0f)});
        if (ImGui::BeginPopupContextItem()) {
            context_entries(node, parent);
            ImGui::EndPopup();
        }
        ImGui::PopStyleVar(2);
    }

    void context_entries(const Node& node, const Node* parent) {
        if (info(node.kind).takes_children() && ImGui::BeginMenu("Add inside")) {
            if (auto added = node_menu(ui_, "add_inside", scene_)) {
                edits.push_back(InsertNode{node.id, -1, std::move(*added)});
                ImGui::CloseCurrentPopup();
            }
            ImGui::EndMenu();
        }
        if (parent) {
            if (ImGui::BeginMenu("Change kind")) {
                const auto allowed = [&](const KindInfo& k) { return node.children.empty() || k.takes_children(); };
                if (const auto kind = kind_menu(ui_, "change_kind", allowed); kind && *kind != node.kind) {
                    edits.push_back(SetKind{node.id, *kind});
                    ImGui::CloseCurrentPopup();
                }
                ImGui::EndMenu();
            }
            ImGui::Separator();
            if (ImGui::MenuItem("Rename")) ui_.focus_name = true;
            if (ImGui::MenuItem("Duplicate", "Ctrl+D"))
                edits.push_back(InsertNode{parent->id, index_in(*parent, node.id) + 1, node});
            const int index = index_in(*parent, node.id), count = static_cast<int>(parent->children.size());
            if (ImGui::MenuItem("Move up", "Alt+Up", false, index > 0))
                edits.push_back(MoveNode{node.id, parent->id, index - 1});
            if (ImGui::MenuItem("Move down", "Alt+Down", false, index + 1 < count))
                edits.push_back(MoveNode{node.id, parent->id, index + 2});
            ImGui::Separator();
            if (node.kind == NodeKind::instance) {
                if (ImGui::MenuItem("Go to definition")) go_to(ui_, node.definition);
                if (ImGui::MenuItem("Make independent", "Ctrl+Shift+I")) edits.push_back(MakeIndependent{node.id});
            } else if (ImGui::MenuItem("Make definition", "Ctrl+I")) {
                edits.push_back(MakeDefinition{node.id});
            }
            ui_.report.item("context", "definition");
            ImGui::Separator();
            if (ImGui::MenuItem("Delete", "Del")) edits.push_back(RemoveNode{node.id});
        } else if (node.id != scene_.root.id) {
            if (ImGui::MenuItem("Add instance")) edits.push_back(InsertNode{scene_.root.id, -1, make_instance(node)});
            if (ImGui::MenuItem("Rename")) ui_.focus_name = true;
            if (ImGui::MenuItem("Delete", "Del", false, count_uses(scene_, node.id) == 0))
                edits.push_back(RemoveNode{node.id});
        }
    }

    Ui& ui_;
    const Scene& scene_;
};

}  // namespace

void go_to(Ui& ui, Id node) {
    ui.selection = {ObjectType::node, node};
    ui.reveal = node;
}

Edit insert_at_selection(const Ui& ui, const Scene& scene, Node node) {
    if (const Node* selected = selected_node(ui, scene)) {
        if (info(selected->kind).takes_children()) return InsertNode{selected->id, -1, std::move(node)};
        if (const Node* parent = find_parent(scene, selected->id))
            return InsertNode{parent->id, index_in(*parent, selected->id) + 1, std::move(node)};
    }
    return InsertNode{scene.root.id, -1, std::move(node)};
}

Edits delete_selection(const Ui& ui, const Scene& scene) {
    if (!exists(scene, ui.selection)) return {};
    switch (ui.selection.type) {
        case ObjectType::node:
            if (ui.selection.id == scene.root.id) return {};
            return {RemoveNode{ui.selection.id}};
        case ObjectType::material:
            if (scene.materials.size() < 2) return {};
            return {RemoveMaterial{ui.selection.id}};
        case ObjectType::light:
            return {RemoveLight{ui.selection.id}};
        default:
            return {};
    }
}

Edits duplicate_selection(const Ui& ui, const Scene& scene) {
    if (const Node* node = selected_node(ui, scene))
        if (const Node* parent = find_parent(scene, node->id))
            return {InsertNode{parent->id, index_in(*parent, node->id) + 1, *node}};
    if (ui.selection.type == ObjectType::material)
        if (const Material* material = find_material(scene, ui.selection.id)) return {AddMaterial{*material}};
    if (ui.selection.type == ObjectType::light)
        if (const Light* light = find_light(scene, ui.selection.id)) return {AddLight{*light}};
    return {};
}

Edits define_selection(const Ui& ui, const Scene& scene) {
    const Node* node = selected_node(ui, scene);
    if (!node || node->kind == NodeKind::instance || !find_parent(scene, node->id)) return {};
    return {MakeDefinition{node->id}};
}

Edits free_selection(const Ui& ui, const Scene& scene) {
    const Node* node = selected_node(ui, scene);
    if (!node || node->kind != NodeKind::instance || !find_parent(scene, node->id)) return {};
    return {MakeIndependent{node->id}};
}

Edits shift_selection(const Ui& ui, const Scene& scene, int by) {
    const Node* node = selected_node(ui, scene);
    const Node* parent = node ? find_parent(scene, node->id) : nullptr;
    if (!parent) return {};
    const int index = index_in(*parent, node->id);
    const int to = index + by;
    if (to < 0 || to >= static_cast<int>(parent->children.size())) return {};
    return {MoveNode{node->id, parent->id, by < 0 ? to : to + 1}};
}

Edits tree_panel(Ui& ui, const Scene& scene) {
    panel_title(ui, "Scene");
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const ImVec2 below = ImGui::GetCursorScreenPos();
    const float width = ui.theme.px(58.0f);
    Tree tree(ui, scene);
    ImGui::SetCursorScreenPos({high.x - width - ui.theme.px(6.0f), low.y + ui.theme.px(3.0f)});
    if (ImGui::Button("+ Add", {width, 0.0f}) || ui.open_add) ImGui::OpenPopup("add");
    ui.open_add = false;
    ui.report.item("tree_panel", "add");
    tooltip(ui, "Adds a shape or an operation",
            "Into the selected operation, or after the selected shape. Shortcut: A; what is typed then searches");
    ImGui::SetNextWindowPos({low.x + ui.theme.px(8.0f), high.y + ui.theme.px(2.0f)}, ImGuiCond_Appearing);
    if (ImGui::BeginPopup("add")) {
        if (auto node = node_menu(ui, "add", scene)) {
            tree.edits.push_back(insert_at_selection(ui, scene, std::move(*node)));
            ImGui::CloseCurrentPopup();
        }
        ImGui::EndPopup();
    }
    ImGui::SetCursorScreenPos(below);

    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ui.theme.px(4.0f), ui.theme.px(4.0f)});
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ui.theme.px(4.0f), ui.theme.px(1.0f)});
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {ui.theme.px(3.0f), ui.theme.px(2.0f)});
    ImGui::BeginChild("rows", {0.0f, 0.0f}, false, ImGuiWindowFlags_AlwaysUseWindowPadding);
    tree.row(scene.root, nullptr);
    if (scene.root.children.empty()) {
        ImGui::Dummy({0.0f, ui.theme.px(8.0f)});
        ImGui::Indent(ui.theme.px(8.0f));
        ImGui::PushTextWrapPos(0.0f);
        ImGui::TextDisabled("The scene is empty. Press + Add above to put in a first shape.");
        ImGui::PopTextWrapPos();
        ImGui::Unindent(ui.theme.px(8.0f));
    }
    if (!scene.definitions.empty()) {
        ImGui::Dummy({0.0f, ui.theme.px(6.0f)});
        section(ui, "Definitions");
        for (const Node& definition : scene.definitions) tree.row(definition, nullptr);
    }
    ImGui::EndChild();
    ImGui::PopStyleVar(3);
    return std::move(tree.edits);
}

}  // namespace farfield
