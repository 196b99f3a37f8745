#include "ui/number_field.h"

#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace farfield {
namespace {

/// Digits after the point that dragging works in.
int decimals(const Parameter& parameter, float value) {
    if (parameter.is_whole()) return 0;
    if (parameter.unit == Unit::degrees || parameter.unit == Unit::degrees_per_metre) return 1;
    if (parameter.unit == Unit::percent) return 1;
    if (parameter.unit == Unit::stops) return 2;
    return value != 0.0f && std::abs(value) < 0.01f ? 5 : 3;
}

float rounded(const Parameter& parameter, double value) {
    const double step = std::pow(10.0, decimals(parameter, static_cast<float>(value)));
    return static_cast<float>(std::round(value * step) / step);
}

/// Change for each pixel that the mouse moves.
double drag_speed(const Parameter& parameter, double value) {
    double speed = 0.01 * std::max(0.5, std::abs(value));
    if (parameter.unit == Unit::degrees || parameter.unit == Unit::degrees_per_metre) speed = 0.5;
    if (parameter.unit == Unit::stops) speed = 0.02;
    if (parameter.maximum - parameter.minimum <= 1.0f) speed = 0.004;
    if (parameter.is_whole()) speed = 0.1;
    if (ImGui::GetIO().KeyShift) speed *= 0.1;
    if (ImGui::GetIO().KeyCtrl) speed *= 10.0;
    return speed;
}

std::string without_zeros(std::string number) {
    if (number.find('.') == std::string::npos) return number;
    number.erase(number.find_last_not_of('0') + 1);
    if (number.back() == '.') number.pop_back();
    return number == "-0" ? "0" : number;
}

/// The number as text of at most `room` pixels, as far as that can be. While it is dragged its length stays the same.
std::string shown_number(const Parameter& parameter, float value, bool dragged, std::string_view unit, float room) {
    const std::string suffix = fmt::format("{}{}", unit.empty() || unit[0] == '\xc2' ? "" : " ", unit);
    if (parameter.is_word(value)) return parameter.word;
    std::string text;
    const auto fits = [&](std::string number) {
        text = (dragged ? number : without_zeros(std::move(number))) + suffix;
        return ImGui::CalcTextSize(text.c_str()).x <= room;
    };
    for (int digits = decimals(parameter, value); digits >= 0; --digits)
        if (std::abs(value) < 1e6f && fits(fmt::format("{:.{}f}", value, digits))) return text;
    for (const int digits : {4, 3, 2})
        if (fits(fmt::format("{:.{}g}", value, digits))) return text;
    return text;
}

/// Where the number is along the slider, 0 to 1, and back.
float position_of(const SliderRange& range, float value) {
    const float v = std::clamp(value, range.low, range.high);
    return range.logarithmic ? std::log(v / range.low) / std::log(range.high / range.low)
                             : (v - range.low) / (range.high - range.low);
}

/// The parameter's word, if it is no whole number, is at the left end.
double value_at(const Parameter& parameter, const SliderRange& range, double position) {
    const double t = std::clamp(position, 0.0, 1.0), low = range.low, high = range.high;
    if (parameter.word && !parameter.is_whole() && t < 0.02) return parameter.lowest();
    return range.logarithmic ? low * std::pow(high / low, t) : low + t * (high - low);
}

/// What somebody types for a number: sums, differences, products and quotients of numbers, with parentheses.
class Arithmetic {
public:
    /// Half the world types a comma, but not for thousands in numbers that have a point too.
    explicit Arithmetic(std::string_view text) : text_(text) {
        if (text.find('.') == std::string_view::npos) std::replace(text_.begin(), text_.end(), ',', '.');
    }

