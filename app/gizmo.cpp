#include "app/gizmo.h"

#include "sdf/fields.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace farfield {
namespace {

constexpr const char* axis_names[] = {"x", "y", "z"};
constexpr const char* plane_names[] = {"yz", "zx", "xy"};

ImVec2 im(glm::vec2 v) { return {v.x, v.y}; }

ImU32 with_alpha(ImU32 color, float alpha) {
    const float a = static_cast<float>(color >> IM_COL32_A_SHIFT) * alpha;
    return (color & ~IM_COL32_A_MASK) | (static_cast<ImU32>(a) << IM_COL32_A_SHIFT);
}

const char* name_of(Handle handle) {
    if (handle.part == Handle::Part::view) return "view";
    return handle.part == Handle::Part::axis ? axis_names[handle.axis] : plane_names[handle.axis];
}

}  // namespace

std::optional<Gizmo::Target> Gizmo::find_target(const Ui& ui, const Scene& scene) {
    const ObjectRef object = ui.selection;
    if (ui.tools.tool == Tool::none) return std::nullopt;
    if (object.type == ObjectType::light) {
        const Light* light = find_light(scene, object.id);
        if (!light) return std::nullopt;
        if (light->kind == LightKind::point) return Target{object, Tool::move, {light->position}};
        return Target{object, Tool::rotate, {scene.camera.target}};
    }
    if (object.type != ObjectType::node || object.id == scene.root.id) return std::nullopt;
    const Node* node = find_node(scene, object.id);
    const auto parent = node && !find_lock(scene, object.id) ? parent_frame(scene, object.id) : std::nullopt;
    if (!parent) return std::nullopt;
    const Frame own = parent->placed(node->transform);
    return Target{object, ui.tools.tool, {own.origin, ui.tools.axes == Axes::local ? own.rotation : glm::mat3(1.0f)}};
}

/// Each moves, turns and grows as much as the others, about its own origin.
std::vector<Gizmo::HeldNode> Gizmo::find_nodes(const Ui& ui, const Scene& scene) {
    std::vector<HeldNode> nodes;
    for (const Id id : topmost(scene, selected_nodes(ui.selected()))) {
        const Node* node = find_node(scene, id);
        const auto parent = node && !find_lock(scene, id) ? parent_frame(scene, id) : std::nullopt;
        if (parent) nodes.push_back({id, *parent, node->transform, node->transform.rotate});
    }
    return nodes;
}

void Gizmo::refresh(const Ui& ui, const Scene& scene, const PictureView& view, bool mouse_free) {
    length_ = ui.theme.px(90.0f);
    target_ = find_target(ui, scene);
    hovered_.reset();
    if (!target_ || !mouse_free) return;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    hovered_ = GizmoShape(view, target_->tool, target_->pose, length_).at({mouse.x, mouse.y});
}

void Gizmo::begin(const Ui& ui, const Scene& scene, const PictureView& view, glm::vec2 mouse) {
    dragged_ = *target_;
    drag_.emplace(view, dragged_.tool, *hovered_, dragged_.pose, mouse, length_);
    motion_ = {};
    metres_per_pixel_ = view.metres_per_pixel(dragged_.pose.origin);
    nodes_ = find_nodes(ui, scene);
    if (const Light* light = find_light(scene, dragged_.object.id)) light_ = *light;
}

Edits Gizmo::drag(const Scene& scene, glm::vec2 mouse) {
    Edits edits;
    if (!exists(scene, dragged_.object)) return edits;  // undone meanwhile
    Snap snap;
    if (ImGui::GetIO().KeyCtrl) snap = {0.1f * grid_step(scene.camera), 15.0f, 0.1f};
    motion_ = drag_->to(mouse, snap);
    // Rounding to what a hand can tell apart would leave the steps.
    const float finest = std::min(metres_per_pixel_, snap.metres > 0.0f ? 0.01f * snap.metres : metres_per_pixel_);
    const auto set = [&](ObjectRef object, const char* key, glm::vec3 to) {
        if (value(scene, object, key) != to) edits.push_back(SetValue{object, key, to});
    };
    if (dragged_.object.type == ObjectType::light) {
        if (dragged_.tool == Tool::move)
            set(dragged_.object, "position", moved_point(light_.position, motion_, finest));
        else
            set(dragged_.object, "direction", turned_direction(light_.direction, motion_));
        return edits;
    }
    for (HeldNode& node : nodes_) {
        const ObjectRef object{ObjectType::node, node.id};
        if (!exists(scene, object)) continue;
        const Transform to = moved(node.start, node.parent, motion_, finest, node.last_rotate);
        node.last_rotate = to.rotate;
        set(object, "translate", to.translate);
        set(object, "rotate", to.rotate);
        set(object, "scale", {to.scale, 0.0f, 0.0f});
    }
    return edits;
}

