#include "ui/tree_panel.h"

#include "ui/kind_menu.h"
#include "ui/material_edits.h"
#include "ui/tree_edits.h"
#include "ui/tree_menu.h"

#include <imgui_stdlib.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <unordered_set>
#include <utility>

namespace farfield {
namespace {

constexpr const char* payload_type = "node";
constexpr float mark_width = 18.0f;  // of the eye, the lock and the warning at a row's right end

bool contains(const Node& node, Id id) {
    return node.id == id ||
           std::any_of(node.children.begin(), node.children.end(), [&](const Node& n) { return contains(n, id); });
}

bool is_dragged() {
    const ImGuiIO& io = ImGui::GetIO();
    return io.MouseDragMaxDistanceSqr[ImGuiMouseButton_Left] >= io.MouseDragThreshold * io.MouseDragThreshold;
}

void append(Edits& to, Edits from) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

class Tree {
public:
    Tree(Ui& ui, const Scene& scene) : ui_(ui), scene_(scene), searching_(has_words(ui.tree_search.text)) {
        const std::vector<Id> nodes = selected_nodes(ui.selected());
        selected_.insert(nodes.begin(), nodes.end());
        if (!searching_) return;
        search(scene.root);
        for (const Node& definition : scene.definitions) search(definition);
    }

    /// `dim`: it is in a hidden node.
    void row(const Node& node, const Node* parent, bool dim = false) {
        if (searching_ && !shown_.contains(node.id)) return;
        rows_.push_back(node.id);
        const bool leaf = node.children.empty();
        ImGuiTreeNodeFlags flags = ImGuiTreeNodeFlags_OpenOnArrow | ImGuiTreeNodeFlags_SpanAvailWidth |
                                   ImGuiTreeNodeFlags_DefaultOpen | ImGuiTreeNodeFlags_FramePadding;
        if (leaf) flags |= ImGuiTreeNodeFlags_Leaf;
        const bool selected = selected_.contains(node.id);
        if (selected) flags |= ImGuiTreeNodeFlags_Selected;
        if (!leaf && (searching_ || (ui_.reveal != 0 && ui_.reveal != node.id && contains(node, ui_.reveal))))
            ImGui::SetNextItemOpen(true);
        const float left = ImGui::GetCursorScreenPos().x;
        // Under the mouse a selected row still looks selected.
        ImGui::PushStyleColor(ImGuiCol_HeaderHovered,
                              ImGui::GetColorU32(selected ? ImGuiCol_HeaderActive : ImGuiCol_HeaderHovered));
        const bool open =
            ImGui::TreeNodeEx(reinterpret_cast<void*>(static_cast<std::uintptr_t>(node.id)), flags, "%s", "");
        ImGui::PopStyleColor();
        const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
        const std::string name = display_name(scene_, node);
        ui_.report.item("tree", name);
        if (ui_.reveal == node.id) {
            ImGui::SetScrollHereY();
            ui_.reveal = 0;
        }
        const bool hovered = ImGui::IsItemHovered();
        const float marks = node.id == scene_.root.id ? high.x : high.x - 2.0f * ui_.theme.px(mark_width);
        if (ImGui::GetIO().MouseClickedPos[0].x < marks) {
            select_by_mouse(node);
            drag_source(node, parent);
        }
        drop_target(node, parent, low, high);
        context_menu(node);
        decorate(node, name, left, low, {marks, high.y}, dim || node.hidden);
        if (node.id != scene_.root.id && ImGui::IsRectVisible(low, high)) {
            const float middle = (low.y + high.y) * 0.5f, half = ui_.theme.px(0.5f * mark_width);
            lock_mark(node, name, {marks + half, middle}, hovered);
            eye_mark(node, name, {marks + 3.0f * half, middle}, hovered, dim);
        }
        if (!open) return;
        for (const Node& child : node.children) row(child, &node, dim || node.hidden);
        ImGui::TreePop();
    }

    /// What needs all rows, once they are drawn.
    void finish() {
        if (extend_to_ != 0) ui_.select(extended(ui_.selected(), rows_, extend_to_));
    }

    bool searching() const { return searching_; }
    /// The first one found; 0 for none.
    Id first_found() const { return first_found_; }

    Edits edits;

private:
    static bool has_words(const std::string& text) { return text.find_first_not_of(' ') != text.npos; }

    /// Whether it or something in it matches.
    bool search(const Node& node) {
        const bool found = matches(scene_, node, ui_.tree_search.text);
        if (found && first_found_ == 0) first_found_ = node.id;
        bool shown = found;
        for (const Node& child : node.children) shown = search(child) || shown;
        if (shown) shown_.insert(node.id);
        return shown;
    }

