#include "ui/value_row.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include <algorithm>
#include <cmath>

namespace farfield {
namespace {

using glm::vec3;

float srgb_from_linear(float v) { return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1.0f / 2.4f) - 0.055f; }
float linear_from_srgb(float v) { return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f); }

/// `full`: the value where the field shows less of it.
std::string hint_text(const Parameter& parameter, const std::string& full = {}) {
    std::string initial;
    const auto number = [&](int i) { return fmt::format("{:g}", parameter.initial[i]); };
    switch (parameter.type) {
        case ParameterType::choice:
            initial = parameter.choices[static_cast<std::size_t>(parameter.initial.x)];
            break;
        case ParameterType::flag:
            initial = parameter.initial.x != 0.0f ? "on" : "off";
            break;
        case ParameterType::flags:
            for (int i = 0; i < 3; ++i)
                if (parameter.initial[i] != 0.0f) initial += "xyz"[i];
            if (initial.empty()) initial = "none";
            break;
        default:
            if (parameter.is_word(parameter.initial.x)) {
                initial = parameter.word;
                break;
            }
            initial =
                parameter.components() == 1 ? number(0) : fmt::format("{}, {}, {}", number(0), number(1), number(2));
            if (parameter.unit != Unit::none) initial += fmt::format(" {}", unit_symbol(parameter.unit));
    }
    const bool numeric = parameter.type != ParameterType::choice && !parameter.is_switch();
    return fmt::format("{}Default {}. {}Right-click to reset.", full.empty() ? "" : fmt::format("Now {}. ", full),
                       initial, numeric ? "Double-click to type; Shift drags finer, Ctrl coarser. " : "");
}

/// Right-click on the last item asks for the default.
bool asked_for_default() { return ImGui::IsItemHovered() && ImGui::IsMouseClicked(ImGuiMouseButton_Right); }

/// Fields for x, y and z side by side, each with a stripe in the colour of its axis.
bool vector_fields(Ui& ui, const std::string& name, const char* panel, const Parameter& parameter, vec3& value,
                   bool axes) {
    const float gap = ui.theme.px(4.0f);
    const float width = std::floor((ImGui::GetContentRegionAvail().x - 2.0f * gap) / 3.0f);
    const std::string_view unit = parameter.unit == Unit::degrees ? unit_symbol(parameter.unit) : "";
    bool changed = false;
    for (int i = 0; i < 3; ++i) {
        if (i > 0) ImGui::SameLine(0.0f, gap);
        ImGui::SetNextItemWidth(width);
        const char id[] = {'#', '#', "xyz"[i], 0};
        std::string full;
        changed |= number_field(ui, id, parameter, value[i], unit, nullptr, &full);
        ui.report.item(panel, name + "/" + "xyz"[i]);
        tooltip(ui, parameter.tip, hint_text(parameter, full));
        if (asked_for_default()) value[i] = parameter.initial[i], changed = true;
        if (!axes) continue;
        const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
        ImGui::GetWindowDrawList()->AddRectFilled(low, {low.x + ui.theme.px(3.0f), high.y}, ui.theme.axis[i],
                                                  ImGui::GetStyle().FrameRounding, ImDrawFlags_RoundCornersLeft);
    }
    return changed;
}

bool flag_buttons(Ui& ui, const std::string& name, const char* panel, const Parameter& parameter, vec3& value) {
    bool changed = false;
    for (int i = 0; i < 3; ++i) {
        if (i > 0) ImGui::SameLine(0.0f, ui.theme.px(4.0f));
        const bool on = value[i] != 0.0f;
        const char label[] = {"XYZ"[i], 0};
        ImGui::PushStyleColor(ImGuiCol_Button, on ? ui.theme.axis[i] : ImGui::GetColorU32(ImGuiCol_FrameBg));
        ImGui::PushStyleColor(ImGuiCol_Text, on ? IM_COL32(16, 18, 20, 255) : ui.theme.dim);
        if (ImGui::Button(label, {ui.theme.px(34.0f), 0.0f})) value[i] = on ? 0.0f : 1.0f, changed = true;
        ImGui::PopStyleColor(2);
        ui.report.item(panel, name + "/" + "xyz"[i]);
        tooltip(ui, parameter.tip, hint_text(parameter));
        if (asked_for_default()) value[i] = parameter.initial[i], changed = true;
    }
    return changed;
}