    std::optional<float> result() {
        const auto value = static_cast<float>(sum());
        if (failed_ || at_ != text_.size() || !std::isfinite(value)) return std::nullopt;
        return value;
    }

private:
    /// Takes the next character where it is `wanted`.
    bool take(char wanted) {
        while (at_ < text_.size() && text_[at_] == ' ') ++at_;
        const bool found = at_ < text_.size() && text_[at_] == wanted;
        if (found) ++at_;
        return found;
    }
    double sum() {
        double value = product();
        for (;;) {
            if (take('+'))
                value += product();
            else if (take('-'))
                value -= product();
            else
                return value;
        }
    }
    double product() {
        double value = factor();
        for (;;) {
            if (take('*'))
                value *= factor();
            else if (take('/'))
                value /= factor();
            else
                return value;
        }
    }
    double factor() {
        if (take('-')) return -operand();
        take('+');
        return operand();
    }
    double operand() {
        if (take('(')) {
            const double value = sum();
            failed_ |= !take(')');
            return value;
        }
        double value = 0.0;
        const char *from = text_.data() + at_, *end = text_.data() + text_.size();
        const bool begins = from != end && (*from == '.' || (*from >= '0' && *from <= '9'));  // neither inf nor nan
        const auto [to, error] = std::from_chars(from, end, value);
        failed_ |= !begins || error != std::errc();
        at_ += static_cast<std::size_t>(to - from);
        return value;
    }

    std::string text_;
    std::size_t at_ = 0;
    bool failed_ = false;
};

/// Typing is over: true when it came to another number.
bool finish_typing(NumberEntry& entry, const Parameter& parameter, float& value, std::string_view unit) {
    entry.typed = 0;
    const std::string_view text = entry.text;
    if (text == entry.before) return false;
    const std::optional<float> number =
        parameter.word && text == parameter.word ? parameter.lowest() : typed_number(text, unit);
    if (!number || *number == value) return false;
    value = *number;
    return true;
}

/// The number while the mouse is down on it; true when it moved.
bool follow_mouse(NumberEntry& entry, const ImRect& box, const Parameter& parameter, float& value,
                  const SliderRange* range) {
    if (!ImGui::IsMouseDragPastThreshold(ImGuiMouseButton_Left)) return false;
    const ImGuiIO& io = ImGui::GetIO();
    if (!range) {
        entry.exact += io.MouseDelta.x * drag_speed(parameter, entry.exact);
        entry.exact = std::clamp<double>(entry.exact, parameter.lowest(), parameter.maximum);
    } else {
        if (io.KeyShift)
            entry.along += 0.1f * io.MouseDelta.x / box.GetWidth();
        else
            entry.along = (io.MousePos.x - box.Min.x) / box.GetWidth();
        entry.exact = value_at(parameter, *range, entry.along);
    }
    const float moved = rounded(parameter, entry.exact);
    if (moved == value) return false;
    value = moved;
    return true;
}

/// A slider goes to where it is clicked, but only once that cannot become a double-click any more.
bool follow_click(NumberEntry& entry, ImGuiID id, const Parameter& parameter, float& value, const SliderRange* range) {
    const double late = ImGui::GetTime() - entry.click_due;
    if (!range || entry.clicked != id || late < 0.0) return false;
    entry.clicked = 0;
    const float moved = rounded(parameter, value_at(parameter, *range, entry.along));
    if (late > 1.0 || moved == value) return false;
    value = moved;
    return true;
}

}  // namespace

std::optional<float> typed_number(std::string_view text, std::string_view unit) {
    const auto trim = [&] {
        while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
        while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
    };
    trim();
    if (!unit.empty() && text.ends_with(unit)) text.remove_suffix(unit.size());
    trim();
    return Arithmetic(text).result();
}