    /// A press selects, except on the arrow. On one of several selected nodes only its release does, or they could not
    /// be dragged. A right-click selects what its menu is about.
    void select_by_mouse(const Node& node) {
        const bool toggled_open = ImGui::IsItemToggledOpen(), among = selected_.contains(node.id);
        const ImGuiIO& io = ImGui::GetIO();
        const ObjectRef object{ObjectType::node, node.id};
        const bool several = selected_.size() > 1;
        if (ImGui::IsItemClicked() && !toggled_open) {
            if (io.KeyCtrl)
                ui_.select(toggled(ui_.selected(), node.id));
            else if (io.KeyShift)
                extend_to_ = node.id;
            else if (!among || !several)
                ui_.select(select(object));
        } else if (ImGui::IsItemDeactivated() && ImGui::IsItemHovered() && among && several && !io.KeyCtrl &&
                   !io.KeyShift && !is_dragged()) {
            ui_.select(select(object));
        }
        if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left) && !toggled_open &&
            !io.KeyCtrl && !io.KeyShift) {
            if (node.kind == NodeKind::instance)
                go_to(ui_, node.definition);
            else
                ui_.focus_name = true;
        }
    }

    void decorate(const Node& node, const std::string& name, float left, ImVec2 low, ImVec2 high, bool dim) const {
        const KindInfo& kind = info(node.kind);
        const bool warned = !ui_.audit.warnings(node.id).empty() && !(node.children.empty() && &node == &scene_.root);
        const float middle = (low.y + high.y) * 0.5f;
        const float x = left + ImGui::GetTreeNodeToLabelSpacing();
        draw_icon(ui_, kind.role, {x + ui_.theme.px(3.0f), middle});
        ImDrawList& draw = *ImGui::GetWindowDrawList();
        const ImVec2 text{x + ui_.theme.px(15.0f), middle - ImGui::GetTextLineHeight() * 0.5f};
        draw.PushClipRect(low, high, true);
        const bool stopped = is_stopped(ui_, node);
        draw.AddText(text, stopped ? ui_.theme.error : dim ? ui_.theme.dim : ui_.theme.text, name.c_str());
        // The kind beside a name that does not tell it, where there is room.
        ImFont* font = ui_.theme.small_font;
        const char* label = stopped ? "not run" : kind.label;
        const float width = font->CalcTextSizeA(font->FontSize, 1e6f, 0.0f, label).x;
        const float right = high.x - (warned ? ui_.theme.px(mark_width) : 0.0f);
        const float from = right - width - ui_.theme.px(8.0f);
        if ((stopped || !node.name.empty()) && from > text.x + ImGui::CalcTextSize(name.c_str()).x + ui_.theme.px(8.0f))
            draw.AddText(font, font->FontSize, {from, middle - font->FontSize * 0.5f},
                         stopped ? ui_.theme.error : ui_.theme.dim, label);
        draw.PopClipRect();
        if (warned) warning_mark(node.id, name, {high.x - ui_.theme.px(0.5f * mark_width), middle}, high.y - low.y);
    }

    void warning_mark(Id node, const std::string& name, ImVec2 centre, float height) const {
        const ImVec2 half{ui_.theme.px(9.0f), height * 0.5f};
        const ImVec2 low{centre.x - half.x, centre.y - half.y}, high{centre.x + half.x, centre.y + half.y};
        draw_warning(ui_, centre);
        ui_.report.rectangle("tree_warning", name, low, high);
        if (!ImGui::IsMouseHoveringRect(low, high)) return;
        std::string text;
        const std::vector<Finding>& found = ui_.audit.warnings(node);
        for (const Finding& warning : found) text += (text.empty() ? "" : "\n") + warning.message;
        const bool mends = std::ranges::any_of(found, [](const Finding& f) { return !f.edits.empty(); });
        tooltip(ui_, text, mends ? "The inspector mends it with a click" : "");
    }

    /// Whether the mark was clicked; `lit`: the mouse is on it.
    bool mark(const char* panel, const std::string& name, ImVec2 centre, bool hovered, bool& lit) const {
        const ImVec2 half{ui_.theme.px(0.5f * mark_width), ImGui::GetTextLineHeight() * 0.6f};
        const ImVec2 low{centre.x - half.x, centre.y - half.y}, high{centre.x + half.x, centre.y + half.y};
        ui_.report.rectangle(panel, name, low, high);
        lit = hovered && ImGui::IsMouseHoveringRect(low, high);
        return lit && ImGui::IsMouseClicked(ImGuiMouseButton_Left);
    }

