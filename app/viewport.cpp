#include "app/viewport.h"

#include "app/camera_control.h"
#include "app/light_handles.h"
#include "app/picture_toolbar.h"
#include "app/split_view.h"
#include "sdf/pick.h"
#include "ui/material_edits.h"
#include "ui/statistics_panel.h"
#include "ui/tree_edits.h"

#include <fmt/format.h>

#include <cmath>

namespace farfield {
namespace {

constexpr int told_compiles = 4;  // fewer are over before they are read

void label(const Ui& ui, ImVec2 at, const char* text, ImU32 color) {
    const ImVec2 size = ImGui::CalcTextSize(text);
    const float pad = ui.theme.px(8.0f);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.AddRectFilled({at.x - pad, at.y - pad * 0.5f}, {at.x + size.x + pad, at.y + size.y + pad * 0.5f},
                       ui.theme.overlay, pad * 0.5f);
    draw.AddText(at, color, text);
}

void centred_text(const Ui& ui, ImVec2 low, ImVec2 high, float line, const char* text, ImU32 color) {
    const ImVec2 size = ImGui::CalcTextSize(text);
    label(ui,
          {std::floor((low.x + high.x - size.x) * 0.5f),
           std::floor((low.y + high.y - size.y) * 0.5f + line * size.y * 1.5f)},
          text, color);
}

glm::vec2 mouse() { return {ImGui::GetIO().MousePos.x, ImGui::GetIO().MousePos.y}; }

/// What a hand has hold of there: the surface under the mouse. Where there is none, or it is so far off that a hand
/// would throw the camera, or the camera is inside of something, the point at the target's distance.
glm::vec3 grasped(const Scene& shown, const PictureView& view) {
    const Camera& camera = shown.camera;
    const float distance = glm::distance(camera.target, camera.position);
    const Ray ray = view.ray(mouse());
    const auto hit = pick(shown, ray.origin, ray.direction, 1e-3f);
    const bool in_reach = hit && hit->distance > 1e-3f * distance && hit->distance < 30.0f * distance;
    if (in_reach) return hit->position;
    const float along = glm::dot(ray.direction, view.basis.forward);
    return camera.position + ray.direction * (distance / std::max(along, 1e-3f));
}

/// The shape under the mouse, the scene where there is none; the group around what is selected already, so that further
/// clicks go up the tree.
Id node_under_mouse(const Ui& ui, const Scene& scene, const PictureView& view) {
    const Ray ray = view.ray(mouse());
    const std::optional<Pick> hit = pick(scene, ray.origin, ray.direction);
    if (!hit || find_lock(scene, hit->node)) return scene.root.id;
    if (ImGui::GetIO().KeyCtrl) return hit->node;
    if (ui.selection.type == ObjectType::node)
        for (const Node* node = find_node(scene, hit->node); node; node = find_parent(scene, node->id))
            if (node->id == ui.selection.id && node->id != scene.root.id) return find_parent(scene, node->id)->id;
    return hit->node;
}

/// Where a material is dragged over the last item: the shape under the mouse gets it. Returns what that comes to, as a
/// sentence.
std::string drop_target(const Ui& ui, const Scene& scene, const ViewportInput& input, const PictureView& view,
                        Edits& edits) {
    if (!ImGui::BeginDragDropTarget()) return {};
    std::string text;
    if (const ImGuiPayload* payload = ImGui::AcceptDragDropPayload(
            material_payload, ImGuiDragDropFlags_AcceptBeforeDelivery | ImGuiDragDropFlags_AcceptNoDrawDefaultRect)) {
        const Material* material = find_material(scene, *static_cast<const Id*>(payload->Data));
        const Ray ray = view.ray(mouse());
        const std::optional<Pick> hit = pick(FieldEvaluator(*input.shown), ray.origin, ray.direction);
        const Node* node = hit ? find_node(scene, hit->node) : nullptr;
        if (material && node) {
            text = fmt::format("{} for {}", material->name, display_name(scene, *node));
            if (payload->IsDelivery()) edits = drop_material(scene, ui.selected(), node->id, material->id);
        }
    }
    ImGui::EndDragDropTarget();
    return text;
}

/// With Ctrl the node is added or taken out, and a click beside the shapes changes nothing.
void select_under_mouse(Ui& ui, const Scene& scene, Id node) {
    if (!ImGui::GetIO().KeyCtrl)
        ui.select(select(ObjectRef{ObjectType::node, ui.reveal = node}));
    else if (node != scene.root.id)
        ui.select(toggled(ui.selected(), ui.reveal = node));
}

/// The point that the camera turns about or that is held.
void draw_pivot(const Ui& ui, const PictureView& view, glm::vec3 pivot) {
    const auto at = view.project(pivot);
    if (!at) return;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.AddCircleFilled({at->x, at->y}, ui.theme.px(4.5f), IM_COL32(10, 11, 13, 170));
    draw.AddCircleFilled({at->x, at->y}, ui.theme.px(3.0f), ui.theme.text);
}

}  // namespace

void Viewport::press(const Ui& ui, const Scene& scene, const ViewportInput& input, const PictureView& view) {
    camera_ = scene.camera;
    dragged_ = false;
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
        hold_ = Hold::fly;
        flight_scale_ = std::clamp(glm::distance(camera_.position, camera_.target), 0.05f, 1e4f);
    } else if (ImGui::IsMouseClicked(ImGuiMouseButton_Left) && gizmo_.hovered() && !ImGui::GetIO().KeyShift) {
        hold_ = Hold::gizmo;
        gizmo_.begin(ui, scene, view, mouse());
    } else {
        const bool pan = ImGui::IsMouseDown(ImGuiMouseButton_Middle) || ImGui::GetIO().KeyShift;
        hold_ = pan ? Hold::pan : Hold::orbit;
        pivot_ = grasped(*input.shown, view);
    }
}

