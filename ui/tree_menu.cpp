#include "ui/tree_menu.h"

#include "ui/kind_menu.h"
#include "ui/tree_edits.h"
#include "ui/tree_panel.h"

#include <algorithm>
#include <string>

namespace farfield {
namespace {

class Menu {
public:
    Menu(Ui& ui, const Scene& scene, const Node& node)
        : ui_(ui), scene_(scene), node_(node), selection_(ui.selected()), parent_(find_parent(scene, node.id)) {}

    Edits draw() {
        const bool many = selected_nodes(selection_).size() > 1;
        const bool holds = info(node_.kind).takes_children();
        if (holds && !many && ImGui::BeginMenu("Add inside")) {
            if (auto added = node_menu(ui_, "add_inside", scene_)) {
                edits_ = {InsertNode{node_.id, -1, std::move(*added)}};
                ImGui::CloseCurrentPopup();
            }
            ImGui::EndMenu();
        }
        if (parent_) {
            change_kind(many);
            wrap();
            ImGui::Separator();
            if (!many && ImGui::MenuItem("Rename", "F2")) ui_.focus_name = true;
            entry("Duplicate", "Ctrl+D", duplicate_selection(scene_, selection_));
        }
        clipboard(holds && !many);
        if (parent_) {
            ImGui::Separator();
            entry("Move up", "Alt+Up", shift_selection(scene_, selection_, -1));
            entry("Move down", "Alt+Down", shift_selection(scene_, selection_, 1));
            ImGui::Separator();
            entry("Group", "Ctrl+G", group_selection(scene_, selection_));
            entry("Dissolve", "Ctrl+Shift+G", dissolve_selection(scene_, selection_));
            ImGui::Separator();
            show_and_lock();
            ImGui::Separator();
            if (node_.kind == NodeKind::instance) {
                if (!many && ImGui::MenuItem("Go to definition")) go_to(ui_, node_.definition);
                entry("Make independent", "Ctrl+Shift+I", free_selection(scene_, selection_));
            } else {
                entry("Make definition", "Ctrl+I", define_selection(scene_, selection_));
            }
            ui_.report.item("context", "definition");
            ImGui::Separator();
            entry("Delete", "Del", delete_selection(scene_, selection_));
        } else if (node_.id != scene_.root.id) {
            ImGui::Separator();
            entry("Add instance", nullptr, {InsertNode{scene_.root.id, -1, make_instance(node_)}});
            if (ImGui::MenuItem("Rename", "F2")) ui_.focus_name = true;
            const bool unused = count_uses(scene_, node_.id) == 0;
            entry("Delete", "Del", unused ? delete_selection(scene_, selection_) : Edits{});
        }
        return std::move(edits_);
    }

private:
    /// Greyed where there is nothing to do.
    void entry(const char* label, const char* key, Edits edits) {
        if (ImGui::MenuItem(label, key, false, !edits.empty())) edits_ = std::move(edits);
        ui_.report.item("context", label);
    }

    void change_kind(bool many) {
        if (many || !ImGui::BeginMenu("Change kind")) return;
        const auto allowed = [&](const KindInfo& k) { return node_.children.empty() || k.takes_children(); };
        if (const auto kind = kind_menu(ui_, "change_kind", allowed); kind && *kind != node_.kind) {
            edits_ = {SetKind{node_.id, *kind}};
            ImGui::CloseCurrentPopup();
        }
        ImGui::EndMenu();
    }

    void wrap() {
        const bool open = ImGui::BeginMenu("Wrap in");
        ui_.report.item("context", "Wrap in");
        if (!open) return;
        if (const auto kind = kind_menu(ui_, "wrap", [](const KindInfo& k) { return k.takes_children(); })) {
            edits_ = wrap_selection(scene_, selection_, *kind);
            ImGui::CloseCurrentPopup();
        }
        ImGui::EndMenu();
    }

    void clipboard(bool paste_inside) {
        if (ImGui::MenuItem("Copy", "Ctrl+C")) ImGui::SetClipboardText(copied_selection(scene_, selection_).c_str());
        if (!paste_inside) return;
        if (!ImGui::MenuItem("Paste inside")) return;
        const char* text = ImGui::GetClipboardText();
        try {
            edits_ = paste_into(node_.id, text ? text : "");
        } catch (const EditError& error) {
            ui_.problem = error.what();
        }
    }

    void show_and_lock() {
        entry(node_.hidden ? "Show" : "Hide", "H", hide_selection(scene_, selection_));
        entry("Show only this", "Shift+H", show_only_selection(scene_, selection_));
        entry("Show everything", "Alt+H", show_everything(scene_));
        entry(node_.locked ? "Unlock" : "Lock", "L", lock_selection(scene_, selection_));
    }

    Ui& ui_;
    const Scene& scene_;
    const Node& node_;
    const Selection selection_;
    const Node* parent_;
    Edits edits_;
};

}  // namespace

Edits tree_menu(Ui& ui, const Scene& scene, const Node& node) { return Menu(ui, scene, node).draw(); }

}  // namespace farfield