    /// What is off shows only on the row under the mouse, so that rows stay calm.
    void lock_mark(const Node& node, const std::string& name, ImVec2 centre, bool hovered) {
        bool lit = false;
        const bool clicked = mark("tree_lock", name, centre, hovered, lit);
        if (clicked) edits.push_back(SetLocked{node.id, !node.locked});
        if (node.locked || hovered)
            draw_lock(ui_, node.locked, centre, lit ? ui_.theme.text : node.locked ? ui_.theme.accent : ui_.theme.dim);
        if (lit)
            tooltip(ui_, node.locked ? "Locked: the picture does not select it, and it stays where it is" : "Lock",
                    "L; with all that is in it");
    }

    void eye_mark(const Node& node, const std::string& name, ImVec2 centre, bool hovered, bool dim) {
        bool lit = false;
        const bool clicked = mark("tree_eye", name, centre, hovered, lit);
        if (clicked && ImGui::GetIO().KeyShift)
            append(edits, show_only_selection(scene_, select(ObjectRef{ObjectType::node, node.id})));
        else if (clicked)
            edits.push_back(SetHidden{node.id, !node.hidden});
        if (node.hidden || hovered)
            draw_eye(ui_, !node.hidden, centre,
                     lit                   ? ui_.theme.text
                     : node.hidden && !dim ? ui_.theme.accent
                                           : ui_.theme.dim);
        if (lit) tooltip(ui_, node.hidden ? "Hidden: counts as not there" : "Hide", "H; Shift-click shows only this");
    }

    void drag_source(const Node& node, const Node* parent) {
        if (node.id == scene_.root.id || !ImGui::BeginDragDropSource()) return;
        ImGui::SetDragDropPayload(payload_type, &node.id, sizeof node.id);
        const std::size_t count = dragged(node.id).size();
        const std::string others = count > 1 ? " and " + std::to_string(count - 1) + " more" : "";
        ImGui::TextUnformatted(((parent ? "" : "instance of ") + display_name(scene_, node) + others).c_str());
        ImGui::EndDragDropSource();
    }

    /// With the node under the mouse the others that are selected.
    std::vector<Id> dragged(Id node) const {
        if (!is_selected(ui_.selected(), node)) return {node};
        std::vector<Id> nodes = topmost(scene_, selected_nodes(ui_.selected()));
        std::erase_if(nodes, [&](Id id) { return !find_parent(scene_, id) && id != node; });
        return nodes;
    }

    void drop_target(const Node& node, const Node* parent, ImVec2 low, ImVec2 high) {
        if (!ImGui::BeginDragDropTarget()) return;
        const ImGuiPayload* payload = ImGui::AcceptDragDropPayload(
            payload_type, ImGuiDragDropFlags_AcceptBeforeDelivery | ImGuiDragDropFlags_AcceptNoDrawDefaultRect);
        if (payload) {
            const Id source = *static_cast<const Id*>(payload->Data);
            const float where = (ImGui::GetMousePos().y - low.y) / (high.y - low.y);
            const bool inside = info(node.kind).takes_children() && (!parent || (where > 0.28f && where < 0.72f));
            const Node* target = inside ? &node : parent;
            const std::vector<Id> nodes = dragged(source);
            const bool allowed = target && std::all_of(nodes.begin(), nodes.end(), [&](Id id) {
                                     const Node* moved = find_node(scene_, id);
                                     return moved && !contains(*moved, target->id);
                                 });
            if (allowed) {
                mark_place(inside, where < 0.5f, low, high);
                const int index = inside ? -1 : index_in(*target, node.id) + (where < 0.5f ? 0 : 1);
                if (payload->IsDelivery()) drop(source, nodes, target->id, index);
            }
        }
        if (const ImGuiPayload* material = ImGui::AcceptDragDropPayload(material_payload))
            append(edits, drop_material(scene_, ui_.selected(), node.id, *static_cast<const Id*>(material->Data)));
        ImGui::EndDragDropTarget();
    }

    void mark_place(bool inside, bool above, ImVec2 low, ImVec2 high) const {
        ImDrawList& draw = *ImGui::GetForegroundDrawList();
        const float thickness = ui_.theme.px(2.0f), y = above ? low.y - 1.0f : high.y + 1.0f;
        if (inside)
            draw.AddRect(low, high, ui_.theme.accent, ui_.theme.px(3.0f), 0, thickness);
        else
            draw.AddLine({low.x, y}, {high.x, y}, ui_.theme.accent, thickness);
    }

    void drop(Id source, const std::vector<Id>& nodes, Id target, int index) {
        if (const Node* definition = find_definition(scene_, source))
            edits.push_back(InsertNode{target, index, make_instance(*definition)});
        else
            append(edits, move_nodes(scene_, nodes, target, index));
    }