std::string Gizmo::value_text() const {
    const Handle handle = drag_->handle();
    if (drag_->tool() == Tool::scale) return fmt::format("x {:.3g}", motion_.factor);
    if (drag_->tool() == Tool::rotate) return fmt::format("{:+.1f}°", motion_.angle);
    std::array<float, 3> along{};
    for (int i = 0; i < 3; ++i) {
        along[static_cast<std::size_t>(i)] = glm::dot(motion_.shift, drag_->pose().axes[i]);
        if (std::abs(along[static_cast<std::size_t>(i)]) < 0.5f * metres_per_pixel_)
            along[static_cast<std::size_t>(i)] = 0.0f;
    }
    const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(std::max(metres_per_pixel_, 1e-6f)))), 0, 6);
    std::string text;
    for (int i = 0; i < 3; ++i) {
        if (handle.part == Handle::Part::axis ? i != handle.axis
                                              : handle.part == Handle::Part::plane && i == handle.axis)
            continue;
        text += fmt::format("{}{} {:+.{}f} m", text.empty() ? "" : "   ", axis_names[i],
                            along[static_cast<std::size_t>(i)] + 0.0f, decimals);
    }
    return text;
}

void Gizmo::draw_value(const Ui& ui, const PictureView& view) const {
    const std::string text = value_text();
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const float pad = ui.theme.px(6.0f);
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    // Beside the mouse, inside the picture.
    const ImVec2 at{
        std::clamp(mouse.x + ui.theme.px(18.0f), view.low.x + pad, view.low.x + view.size.x - size.x - pad),
        std::clamp(mouse.y + ui.theme.px(18.0f), view.low.y + pad, view.low.y + view.size.y - size.y - pad)};
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.AddRectFilled({at.x - pad, at.y - 0.5f * pad}, {at.x + size.x + pad, at.y + size.y + 0.5f * pad},
                       ui.theme.overlay, 0.5f * pad);
    draw.AddText(at, ui.theme.accent, text.c_str());
}