/// A swatch that opens a picker, and the linear components beside it. Colours brighter than 1 are a hue times a
/// strength.
bool color_fields(Ui& ui, const std::string& name, const char* panel, const Parameter& parameter, vec3& value) {
    bool changed = false;
    const float side = ImGui::GetFrameHeight();
    if (ImGui::ColorButton("##swatch", display_color(value),
                           ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoAlpha, {side * 1.3f, side}))
        ImGui::OpenPopup("picker");
    ui.report.item(panel, name + "/swatch");
    tooltip(ui, parameter.tip, hint_text(parameter));
    if (asked_for_default()) value = parameter.initial, changed = true;
    if (ImGui::BeginPopup("picker")) {
        const bool bright = parameter.maximum > 1.0f;
        float strength = bright ? std::max({value.x, value.y, value.z}) : 1.0f;
        const vec3 hue = strength > 0.0f ? value / strength : vec3(1.0f);
        float encoded[3];
        for (int i = 0; i < 3; ++i) encoded[i] = srgb_from_linear(hue[i]);
        ImGui::SetNextItemWidth(ui.theme.px(220.0f));
        bool picked = ImGui::ColorPicker3("##picker", encoded,
                                          ImGuiColorEditFlags_NoSidePreview | ImGuiColorEditFlags_NoLabel |
                                              ImGuiColorEditFlags_DisplayRGB | ImGuiColorEditFlags_DisplayHSV |
                                              ImGuiColorEditFlags_DisplayHex);
        if (picked)
            for (int i = 0; i < 3; ++i) value[i] = linear_from_srgb(encoded[i]);
        if (picked && bright) {
            // The picker's brightness is the strength's business.
            const float most = std::max({value.x, value.y, value.z});
            if (strength <= 0.0f) strength = 1.0f;
            value *= most > 0.0f ? strength / most : 0.0f;
        }
        if (bright) {
            ImGui::SetNextItemWidth(ui.theme.px(150.0f));
            const Parameter limits{.key = "strength", .tip = "", .minimum = 0.0f, .maximum = parameter.maximum};
            if (number_field(ui, "##strength", limits, strength, "", nullptr))
                value = hue * clamped(limits, glm::vec3(strength)).x, picked = true;
            ImGui::SameLine();
            ImGui::TextUnformatted("Strength");
        }
        for (int i = 0; i < 3; ++i) value[i] = picked ? std::round(value[i] * 1e4f) / 1e4f : value[i];
        changed |= picked;
        ImGui::EndPopup();
    }
    ImGui::SameLine(0.0f, ui.theme.px(4.0f));
    return vector_fields(ui, name, panel, parameter, value, true) || changed;
}

bool choice_combo(Ui& ui, const std::string& name, const char* panel, const Parameter& parameter, vec3& value) {
    bool changed = false;
    const auto label = [&](std::size_t i) { return label_of(parameter.choices[i]); };
    ImGui::SetNextItemWidth(-FLT_MIN);
    const bool open = ImGui::BeginCombo("##choice", label(static_cast<std::size_t>(value.x)).c_str());
    ui.report.item(panel, name);
    if (open) {
        for (std::size_t i = 0; i < parameter.choices.size(); ++i) {
            if (ImGui::Selectable(label(i).c_str(), static_cast<std::size_t>(value.x) == i))
                value.x = static_cast<float>(i), changed = true;
            ui.report.item(panel, name + "/" + parameter.choices[i]);
        }
        ImGui::EndCombo();
    } else {
        tooltip(ui, parameter.tip, hint_text(parameter));
        if (asked_for_default()) value = parameter.initial, changed = true;
    }
    return changed;
}

}  // namespace