/// What the mouse does while it is held.
void Viewport::follow(const Scene& scene, const ViewportInput& input, const PictureView& view, ViewportResult& result) {
    const ImGuiIO& io = ImGui::GetIO();
    const int button = hold_ == Hold::fly                          ? ImGuiMouseButton_Right
                       : ImGui::IsMouseDown(ImGuiMouseButton_Left) ? ImGuiMouseButton_Left
                                                                   : ImGuiMouseButton_Middle;
    if (io.MouseDragMaxDistanceSqr[button] >= 9.0f) dragged_ = true;
    const glm::vec2 drag(io.MouseDelta.x, io.MouseDelta.y);
    if (hold_ == Hold::gizmo) {
        if (dragged_) result.edits = gizmo_.drag(scene, mouse());
        return;
    }
    if (hold_ == Hold::fly) {
        flight_speed_ = std::clamp(flight_speed_ * std::pow(1.25f, io.MouseWheel), 1e-3f, 1e3f);
        const float seconds = std::min(io.DeltaTime, 0.1f);
        const glm::vec3 move = input.fly * (flight_speed_ * flight_scale_ * seconds);
        if (move != glm::vec3(0.0f) || (dragged_ && drag != glm::vec2(0.0f)))
            camera_ = flown(camera_, move, dragged_ ? drag : glm::vec2(0.0f), view.size.y);
    } else if (dragged_ && drag != glm::vec2(0.0f)) {
        if (hold_ == Hold::orbit) camera_ = orbited(camera_, pivot_, drag, view.size.y);
        if (hold_ == Hold::pan) camera_ = panned(camera_, pivot_, drag, view.size.y);
    }
    result.edits = camera_edits(scene.camera, camera_);
}

void Viewport::click(Ui& ui, const ViewportInput& input, const PictureView& view) const {
    if (hovered_light_ != 0)
        ui.select(select(ObjectRef{ObjectType::light, ui.reveal = hovered_light_}));
    else
        select_under_mouse(ui, *input.shown, node_under_mouse(ui, *input.shown, view));
}

