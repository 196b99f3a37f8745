#include "app/split_view.h"

#include "ui/value_row.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>

namespace farfield {
namespace {

float divider_at(const Ui& ui, ImVec2 low, ImVec2 size) {
    const float part = std::clamp(ui.tools.split.divider, SplitView::least_part, 1.0f - SplitView::least_part);
    return low.x + std::round(part * size.x);
}

std::string method_label(Method method) { return label_of(method_keys[static_cast<std::size_t>(method)]); }
const char* view_label(View view) { return views()[static_cast<std::size_t>(view)].label; }

/// The method, and of the rest what is not usual or differs from the other side.
std::string text_of(const Look& look, const Look& beside) {
    std::string text = method_label(look.method);
    if (look.view != View::result || beside.view != View::result) text += fmt::format(", {}", view_label(look.view));
    if (look.blur_levels != beside.blur_levels)
        text += look.blur_levels < 0
                    ? ", auto blur"
                    : fmt::format(", {} blur {}", look.blur_levels, look.blur_levels == 1 ? "level" : "levels");
    return text;
}

/// A row of B's menu: as A has it, or one of `count` others.
template <class T, class Label>
void choice(Ui& ui, const char* title, const char* name, std::optional<T>& chosen, int count, Label label) {
    row_label(ui, title, chosen.has_value());
    const bool open = ImGui::BeginCombo(fmt::format("##{}", name).c_str(),
                                        chosen ? label(static_cast<int>(*chosen)).c_str() : "Same as A",
                                        ImGuiComboFlags_HeightLargest);
    ui.report.item("split", name);
    if (!open) return;
    if (ImGui::Selectable("Same as A", !chosen)) chosen.reset();
    ui.report.item(fmt::format("split/{}", name), "same");
    ImGui::Separator();
    for (int i = 0; i < count; ++i) {
        if (ImGui::Selectable(label(i).c_str(), chosen == static_cast<T>(i))) chosen = static_cast<T>(i);
        ui.report.item(fmt::format("split/{}", name), label(i));
    }
    ImGui::EndCombo();
}

void menu(Ui& ui) {
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ui.theme.px(10.0f), ui.theme.px(8.0f)});
    ImGui::SetNextWindowSize({ui.theme.px(310.0f), 0.0f});
    if (ImGui::BeginPopup("split")) {
        SplitView& split = ui.tools.split;
        section(ui, "Right side, B");
        choice(ui, "Method", "method", split.method, static_cast<int>(std::size(method_keys)),
               [](int i) { return method_label(static_cast<Method>(i)); });
        choice(ui, "View", "view", split.view, static_cast<int>(views().size()),
               [](int i) { return std::string(view_label(static_cast<View>(i))); });
        choice(ui, "Blur levels", "blur_levels", split.blur_levels, 9, [](int i) { return fmt::format("{}", i); });
        ImGui::PushFont(ui.theme.small_font);
        ImGui::PushTextWrapPos(0.0f);
        ImGui::TextDisabled("A, on the left, is what Render says. Both are made of the same samples.");
        ImGui::PopTextWrapPos();
        ImGui::PopFont();
        ImGui::EndPopup();
    }
    ImGui::PopStyleVar();
}

/// One beside the other at the divider, or as near to it as there is room.
struct Labels {
    std::string texts[2];
    ImVec2 low[2], high[2];
    bool hovered = false;  ///< that of B
};

Labels place_labels(const Ui& ui, const Scene& scene, ImVec2 low, ImVec2 size, float x) {
    const Look own = own_look(ui, scene), other = ui.tools.split.other(own);
    Labels labels{{"A  " + text_of(own, other), "B  " + text_of(other, own)}, {}, {}};
    const float pad = ui.theme.px(8.0f), gap = ui.theme.px(10.0f), arrow = ui.theme.px(16.0f);
    const float height = ImGui::GetTextLineHeight() + pad, y = low.y + size.y - height - pad;
    const float widths[] = {ImGui::CalcTextSize(labels.texts[0].c_str()).x + 2.0f * pad,
                            ImGui::CalcTextSize(labels.texts[1].c_str()).x + 2.0f * pad + arrow};
    const float least = low.x + pad, most = low.x + size.x - pad;
    float left = std::max(x - gap - widths[0], least);
    const float right = std::min(std::max(x + gap, left + widths[0] + gap), most - widths[1]);
    left = std::max(std::min(left, right - gap - widths[0]), least);
    labels.low[0] = {left, y};
    labels.low[1] = {right, y};
    for (int side = 0; side < 2; ++side) labels.high[side] = {labels.low[side].x + widths[side], y + height};
    return labels;
}

