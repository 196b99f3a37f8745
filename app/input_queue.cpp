#include "app/input_queue.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>

#include <algorithm>
#include <cctype>
#include <utility>

namespace farfield {
namespace {

/// The character on the key where it is a letter: Ctrl+Z is where Z is printed. Digits stay digits in every layout.
int layout_key(int key, int scancode) {
    if (key < GLFW_KEY_A || key > GLFW_KEY_Z) return key;
    const char* name = glfwGetKeyName(key, scancode);
    const bool letter = name && name[0] != '\0' && name[1] == '\0' && std::isalpha(static_cast<unsigned char>(name[0]));
    return letter ? std::toupper(static_cast<unsigned char>(name[0])) : key;
}

}  // namespace

static_assert(escape_key == GLFW_KEY_ESCAPE);

void InputQueue::move(ImVec2 to) {
    // Of several moves in a row only the last counts.
    if (!events_.empty() && events_.back().kind == Kind::move)
        events_.back().position = to;
    else
        events_.push_back({Kind::move, 0, 0, 0, 0, to});
}

void InputQueue::button(int button, int action) {
    if (button < 0 || button >= buttons) return;
    events_.push_back({Kind::button, button, 0, action, 0, {}, glfwGetTime()});
}

std::vector<KeyPress> InputQueue::deliver(GLFWwindow* window, bool hold_keys) {
    std::vector<KeyPress> pressed;
    std::vector<int> keys;
    unsigned changed = 0;
    bool moved = false;
    for (; !events_.empty(); events_.pop_front()) {
        const Event& e = events_.front();
        // What follows a click belongs to the next frame, and so does the release of any key after a press: that of
        // Ctrl would turn Ctrl+A into A.
        if (changed != 0 && e.kind != Kind::button) break;
        if (hold_keys && (e.kind == Kind::key || e.kind == Kind::character)) break;
        if (e.kind == Kind::key) {
            if (e.action == GLFW_RELEASE ? !pressed.empty() : std::find(keys.begin(), keys.end(), e.code) != keys.end())
                break;
            keys.push_back(e.code);
            if (e.action != GLFW_RELEASE)
                pressed.push_back({layout_key(e.code, e.scancode), (e.modifiers & GLFW_MOD_CONTROL) != 0,
                                   (e.modifiers & GLFW_MOD_SHIFT) != 0, (e.modifiers & GLFW_MOD_ALT) != 0});
            ImGui_ImplGlfw_KeyCallback(window, e.code, e.scancode, e.action, e.modifiers);
        } else if (e.kind == Kind::character) {
            ImGui_ImplGlfw_CharCallback(window, static_cast<unsigned>(e.code));
        } else if (e.kind == Kind::button) {
            // A drag begins where the mouse stood and ends where it went: the way there has a frame of its own.
            if (moved || (changed & (1u << e.code))) break;
            changed |= 1u << e.code;
            down_[e.code] = e.action == GLFW_PRESS;
            if (!down_[e.code]) continue;
            // Two presses are a double-click when they came close together, however long the frames between them took.
            ImGuiIO& io = ImGui::GetIO();
            const bool close = e.time - std::exchange(pressed_[e.code], e.time) < io.MouseDoubleClickTime;
            io.MouseClickedTime[e.code] = close ? ImGui::GetTime() + 1.0 : -1e9;
        } else if (e.kind == Kind::move) {
            mouse_ = e.position;
            moved = true;
        } else {
            ImGui_ImplGlfw_ScrollCallback(window, e.position.x, e.position.y);
        }
    }
    ImGuiIO& io = ImGui::GetIO();
    io.MousePos = mouse_;
    std::copy(std::begin(down_), std::end(down_), io.MouseDown);
    return pressed;
}

}  // namespace farfield
