#include "app/picture_toolbar.h"

#include <cmath>
#include <iterator>

namespace farfield {
namespace {

using Draw = void (*)(ImDrawList& draw, ImVec2 centre, float r, ImU32 color, float thick);

void head(ImDrawList& draw, ImVec2 tip, float x, float y, float size, ImU32 color) {
    draw.AddTriangleFilled(tip, {tip.x - x * size - y * size * 0.7f, tip.y - y * size - x * size * 0.7f},
                           {tip.x - x * size + y * size * 0.7f, tip.y - y * size + x * size * 0.7f}, color);
}

void hand_sign(ImDrawList& draw, ImVec2 c, float r, ImU32 color, float) {
    const ImVec2 at{c.x - 0.45f * r, c.y - 0.85f * r};
    draw.AddTriangleFilled(at, {at.x, at.y + 1.6f * r}, {at.x + 1.15f * r, at.y + 1.1f * r}, color);
}

void move_sign(ImDrawList& draw, ImVec2 c, float r, ImU32 color, float thick) {
    draw.AddLine({c.x - 0.8f * r, c.y}, {c.x + 0.8f * r, c.y}, color, thick);
    draw.AddLine({c.x, c.y - 0.8f * r}, {c.x, c.y + 0.8f * r}, color, thick);
    for (const float side : {-1.0f, 1.0f}) {
        head(draw, {c.x + side * r, c.y}, side, 0.0f, 0.4f * r, color);
        head(draw, {c.x, c.y + side * r}, 0.0f, side, 0.4f * r, color);
    }
}

void rotate_sign(ImDrawList& draw, ImVec2 c, float r, ImU32 color, float thick) {
    draw.PathArcTo(c, 0.8f * r, -0.9f, 4.2f, 20);
    draw.PathStroke(color, 0, thick);
    head(draw, {c.x + 0.1f * r, c.y - 1.05f * r}, 0.85f, -0.5f, 0.55f * r, color);
}

void scale_sign(ImDrawList& draw, ImVec2 c, float r, ImU32 color, float thick) {
    draw.AddRect({c.x - 0.85f * r, c.y + 0.05f * r}, {c.x - 0.05f * r, c.y + 0.85f * r}, color, 0.0f, 0, thick);
    draw.AddLine({c.x + 0.1f * r, c.y - 0.1f * r}, {c.x + 0.7f * r, c.y - 0.7f * r}, color, thick);
    head(draw, {c.x + 0.95f * r, c.y - 0.95f * r}, 0.7f, -0.7f, 0.55f * r, color);
}

void sun_sign(ImDrawList& draw, ImVec2 c, float r, ImU32 color, float thick) {
    draw.AddCircleFilled(c, 0.42f * r, color);
    for (int ray = 0; ray < 8; ++ray) {
        const float a = static_cast<float>(ray) * 0.78539816f, x = std::cos(a), y = std::sin(a);
        draw.AddLine({c.x + 0.65f * r * x, c.y + 0.65f * r * y}, {c.x + r * x, c.y + r * y}, color, thick);
    }
}

void grid_sign(ImDrawList& draw, ImVec2 c, float r, ImU32 color, float thick) {
    for (const float at : {-0.4f, 0.4f}) {
        draw.AddLine({c.x + at * r, c.y - 0.9f * r}, {c.x + at * r, c.y + 0.9f * r}, color, thick);
        draw.AddLine({c.x - 0.9f * r, c.y + at * r}, {c.x + 0.9f * r, c.y + at * r}, color, thick);
    }
}

void split_sign(ImDrawList& draw, ImVec2 c, float r, ImU32 color, float thick) {
    draw.AddRect({c.x - 0.95f * r, c.y - 0.75f * r}, {c.x + 0.95f * r, c.y + 0.75f * r}, color, 0.0f, 0, thick);
    draw.AddRectFilled({c.x, c.y - 0.75f * r}, {c.x + 0.95f * r, c.y + 0.75f * r}, color);
}

/// A button with a sign; true when pressed.
bool tool_button(Ui& ui, const char* name, bool on, Draw sign, const char* tip, const char* key) {
    const float side = ui.theme.px(26.0f);
    const bool pressed = ImGui::InvisibleButton(name, {side, side});
    ui.report.item("tools", name);
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    if (on || ImGui::IsItemHovered())
        draw.AddRectFilled(low, high, ImGui::GetColorU32(on ? ImGuiCol_Header : ImGuiCol_HeaderHovered),
                           ui.theme.px(4.0f));
    sign(draw, {0.5f * (low.x + high.x), 0.5f * (low.y + high.y)}, ui.theme.px(8.0f),
         on ? ui.theme.accent : ui.theme.text, ui.theme.px(1.5f));
    tooltip(ui, tip, key);
    return pressed;
}

bool text_button(Ui& ui, const char* name, const char* text, float width, const char* tip, const char* key) {
    const bool pressed = ImGui::InvisibleButton(name, {ui.theme.px(width), ui.theme.px(26.0f)});
    ui.report.item("tools", name);
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    if (ImGui::IsItemHovered())
        draw.AddRectFilled(low, high, ImGui::GetColorU32(ImGuiCol_HeaderHovered), ui.theme.px(4.0f));
    const ImVec2 size = ImGui::CalcTextSize(text);
    draw.AddText({std::floor(0.5f * (low.x + high.x - size.x)), std::floor(0.5f * (low.y + high.y - size.y))},
                 ui.theme.text, text);
    tooltip(ui, tip, key);
    return pressed;
}

/// A thin line between groups of tools.
void divide(const Ui& ui) {
    ImGui::SameLine(0.0f, ui.theme.px(4.0f));
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::GetWindowDrawList()->AddLine({at.x, at.y + ui.theme.px(5.0f)}, {at.x, at.y + ui.theme.px(21.0f)},
                                        ImGui::GetColorU32(ImGuiCol_Border));
    ImGui::Dummy({1.0f, 1.0f});
    ImGui::SameLine(0.0f, ui.theme.px(4.0f));
}

}  // namespace

float picture_toolbar(Ui& ui, ImVec2 low) {
    struct Entry {
        Tool tool;
        const char* name;
        Draw sign;
        const char* tip;
        const char* key;
    };
    static constexpr Entry tools[] = {
        {Tool::none, "select", hand_sign, "No handles: select and look around", "Q"},
        {Tool::move, "move", move_sign, "Move what is selected", "W; Ctrl while dragging: in steps"},
        {Tool::rotate, "rotate", rotate_sign, "Turn what is selected", "E; Ctrl while dragging: by 15°"},
        {Tool::scale, "scale", scale_sign, "Scale what is selected", "R; Ctrl while dragging: in steps"},
    };
    const float pad = ui.theme.px(3.0f), gap = ui.theme.px(2.0f);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    // The ground lies below the buttons and is as wide as they came to in the last frame.
    ImGuiStorage& storage = *ImGui::GetStateStorage();
    const ImGuiID width_key = ImGui::GetID("toolbar width");
    const float height = ui.theme.px(26.0f) + 2.0f * pad;
    draw.AddRectFilled(low, {low.x + storage.GetFloat(width_key), low.y + height}, ui.theme.overlay, ui.theme.px(5.0f));
    ImGui::SetCursorScreenPos({low.x + pad, low.y + pad});
    for (const Entry& entry : tools) {
        if (tool_button(ui, entry.name, ui.tools.tool == entry.tool, entry.sign, entry.tip, entry.key))
            ui.tools.tool = entry.tool;
        ImGui::SameLine(0.0f, gap);
    }
    const bool local = ui.tools.axes == Axes::local;
    if (text_button(ui, "axes", local ? "Local" : "World", 50.0f, "Axes of the handles: the world's, or the node's own",
                    "X"))
        ui.tools.axes = local ? Axes::world : Axes::local;
    divide(ui);
    if (tool_button(ui, "lights", ui.tools.lights, sun_sign, "Signs of the lights", "Shift+L"))
        ui.tools.lights = !ui.tools.lights;
    ImGui::SameLine(0.0f, gap);
    if (tool_button(ui, "grid", ui.tools.grid, grid_sign, "Grid on the ground, and the axes", "G"))
        ui.tools.grid = !ui.tools.grid;
    ImGui::SameLine(0.0f, gap);
    if (tool_button(ui, "split", ui.tools.split.on, split_sign, "Two methods or views side by side", "V"))
        ui.tools.split.on = !ui.tools.split.on;
    divide(ui);
    static constexpr std::pair<int, const char*> resolutions[] = {{1, "100 %"}, {2, "50 %"}, {4, "25 %"}};
    std::size_t chosen = 0;
    while (chosen + 1 < std::size(resolutions) && resolutions[chosen].first != ui.tools.divisor) ++chosen;
    if (text_button(ui, "resolution", resolutions[chosen].second, 50.0f,
                    "Resolution of the picture: fewer pixels come sooner where a frame takes long",
                    "A click goes to the next of 100, 50 and 25 %"))
        ui.tools.divisor = resolutions[(chosen + 1) % std::size(resolutions)].first;
    storage.SetFloat(width_key, ImGui::GetItemRectMax().x + pad - low.x);
    return height;
}

}  // namespace farfield