void Gizmo::draw_handle(const Ui& ui, const GizmoShape& shape, Handle handle) const {
    const std::vector<glm::vec2> line = shape.outline(handle);
    const float strength = shape.strength(handle);
    if (line.empty() || strength <= 0.0f) return;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const bool lit = drag_ ? drag_->handle() == handle : hovered_ == handle;
    const bool view = handle.part == Handle::Part::view;
    const ImU32 color = with_alpha(lit    ? ui.theme.accent
                                   : view ? ui.theme.text
                                          : ui.theme.axis[handle.axis],
                                   lit ? 1.0f : strength);
    // A dark line under each coloured one keeps it legible on bright pictures.
    const ImU32 shade = with_alpha(IM_COL32(10, 11, 13, 170), strength);
    const float thick = ui.theme.px(lit ? 3.5f : 2.5f), rim = ui.theme.px(2.0f);
    std::vector<ImVec2> points;
    for (const glm::vec2 p : line) points.push_back(im(p));
    const int count = static_cast<int>(points.size());

    if (target_->tool == Tool::move && handle.part == Handle::Part::axis) {
        const glm::vec2 along = glm::normalize(line[1] - line[0] + glm::vec2(1e-6f, 0.0f)), across{-along.y, along.x};
        const float head = ui.theme.px(12.0f), wide = ui.theme.px(5.5f);
        const glm::vec2 tip = line[1] + 0.5f * head * along, base = line[1] - 0.5f * head * along;
        draw.AddLine(points[0], im(base), shade, thick + rim);
        draw.AddTriangleFilled(im(tip + 1.6f * along), im(base - (wide + 1.6f) * across),
                               im(base + (wide + 1.6f) * across), shade);
        draw.AddLine(points[0], im(base), color, thick);
        draw.AddTriangleFilled(im(tip), im(base - wide * across), im(base + wide * across), color);
    } else if (target_->tool == Tool::move) {
        draw.AddConvexPolyFilled(points.data(), count, with_alpha(color, lit ? 0.6f : 0.35f));
        draw.AddPolyline(points.data(), count, shade, ImDrawFlags_Closed, ui.theme.px(1.5f) + rim);
        draw.AddPolyline(points.data(), count, color, ImDrawFlags_Closed, ui.theme.px(1.5f));
    } else {
        const std::vector<bool> far = shape.hidden(handle);
        for (const auto& [ink, width] : {std::pair(shade, thick + rim), std::pair(color, thick)}) {
            // Runs of points on one side, each a line of its own.
            for (int from = 0; from + 1 < count;) {
                const bool behind = !far.empty() && far[static_cast<std::size_t>(from)];
                int to = from + 1;
                while (to + 1 < count && (!far.empty() && far[static_cast<std::size_t>(to)]) == behind) ++to;
                draw.AddPolyline(points.data() + from, to - from + 1, with_alpha(ink, behind ? 0.22f : 1.0f), 0,
                                 behind ? 0.6f * width : width);
                from = to;
            }
        }
        if (target_->tool == Tool::scale) {
            const ImVec2 grip = im(*shape.grip(handle));
            const float half = ui.theme.px(lit ? 6.0f : 5.0f);
            draw.AddRectFilled({grip.x - half - 1.5f, grip.y - half - 1.5f},
                               {grip.x + half + 1.5f, grip.y + half + 1.5f}, shade);
            draw.AddRectFilled({grip.x - half, grip.y - half}, {grip.x + half, grip.y + half}, color);
        }
    }
}

void Gizmo::draw(Ui& ui, const PictureView& view) {
    if (!target_) return;
    // A ring turns with what it turns: the frame of the start shows what the angle is of.
    const Pose pose = drag_ && drag_->tool() == Tool::rotate ? dragged_.pose : target_->pose;
    // And the grip of a scale stays in the hand.
    const bool scaling = drag_ && drag_->tool() == Tool::scale;
    const GizmoShape shape(view, target_->tool, pose, length_ * (scaling ? motion_.factor : 1.0f));
    if (!shape.visible()) return;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    if (drag_ && drag_->tool() == Tool::move && drag_->handle().part == Handle::Part::axis) {
        // The line that it moves along, through the picture.
        const int axis = drag_->handle().axis;
        const glm::vec3 far = view.metres_per_pixel(pose.origin) * view.size.y * pose.axes[axis];
        const auto a = view.project(pose.origin - far), b = view.project(pose.origin + far);
        draw.AddLine(im(a.value_or(shape.centre())), im(b.value_or(shape.centre())),
                     with_alpha(ui.theme.axis[axis], 0.5f), ui.theme.px(1.0f));
    }
    for (const Handle handle : handles(target_->tool)) {
        if (drag_ && !(drag_->handle() == handle)) continue;
        draw_handle(ui, shape, handle);
        const auto grip = shape.grip(handle);
        if (!ui.report.on() || !grip || !ImGui::IsRectVisible(im(*grip), im(*grip)) || shape.strength(handle) < 0.3f)
            continue;
        ui.report.rectangle("gizmo", name_of(handle), {grip->x - 2.0f, grip->y - 2.0f},
                            {grip->x + 2.0f, grip->y + 2.0f});
    }
    if (target_->tool != Tool::move) draw.AddCircleFilled(im(shape.centre()), ui.theme.px(3.0f), ui.theme.text);
    if (drag_) draw_value(ui, view);
}

}  // namespace farfield