    void context_menu(const Node& node) {
        if (ImGui::IsItemClicked(ImGuiMouseButton_Right)) {
            if (is_selected(ui_.selected(), node.id) && ui_.selection.id != node.id)
                ui_.select(toggled(toggled(ui_.selected(), node.id), node.id));  // makes it the primary one
            else if (!is_selected(ui_.selected(), node.id))
                ui_.select(select(ObjectRef{ObjectType::node, node.id}));
        }
        // The rows stand closer than a menu's.
        ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ui_.theme.px(10.0f), ui_.theme.px(8.0f)});
        ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ui_.theme.px(7.0f), ui_.theme.px(6.0f)});
        if (ImGui::BeginPopupContextItem()) {
            append(edits, tree_menu(ui_, scene_, node));
            ImGui::EndPopup();
        }
        ImGui::PopStyleVar(2);
    }

    Ui& ui_;
    const Scene& scene_;
    bool searching_;
    std::unordered_set<Id> selected_;
    std::unordered_set<Id> shown_;  ///< while searching: what was found, with what it is in
    Id first_found_ = 0;
    std::vector<Id> rows_;  ///< in the order of drawing
    Id extend_to_ = 0;      ///< where a Shift-click wants the selection to reach
};

Edits add_button(Ui& ui, const Scene& scene) {
    Edits edits;
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const ImVec2 below = ImGui::GetCursorScreenPos();
    const float width = ui.theme.px(58.0f);
    ImGui::SetCursorScreenPos({high.x - width - ui.theme.px(6.0f), low.y + ui.theme.px(3.0f)});
    if (ImGui::Button("+ Add", {width, 0.0f}) || ui.open_add) ImGui::OpenPopup("add");
    ui.open_add = false;
    ui.report.item("tree_panel", "add");
    tooltip(ui, "Adds a shape or an operation",
            "Into the selected operation, or after the selected shape. Shortcut: A; what is typed then searches");
    ImGui::SetNextWindowPos({low.x + ui.theme.px(8.0f), high.y + ui.theme.px(2.0f)}, ImGuiCond_Appearing);
    if (ImGui::BeginPopup("add")) {
        if (auto node = node_menu(ui, "add", scene)) {
            edits.push_back(insert_at_selection(scene, ui.selected(), std::move(*node)));
            ImGui::CloseCurrentPopup();
        }
        ImGui::EndPopup();
    }
    ImGui::SetCursorScreenPos(below);
    return edits;
}

/// Enter selects the first node that is found, Escape shows all again.
void search_field(Ui& ui, const Scene& scene) {
    ImGui::SetCursorPos({ImGui::GetCursorPosX() + ui.theme.px(6.0f), ImGui::GetCursorPosY() + ui.theme.px(4.0f)});
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - ui.theme.px(6.0f));
    if (std::exchange(ui.tree_search.focus, false)) ImGui::SetKeyboardFocusHere();
    std::string& text = ui.tree_search.text;
    const bool entered =
        ImGui::InputTextWithHint("##search", "Search by name or kind", &text,
                                 ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    ui.report.item("tree_panel", "search");
    tooltip(ui, "Shows the nodes whose name or kind has these words", "Ctrl+F. Enter selects the first, Escape clears");
    if (entered) {
        if (const Id found = Tree(ui, scene).first_found()) go_to(ui, found);
    }
    if (ImGui::IsItemDeactivated() && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) text.clear();
}

}  // namespace

void go_to(Ui& ui, Id node) {
    ui.select(select(ObjectRef{ObjectType::node, node}));
    ui.reveal = node;
}

Edits tree_panel(Ui& ui, const Scene& scene) {
    panel_title(ui, "Scene");
    Edits edits = add_button(ui, scene);
    search_field(ui, scene);
    Tree tree(ui, scene);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ui.theme.px(4.0f), ui.theme.px(4.0f)});
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ui.theme.px(4.0f), ui.theme.px(1.0f)});
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {ui.theme.px(3.0f), ui.theme.px(2.0f)});
    begin_rows();
    const auto note = [&](const char* text) {
        ImGui::Dummy({0.0f, ui.theme.px(8.0f)});
        ImGui::Indent(ui.theme.px(8.0f));
        ImGui::PushTextWrapPos(0.0f);
        ImGui::TextDisabled("%s", text);
        ImGui::PopTextWrapPos();
        ImGui::Unindent(ui.theme.px(8.0f));
    };
    tree.row(scene.root, nullptr);
    if (tree.searching() && tree.first_found() == 0)
        note("No node has this in its name or kind.");
    else if (scene.root.children.empty() && !tree.searching())
        note("The scene is empty. Press + Add above to put in a first shape.");
    if (!scene.definitions.empty()) {
        ImGui::Dummy({0.0f, ui.theme.px(6.0f)});
        section(ui, "Definitions");
        for (const Node& definition : scene.definitions) tree.row(definition, nullptr);
    }
    tree.finish();
    ImGui::EndChild();
    ImGui::PopStyleVar(3);
    append(edits, std::move(tree.edits));
    return edits;
}

}  // namespace farfield
