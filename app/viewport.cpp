#include "app/viewport.h"

#include "app/camera_control.h"
#include "sdf/pick.h"
#include "ui/statistics_panel.h"
#include "ui/tree_edits.h"

#include <cmath>
#include <cstdint>

namespace farfield {
namespace {

void centred_text(const Ui& ui, ImVec2 low, ImVec2 high, float line, const char* text, ImU32 color) {
    const ImVec2 size = ImGui::CalcTextSize(text);
    const ImVec2 at{std::floor((low.x + high.x - size.x) * 0.5f),
                    std::floor((low.y + high.y - size.y) * 0.5f + line * size.y * 1.5f)};
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float pad = ui.theme.px(8.0f);
    draw.AddRectFilled({at.x - pad, at.y - pad * 0.5f}, {at.x + size.x + pad, at.y + size.y + pad * 0.5f},
                       ui.theme.overlay, pad * 0.5f);
    draw.AddText(at, color, text);
}

Edits move_camera(const Scene& scene, float height, bool& wheel) {
    const ImGuiIO& io = ImGui::GetIO();
    const glm::vec2 drag(io.MouseDelta.x, io.MouseDelta.y);
    Camera camera = scene.camera;
    if (ImGui::IsItemActive() && drag != glm::vec2(0.0f)) {
        const bool pan = ImGui::IsMouseDown(ImGuiMouseButton_Middle) || io.KeyShift;
        camera = pan ? panned(camera, drag, height) : orbited(camera, drag, height);
    }
    if (ImGui::IsItemHovered() && io.MouseWheel != 0.0f) {
        camera = zoomed(camera, io.MouseWheel);
        wheel = true;
    }
    return camera_edits(scene.camera, camera);
}

/// The shape under the mouse, the scene where there is none; the group around what is selected already, so that further
/// clicks go up the tree.
Id node_under_mouse(const Ui& ui, const Scene& scene, ImVec2 low, ImVec2 size) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const glm::vec2 at((mouse.x - low.x) / size.x, (mouse.y - low.y) / size.y);
    const glm::vec3 direction = CameraBasis(scene.camera).direction(at, size.x / size.y);
    const std::optional<Pick> hit = pick(FieldEvaluator(scene), scene.camera.position, direction);
    if (!hit || find_lock(scene, hit->node)) return scene.root.id;
    if (ImGui::GetIO().KeyCtrl) return hit->node;
    if (ui.selection.type == ObjectType::node)
        for (const Node* node = find_node(scene, hit->node); node; node = find_parent(scene, node->id))
            if (node->id == ui.selection.id && node->id != scene.root.id) return find_parent(scene, node->id)->id;
    return hit->node;
}

/// With Ctrl the node is added or taken out, and a click beside the shapes changes nothing.
void select_under_mouse(Ui& ui, const Scene& scene, Id node) {
    if (!ImGui::GetIO().KeyCtrl)
        ui.select(select(ObjectRef{ObjectType::node, ui.reveal = node}));
    else if (node != scene.root.id)
        ui.select(toggled(ui.selected(), ui.reveal = node));
}

}  // namespace

ViewportResult viewport(Ui& ui, const Scene& scene, const RenderedPicture& picture, float covered) {
    const ImVec2 low = ImGui::GetCursorScreenPos();
    ImVec2 size = ImGui::GetContentRegionAvail();
    size = {std::floor(std::max(size.x, 16.0f)), std::floor(std::max(size.y, 16.0f))};
    const ImVec2 high{low.x + size.x, low.y + size.y};
    ViewportResult result;
    result.size = {size.x, size.y};

    // Row 0 of the texture is the top of the picture, as ImGui has it.
    if (picture.texture != 0) ImGui::Image((ImTextureID) static_cast<std::intptr_t>(picture.texture), size);
    ImGui::SetCursorScreenPos(low);
    ImGui::InvisibleButton("picture", size, ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle);
    ui.report.item("viewport", "");
    result.edits = move_camera(scene, size.y, result.wheel);
    const float moved = ImGui::GetIO().MouseDragMaxDistanceSqr[ImGuiMouseButton_Left];
    if (ImGui::IsItemDeactivated() && ImGui::IsMouseReleased(ImGuiMouseButton_Left) && moved < 9.0f)
        select_under_mouse(ui, scene, node_under_mouse(ui, scene, low, size));
    if (ImGui::IsItemHovered() && !ImGui::IsItemActive()) ImGui::SetMouseCursor(ImGuiMouseCursor_Arrow);

    const bool nothing_shows = is_empty(scene, scene.root);
    if (nothing_shows && !show_everything(scene).empty()) {
        centred_text(ui, low, high, 0.0f, "Nothing shows. Alt+H shows all that is hidden", ui.theme.text);
    } else if (nothing_shows) {
        centred_text(ui, low, high, -0.5f, "There is no shape in the scene yet", ui.theme.text);
        centred_text(ui, low, high, 0.7f, "Press + Add in the Scene panel, or A, to put in a first one", ui.theme.dim);
    } else if (picture.texture == 0 && picture.error.empty()) {
        centred_text(ui, low, high, 0.0f, "Preparing the first picture...", ui.theme.text);
    }
    const float margin = ui.theme.px(8.0f);
    if (ui.view != View::result) {
        const ViewInfo& view = views()[static_cast<std::size_t>(ui.view)];
        const ImVec2 text = ImGui::CalcTextSize(view.label);
        const ImVec2 at{low.x + 2.0f * margin, low.y + covered + 1.5f * margin};
        ImDrawList& draw = *ImGui::GetWindowDrawList();
        draw.AddRectFilled({at.x - margin, at.y - margin * 0.5f},
                           {at.x + text.x + margin, at.y + text.y + margin * 0.5f}, ui.theme.overlay, margin * 0.5f);
        draw.AddText(at, ui.theme.accent, view.label);
    }
    if (ui.show_statistics && picture.texture != 0)
        statistics_overlay(ui, picture.statistics, {high.x - margin, low.y + covered + margin},
                           {size.x - 2.0f * margin, size.y - covered - 2.0f * margin});
    return result;
}

}  // namespace farfield
