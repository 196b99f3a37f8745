#include "tests/editor_hand.h"

#include "app/editor_commands.h"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

namespace farfield {
namespace {

constexpr std::pair<ImGuiKey, int> imgui_keys[] = {{ImGuiKey_Tab, GLFW_KEY_TAB},
                                                   {ImGuiKey_LeftArrow, GLFW_KEY_LEFT},
                                                   {ImGuiKey_RightArrow, GLFW_KEY_RIGHT},
                                                   {ImGuiKey_UpArrow, GLFW_KEY_UP},
                                                   {ImGuiKey_DownArrow, GLFW_KEY_DOWN},
                                                   {ImGuiKey_PageUp, GLFW_KEY_PAGE_UP},
                                                   {ImGuiKey_PageDown, GLFW_KEY_PAGE_DOWN},
                                                   {ImGuiKey_Home, GLFW_KEY_HOME},
                                                   {ImGuiKey_End, GLFW_KEY_END},
                                                   {ImGuiKey_Insert, GLFW_KEY_INSERT},
                                                   {ImGuiKey_Delete, GLFW_KEY_DELETE},
                                                   {ImGuiKey_Backspace, GLFW_KEY_BACKSPACE},
                                                   {ImGuiKey_Space, GLFW_KEY_SPACE},
                                                   {ImGuiKey_Enter, GLFW_KEY_ENTER},
                                                   {ImGuiKey_Escape, GLFW_KEY_ESCAPE},
                                                   {ImGuiKey_KeyPadEnter, GLFW_KEY_KP_ENTER},
                                                   {ImGuiKey_A, GLFW_KEY_A},
                                                   {ImGuiKey_C, GLFW_KEY_C},
                                                   {ImGuiKey_V, GLFW_KEY_V},
                                                   {ImGuiKey_X, GLFW_KEY_X},
                                                   {ImGuiKey_Y, GLFW_KEY_Y},
                                                   {ImGuiKey_Z, GLFW_KEY_Z}};

/// Neither a slash nor a tilde: what is typed into a file dialog stays in its folder.
constexpr std::string_view letters = "0123456789.-+*e() abcdefghij\"{};\n\t";

/// The last part of a control's name aside: the tree's nodes are as likely to be met as the menu's entries.
std::string_view group_of(std::string_view control) { return control.substr(0, control.find('/')); }

}  // namespace

Headless::Headless() {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.ConfigWindowsMoveFromTitleBarOnly = true;
    for (const auto& [key, code] : imgui_keys) io.KeyMap[key] = code;
}

void Headless::build_fonts() {
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
}

Hand::Hand(unsigned seed) : random_(seed) {
    for (int key = ' '; key <= GLFW_KEY_LAST; ++key)
        for (int modifiers = 0; modifiers < 8; ++modifiers) {
            const KeyPress press{key, (modifiers & 1) != 0, (modifiers & 2) != 0, (modifiers & 4) != 0};
            if (command_for(press) || view_for(press) || bookmark_for(press)) commands_.push_back(press);
        }
}

void Hand::press(KeyPress key) {
    ImGuiIO& io = ImGui::GetIO();
    io.KeysDown[down_ = key.key] = true;
    io.KeyCtrl = key.ctrl;
    io.KeyShift = key.shift;
    io.KeyAlt = key.alt;
    pressed_.push_back(key);
    ++events_;
}

void Hand::click(const Report::Rectangle& control) {
    ImGuiIO& io = ImGui::GetIO();
    io.MousePos = {static_cast<float>(control.x) + 0.5f * static_cast<float>(control.width),
                   static_cast<float>(control.y) + 0.5f * static_cast<float>(control.height)};
    io.MouseDown[0] = true;
    ++events_;
}

void Hand::let_go() {
    ImGuiIO& io = ImGui::GetIO();
    // A click ends where it began.
    if (!io.MouseDown[0]) io.MousePos = {-1e6f, -1e6f};
    for (bool& down : io.MouseDown) down = false;
    for (bool& down : io.KeysDown) down = false;
    io.KeyCtrl = io.KeyShift = io.KeyAlt = false;
    io.MouseWheel = 0.0f;
    down_ = 0;
    pressed_.clear();
}

void Hand::move(ImVec2 size, const Report& report) {
    ImGuiIO& io = ImGui::GetIO();
    const auto part = [&] { return static_cast<float>(number() % 1000) / 999.0f; };
    const auto& controls = report.controls();
    if (chance(8) || controls.empty()) {
        io.MousePos = {size.x * (1.2f * part() - 0.1f), size.y * (1.2f * part() - 0.1f)};
    } else if (io.MouseDown[0] ? !chance(5) : chance(8)) {
        io.MousePos = {io.MousePos.x + 60.0f * part() - 30.0f, io.MousePos.y + 60.0f * part() - 30.0f};
    } else {
        std::vector<std::string_view> groups;
        for (const auto& [name, place] : controls)
            if (groups.empty() || groups.back() != group_of(name)) groups.push_back(group_of(name));
        std::string_view group = groups[number() % groups.size()];
        // A question is answered sooner or later.
        for (const std::string_view question : {"dialog", "unsaved", "changed", "foreign", "recover", "message"})
            if (!chance(4) && std::find(groups.begin(), groups.end(), question) != groups.end()) group = question;
        std::vector<Report::Rectangle> places;
        for (const auto& [name, place] : controls)
            if (group_of(name) == group) places.push_back(place);
        const Report::Rectangle& aim = places[number() % places.size()];
        io.MousePos = {static_cast<float>(aim.x) + part() * static_cast<float>(aim.width),
                       static_cast<float>(aim.y) + part() * static_cast<float>(aim.height)};
    }
    ++events_;
}

void Hand::type() {
    static constexpr int keys[] = {GLFW_KEY_ENTER,
                                   GLFW_KEY_ENTER,
                                   GLFW_KEY_ESCAPE,
                                   GLFW_KEY_TAB,
                                   GLFW_KEY_BACKSPACE,
                                   GLFW_KEY_DELETE,
                                   GLFW_KEY_LEFT,
                                   GLFW_KEY_RIGHT,
                                   GLFW_KEY_UP,
                                   GLFW_KEY_DOWN,
                                   GLFW_KEY_HOME,
                                   GLFW_KEY_END,
                                   GLFW_KEY_PAGE_DOWN,
                                   GLFW_KEY_PAGE_UP,
                                   'A',
                                   'C',
                                   'V',
                                   'X',
                                   'Z',
                                   'Y'};
    if (chance(2))
        press(commands_[number() % commands_.size()]);
    else
        press({keys[number() % std::size(keys)], chance(3), chance(4), false});
}

void Hand::act(ImVec2 size, const Report& report, bool hold_keys) {
    ImGuiIO& io = ImGui::GetIO();
    if (down_ != 0) {
        io.KeysDown[std::exchange(down_, 0)] = false;
        if (!chance(6)) io.KeyCtrl = io.KeyShift = io.KeyAlt = false;
    }
    io.MouseWheel = 0.0f;
    // Clicks, and things that are dragged for a while.
    if (!io.MouseDown[0] || drag_ > 0 || chance(8)) move(size, report);
    if (io.MouseDown[0] ? --drag_ < 0 : chance(2)) {
        io.MouseDown[0] = !io.MouseDown[0];
        drag_ = io.MouseDown[0] && chance(2) ? static_cast<int>(number() % 8) : 0;
        ++events_;
    }
    for (const int button : {1, 2})
        if (chance(io.MouseDown[button] ? 3 : 14)) io.MouseDown[button] = !io.MouseDown[button], ++events_;
    if (chance(10)) io.MouseWheel = chance(2) ? 1.0f : -3.0f, ++events_;
    if (hold_keys) return;
    if (chance(3)) type();
    for (int i = 0; i < 3; ++i)
        if (chance(5)) io.AddInputCharacter(static_cast<unsigned>(letters[number() % letters.size()])), ++events_;
}

}  // namespace farfield
