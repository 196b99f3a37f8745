#include "app/light_handles.h"

#include "ui/value_row.h"

#include <array>

namespace farfield {
namespace {

constexpr float sun_radius = 6.0f, sun_reach = 12.0f;          // at 96 dpi
constexpr float arrow_length = 58.0f, arrow_distance = 64.0f;  // of its tip from the middle of the picture
constexpr float hand = 5.0f;                                   // how far off a click may be

ImVec2 im(glm::vec2 v) { return {v.x, v.y}; }

std::optional<LightSign> sign_of(const Ui& ui, const Scene& scene, const PictureView& view, const Light& light) {
    LightSign sign{light.id, light.kind};
    if (light.kind == LightKind::point) {
        const auto at = view.project(light.position);
        if (!at) return std::nullopt;
        sign.from = sign.to = *at;
        return sign;
    }
    const float pixel = view.metres_per_pixel(scene.camera.target) * ui.theme.scale;
    if (glm::length(light.direction) == 0.0f || pixel == 0.0f) return std::nullopt;
    const glm::vec3 back = -glm::normalize(light.direction), target = scene.camera.target;
    const auto to = view.project(target + arrow_distance * pixel * back);
    const auto from = view.project(target + (arrow_distance + arrow_length) * pixel * back);
    if (!to || !from) return std::nullopt;
    sign.to = *to;
    sign.from = *from;
    return sign;
}

float distance_to(const LightSign& sign, glm::vec2 p) {
    const glm::vec2 along = sign.to - sign.from;
    const float length = glm::dot(along, along);
    const float t = length > 0.0f ? std::clamp(glm::dot(p - sign.from, along) / length, 0.0f, 1.0f) : 0.0f;
    return glm::distance(p, sign.from + t * along);
}

void draw_sun(const Ui& ui, glm::vec2 at, ImU32 color, ImU32 shade, float thick) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float radius = ui.theme.px(sun_radius), reach = ui.theme.px(sun_reach);
    for (const bool rim : {true, false}) {
        const float more = rim ? ui.theme.px(2.0f) : 0.0f;
        for (int ray = 0; ray < 8; ++ray) {
            const float a = static_cast<float>(ray) * 0.78539816f;
            const glm::vec2 out{std::cos(a), std::sin(a)};
            draw.AddLine(im(at + (radius + ui.theme.px(2.5f)) * out), im(at + (reach + 0.5f * more) * out),
                         rim ? shade : color, thick + more);
        }
        draw.AddCircleFilled(im(at), radius + 0.5f * more, rim ? shade : color);
    }
}

void draw_arrow(const Ui& ui, glm::vec2 from, glm::vec2 to, ImU32 color, ImU32 shade, float thick) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const glm::vec2 along = glm::normalize(to - from + glm::vec2(0.0f, 1e-3f)), across{-along.y, along.x};
    const float head = ui.theme.px(11.0f), wide = ui.theme.px(5.5f), rim = ui.theme.px(1.0f);
    const glm::vec2 base = to - head * along;
    draw.AddLine(im(from), im(base), shade, thick + 2.0f * rim);
    draw.AddTriangleFilled(im(to + 2.0f * rim * along), im(base - rim * along - (wide + rim) * across),
                           im(base - rim * along + (wide + rim) * across), shade);
    draw.AddCircleFilled(im(from), ui.theme.px(5.0f) + rim, shade);
    draw.AddLine(im(from), im(base), color, thick);
    draw.AddTriangleFilled(im(to), im(base - wide * across), im(base + wide * across), color);
    draw.AddCircleFilled(im(from), ui.theme.px(5.0f), color);
}

}  // namespace

std::vector<LightSign> light_signs(const Ui& ui, const Scene& scene, const PictureView& view) {
    std::vector<LightSign> signs;
    for (const Light& light : scene.lights) {
        if (!ui.tools.lights && !(ui.selection == ObjectRef{ObjectType::light, light.id})) continue;
        if (const auto sign = sign_of(ui, scene, view, light)) signs.push_back(*sign);
    }
    return signs;
}

Id light_at(const Ui& ui, const std::vector<LightSign>& signs, glm::vec2 mouse) {
    Id best = 0;
    float nearest = 1e9f;
    for (const LightSign& sign : signs) {
        const float reach = ui.theme.px(hand + (sign.kind == LightKind::point ? sun_radius : 0.0f));
        const float distance = distance_to(sign, mouse);
        if (distance <= reach && distance < nearest) nearest = distance, best = sign.light;
    }
    return best;
}

void draw_light_signs(Ui& ui, const Scene& scene, const std::vector<LightSign>& signs, Id hovered) {
    for (const LightSign& sign : signs) {
        const Light* light = find_light(scene, sign.light);
        if (!light) continue;
        // Its hue, as bright as can be.
        const float most = std::max({light->intensity.x, light->intensity.y, light->intensity.z, 1e-6f});
        const bool selected = ui.selection == ObjectRef{ObjectType::light, light->id};
        const ImU32 color =
            selected ? ui.theme.accent : ImGui::ColorConvertFloat4ToU32(display_color(light->intensity / most));
        const ImU32 shade = IM_COL32(10, 11, 13, 190);
        const float thick = ui.theme.px(selected || hovered == light->id ? 3.0f : 2.0f);
        if (sign.kind == LightKind::point)
            draw_sun(ui, sign.from, color, shade, thick);
        else
            draw_arrow(ui, sign.from, sign.to, color, shade, thick);
        const glm::vec2 middle = 0.5f * (sign.from + sign.to);
        if (!ImGui::IsRectVisible(im(middle), im(middle))) continue;
        ui.report.rectangle("light", light->name, {middle.x - 3.0f, middle.y - 3.0f},
                            {middle.x + 3.0f, middle.y + 3.0f});
    }
}

}  // namespace farfield