void draw_labels(const Ui& ui, const Labels& labels) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float pad = ui.theme.px(8.0f), rounding = ui.theme.px(4.0f);
    for (int side = 0; side < 2; ++side) {
        const ImVec2 low = labels.low[side], high = labels.high[side];
        draw.AddRectFilled(low, high, ui.theme.overlay, rounding);
        if (side == 1 && labels.hovered)
            draw.AddRectFilled(low, high, ImGui::GetColorU32(ImGuiCol_HeaderHovered), rounding);
        draw.AddText({low.x + pad, low.y + pad * 0.5f}, ui.theme.text, labels.texts[side].c_str());
    }
    const float half = ui.theme.px(4.0f);
    const ImVec2 tip{labels.high[1].x - pad - half, 0.5f * (labels.low[1].y + labels.high[1].y) + 0.75f * half};
    draw.AddTriangleFilled({tip.x - half, tip.y - 1.3f * half}, {tip.x + half, tip.y - 1.3f * half}, tip,
                           ui.theme.text);
}

}  // namespace

Look own_look(const Ui& ui, const Scene& scene) { return {ui.view, scene.settings.method, scene.settings.blur_levels}; }

void split_controls(Ui& ui, const Scene& scene, ImVec2 low, ImVec2 size) {
    SplitView& split = ui.tools.split;
    if (!split.on) return;
    // The labels come before the divider, so that the mouse is theirs where they are, and are drawn after it.
    Labels labels = place_labels(ui, scene, low, size, divider_at(ui, low, size));
    ImGui::SetCursorScreenPos(labels.low[1]);
    if (ImGui::InvisibleButton("B", {labels.high[1].x - labels.low[1].x, labels.high[1].y - labels.low[1].y}))
        ImGui::OpenPopup("split");
    labels.hovered = ImGui::IsItemHovered();
    ui.report.item("split", "b");
    ui.report.rectangle("split", "a", labels.low[0], labels.high[0]);
    tooltip(ui, "What the right side shows: another method, view or number of blur levels");
    menu(ui);
    const float half = ui.theme.px(5.0f);
    ImGui::SetCursorScreenPos({divider_at(ui, low, size) - half, low.y});
    ImGui::InvisibleButton("divider", {2.0f * half, size.y});
    ui.report.item("split", "divider");
    const bool active = ImGui::IsItemActive(), lit = active || ImGui::IsItemHovered();
    if (lit) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    if (active && ImGui::IsMouseDragging(ImGuiMouseButton_Left, 0.0f) && ImGui::GetIO().MouseDelta.x != 0.0f)
        split.divider = std::clamp((ImGui::GetIO().MousePos.x - low.x) / size.x, SplitView::least_part,
                                   1.0f - SplitView::least_part);
    if (lit && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) split.divider = 0.5f;
    tooltip(ui, "Drag to compare both sides", "Double-click: back to the middle");
    const float x = divider_at(ui, low, size), line = ui.theme.px(1.0f);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.AddRectFilled({x - 1.5f * line, low.y}, {x + 1.5f * line, low.y + size.y}, IM_COL32(10, 11, 13, 150));
    draw.AddRectFilled({x - 0.5f * line, low.y}, {x + 0.5f * line, low.y + size.y},
                       lit ? ui.theme.accent : ui.theme.text);
    draw_labels(ui, labels);
}

void split_picture(const Ui& ui, const RenderedPicture& picture, ImVec2 low, ImVec2 size) {
    const auto id = [](unsigned texture) { return (ImTextureID) static_cast<std::intptr_t>(texture); };
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImVec2 high{low.x + size.x, low.y + size.y};
    draw.AddImage(id(picture.texture), low, high);
    if (!ui.tools.split.on || picture.other == 0) return;
    const float x = divider_at(ui, low, size);
    draw.AddImage(id(picture.other), {x, low.y}, high, {(x - low.x) / size.x, 0.0f}, {1.0f, 1.0f});
}

}  // namespace farfield