ImVec4 display_color(vec3 linear) {
    const float most = std::max({linear.x, linear.y, linear.z, 1.0f});
    return {srgb_from_linear(linear.x / most), srgb_from_linear(linear.y / most), srgb_from_linear(linear.z / most),
            1.0f};
}

void row_label(const Ui& ui, std::string_view label, bool bright, std::string_view unit) {
    const float start = ImGui::GetCursorPosX();
    const float column = start + ui.theme.px(112.0f);
    ImGui::AlignTextToFramePadding();
    ImGui::PushStyleColor(ImGuiCol_Text, bright ? ui.theme.text : IM_COL32(176, 183, 193, 255));
    ImGui::TextUnformatted(label.data(), label.data() + label.size());
    ImGui::PopStyleColor();
    if (!unit.empty()) {
        ImGui::SameLine(0.0f, ui.theme.px(5.0f));
        ImGui::TextDisabled("%.*s", static_cast<int>(unit.size()), unit.data());
    }
    ImGui::SameLine(column);
    ImGui::SetNextItemWidth(-FLT_MIN);
}

std::optional<vec3> value_row(Ui& ui, const char* panel, const Parameter& parameter, vec3 value,
                              const SliderRange* range) {
    const std::string name = parameter.key;
    const std::string_view unit = unit_symbol(parameter.unit);
    bool differs = false;
    for (int i = 0; i < parameter.components(); ++i) differs |= value[i] != parameter.initial[i];
    const bool unit_beside = parameter.components() == 3 && parameter.unit != Unit::degrees;
    ImGui::PushID(parameter.key);
    row_label(ui, label_of(name), differs, unit_beside ? unit : "");
    vec3 edited = value;
    bool changed = false;
    switch (parameter.type) {
        case ParameterType::number:
        case ParameterType::integer: {
            std::string full;
            changed = number_field(ui, "##value", parameter, edited.x, unit, range, &full);
            ui.report.item(panel, name);
            tooltip(ui, parameter.tip, hint_text(parameter, full));
            if (asked_for_default()) edited = parameter.initial, changed = true;
            break;
        }
        case ParameterType::vector:
        case ParameterType::count:
            changed = vector_fields(ui, name, panel, parameter, edited, true);
            break;
        case ParameterType::color:
            changed = color_fields(ui, name, panel, parameter, edited);
            break;
        case ParameterType::flag: {
            bool on = edited.x != 0.0f;
            if (ImGui::Checkbox("##value", &on)) edited.x = on ? 1.0f : 0.0f, changed = true;
            ui.report.item(panel, name);
            tooltip(ui, parameter.tip, hint_text(parameter));
            if (asked_for_default()) edited = parameter.initial, changed = true;
            break;
        }
        case ParameterType::flags:
            changed = flag_buttons(ui, name, panel, parameter, edited);
            break;
        case ParameterType::choice:
            changed = choice_combo(ui, name, panel, parameter, edited);
            break;
    }
    ImGui::PopID();
    edited = clamped(parameter, edited);
    if (!changed || edited == value) return std::nullopt;
    return edited;
}

void value_rows(Ui& ui, const char* panel, const Scene& scene, ObjectRef object, Edits& edits, std::size_t first,
                std::size_t count) {
    const std::vector<Parameter> list = parameters(scene, object);
    const Node* node = object.type == ObjectType::node ? find_node(scene, object.id) : nullptr;
    const std::size_t own = node ? info(node->kind).parameters.size() : 0;
    const std::size_t declared = node && node->code ? own + node->code->parameters().size() : own;
    for (std::size_t i = first; i < list.size() && i - first < count; ++i) {
        // What the author of custom code gave a range is a slider.
        const Parameter& p = list[i];
        const bool slider = i >= own && i < declared && p.minimum > -largest_value && p.maximum < largest_value;
        const SliderRange range{p.minimum, p.maximum};
        if (const auto changed = value_row(ui, panel, p, value(scene, object, p.key), slider ? &range : nullptr))
            edits.push_back(SetValue{object, p.key, *changed});
    }
}

}  // namespace farfield