ViewportResult Viewport::draw(Ui& ui, const Scene& scene, const ViewportInput& input, const RenderedPicture& picture,
                              float covered) {
    const ImVec2 low = ImGui::GetCursorScreenPos();
    ImVec2 size = ImGui::GetContentRegionAvail();
    size = {std::floor(std::max(size.x, 16.0f)), std::floor(std::max(size.y, 16.0f))};
    const ImVec2 high{low.x + size.x, low.y + size.y};
    const PictureView view(scene.camera, {low.x, low.y}, {size.x, size.y});
    const float margin = ui.theme.px(8.0f);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    ViewportResult result;
    result.size = {size.x, size.y};

    // The tools come before the picture, so that the mouse is theirs where they are, and are drawn after it.
    draw.ChannelsSplit(3);
    draw.ChannelsSetCurrent(2);
    const float bar = picture_toolbar(ui, {low.x + margin, low.y + covered + margin});
    draw.ChannelsSetCurrent(1);
    split_controls(ui, scene, low, size);
    draw.ChannelsSetCurrent(0);

    // Row 0 of the texture is the top of the picture, as ImGui has it.
    if (picture.texture != 0) split_picture(ui, picture, low, size);
    ImGui::SetCursorScreenPos(low);
    ImGui::InvisibleButton(
        "picture", size,
        ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle | ImGuiButtonFlags_MouseButtonRight);
    ui.report.item("viewport", "");
    const std::string dropping = drop_target(ui, scene, input, view, result.edits);
    const bool hovered = ImGui::IsItemHovered(), active = ImGui::IsItemActive();
    const std::vector<LightSign> lights = light_signs(ui, scene, view);
    if (!active) {
        gizmo_.end();
        hovered_light_ = hovered ? light_at(ui, lights, mouse()) : 0;
    }
    gizmo_.refresh(ui, scene, view, hovered && !active);
    if (ImGui::IsItemActivated()) {
        gizmo_.refresh(ui, scene, view, true);
        press(ui, scene, input, view);  // edits follow from the next frame on, when the gesture is the picture's
    } else if (active) {
        follow(scene, input, view, result);
    } else if (hovered && ImGui::GetIO().MouseWheel != 0.0f) {
        result.edits =
            camera_edits(scene.camera, zoomed(scene.camera, grasped(*input.shown, view), ImGui::GetIO().MouseWheel));
        result.wheel = true;
    }
    if (ImGui::IsItemDeactivated()) {
        if (ImGui::IsMouseReleased(ImGuiMouseButton_Left) && !dragged_) click(ui, input, view);
        hold_ = Hold::nothing;
    }
    if (hovered && !active) ImGui::SetMouseCursor(ImGuiMouseCursor_Arrow);

    draw.PushClipRect(low, high, true);
    overlay_.draw(ui, input.shown, view);
    draw_light_signs(ui, scene, lights, hovered_light_);
    gizmo_.draw(ui, view);
    if (dragged_ && (hold_ == Hold::orbit || hold_ == Hold::pan)) draw_pivot(ui, view, pivot_);
    draw.PopClipRect();

    const std::string compiling = picture.to_compile < told_compiles
                                      ? ""
                                      : fmt::format("Compiling: {} of {} parts", picture.compiled, picture.to_compile);
    const bool nothing_shows = is_empty(scene, scene.root);
    if (nothing_shows && !show_everything(scene).empty()) {
        centred_text(ui, low, high, 0.0f, "Nothing shows. Alt+H shows all that is hidden", ui.theme.text);
    } else if (nothing_shows) {
        centred_text(ui, low, high, -0.5f, "There is no shape in the scene yet", ui.theme.text);
        centred_text(ui, low, high, 0.7f, "Press + Add in the Scene panel, or A, to put in a first one", ui.theme.dim);
    } else if (picture.texture == 0 && picture.error.empty()) {
        centred_text(ui, low, high, 0.0f, "Preparing the first picture...", ui.theme.text);
        if (!compiling.empty()) centred_text(ui, low, high, 1.2f, compiling.c_str(), ui.theme.dim);
    }
    const ImVec2 below{low.x + 2.0f * margin, low.y + covered + bar + 2.5f * margin};
    if (hold_ == Hold::fly)
        label(ui, below,
              fmt::format("{:.2g} m/s    W A S D, Q E: fly    Wheel: speed    Esc: back", flight_speed_ * flight_scale_)
                  .c_str(),
              ui.theme.accent);
    else if (!dropping.empty())
        label(ui, below, dropping.c_str(), ui.theme.accent);
    else if (!compiling.empty() && picture.texture != 0)
        label(ui, below, compiling.c_str(), ui.theme.text);
    else if (ui.view != View::result && !ui.tools.split.on)
        label(ui, below, views()[static_cast<std::size_t>(ui.view)].label, ui.theme.accent);
    // Beside the tools, or below them where there is no room.
    const float top = covered + margin + (size.x < ui.theme.px(540.0f) ? bar + margin : 0.0f);
    if (ui.show_statistics && picture.texture != 0)
        statistics_overlay(ui, picture.statistics, {high.x - margin, low.y + top},
                           {size.x - 2.0f * margin, size.y - top - margin});
    draw.ChannelsMerge();
    return result;
}

}  // namespace farfield