bool number_field(Ui& ui, const char* label, const Parameter& parameter, float& value, std::string_view unit,
                  const SliderRange* range, std::string* full) {
    ImGuiWindow* window = ImGui::GetCurrentWindow();
    if (window->SkipItems) return false;
    const ImGuiStyle& style = ImGui::GetStyle();
    const ImGuiIO& io = ImGui::GetIO();
    const ImGuiID id = window->GetID(label);
    const ImVec2 low = window->DC.CursorPos;
    const ImRect box(low, {low.x + ImGui::CalcItemWidth(), low.y + ImGui::GetFrameHeight()});
    ImGui::ItemSize(box, style.FramePadding.y);
    if (!ImGui::ItemAdd(box, id, nullptr, ImGuiItemFlags_Inputable)) return false;
    ImGui::KeepAliveID(id);
    NumberEntry& entry = ui.number;
    const bool hovered = ImGui::ItemHoverable(box, id);

    const bool pressed = hovered && io.MouseClicked[ImGuiMouseButton_Left];
    const bool tabbed = ImGui::GetCurrentContext()->NavActivateInputId == id;
    const bool begins = tabbed || (pressed && (io.KeyCtrl || io.MouseDoubleClicked[ImGuiMouseButton_Left]));
    if (begins) {
        entry.typed = id;
        entry.clicked = 0;
        entry.before = parameter.is_word(value) ? parameter.word : fmt::format("{}", value);
        const std::size_t length = entry.before.copy(entry.text, sizeof entry.text - 1);
        entry.text[length] = 0;
    }
    if (entry.typed == id && (begins || ImGui::TempInputIsActive(id))) {
        ImGui::TempInputText(box, id, label, entry.text, static_cast<int>(sizeof entry.text),
                             ImGuiInputTextFlags_AutoSelectAll);
        if (ImGui::TempInputIsActive(id)) return false;
    }
    // Enter, Tab, Escape, or a click elsewhere, which something else may have seen first.
    if (entry.typed == id) return finish_typing(entry, parameter, value, unit);

    if (pressed) {
        ImGui::SetActiveID(id, window);
        ImGui::SetFocusID(id, window);
        ImGui::FocusWindow(window);
        entry.exact = value;
        entry.along = (io.MousePos.x - box.Min.x) / box.GetWidth();
    }
    bool changed = follow_click(entry, id, parameter, value, range);
    const bool active = ImGui::GetActiveID() == id;
    if (active && io.MouseDown[ImGuiMouseButton_Left]) {
        changed |= follow_mouse(entry, box, parameter, value, range);
    } else if (active) {
        ImGui::ClearActiveID();
        if (!ImGui::IsMouseDragPastThreshold(ImGuiMouseButton_Left)) {
            entry.clicked = id;
            entry.click_due = ImGui::GetTime() + io.MouseDoubleClickTime;
        }
    }
    // A click may count only once the mouse is down on something else.
    if (const ImGuiID holder = ImGui::GetActiveID(); changed && (holder == id || holder == 0))
        ImGui::MarkItemEdited(id);

    ImGui::RenderFrame(box.Min, box.Max,
                       ImGui::GetColorU32(active    ? ImGuiCol_FrameBgActive
                                          : hovered ? ImGuiCol_FrameBgHovered
                                                    : ImGuiCol_FrameBg),
                       true, style.FrameRounding);
    const std::string text =
        shown_number(parameter, value, active && !range, unit, box.GetWidth() - ui.theme.px(range ? 4.0f : 9.0f));
    if (range) {
        // A level, not a knob: the number stays readable on it. Its edge has a gap where the number is.
        const float x = box.Min.x + position_of(*range, value) * box.GetWidth(), edge = ui.theme.px(2.0f);
        window->DrawList->PushClipRect(box.Min, box.Max, true);
        if (x > box.Min.x + style.FrameRounding)
            window->DrawList->AddRectFilled(box.Min, {x, box.Max.y}, ImGui::GetColorU32(ImGuiCol_SliderGrab, 0.3f),
                                            style.FrameRounding, ImDrawFlags_RoundCornersLeft);
        const float from = std::clamp(x - edge * 0.5f, box.Min.x, box.Max.x - edge);
        const ImU32 color = ImGui::GetColorU32(active || hovered ? ImGuiCol_SliderGrabActive : ImGuiCol_SliderGrab);
        const float number = 0.5f * ImGui::CalcTextSize(text.c_str()).x + edge;
        const bool behind = std::abs(x - 0.5f * (box.Min.x + box.Max.x)) < number;
        const float length = behind ? std::floor(0.2f * box.GetHeight()) : box.GetHeight();
        window->DrawList->AddRectFilled({from, box.Min.y}, {from + edge, box.Min.y + length}, color);
        if (behind) window->DrawList->AddRectFilled({from, box.Max.y - length}, {from + edge, box.Max.y}, color);
        window->DrawList->PopClipRect();
    }
    ImGui::RenderTextClipped({box.Min.x + ui.theme.px(range ? 0.0f : 3.0f), box.Min.y}, box.Max, text.c_str(), nullptr,
                             nullptr, {0.5f, 0.5f}, &box);
    if (full && !parameter.is_word(value) && typed_number(text, unit) != value) *full = fmt::format("{}", value);
    return changed;
}

}  // namespace farfield
