// Keeps the order of input. Dear ImGui before 1.87 samples mouse and keys once a frame: a tap or a click that is
// shorter than a frame is lost or happens where the mouse is by then. Frames take long where the processor draws them,
// so events wait here and each frame gets as many as it can tell apart.
#pragma once

#include <imgui.h>

#include <deque>
#include <vector>

struct GLFWwindow;

namespace farfield {

/// A key that went down. Letters and digits are named by their capital character in the user's keyboard layout; other
/// keys by GLFW's constants, all of which are above 255.
struct KeyPress {
    int key;
    bool ctrl, shift, alt;
};
inline constexpr int escape_key = 256;

class InputQueue {
public:
    void key(int key, int scancode, int action, int modifiers) {
        events_.push_back({Kind::key, key, scancode, action, modifiers, {}});
    }
    void character(unsigned code) { events_.push_back({Kind::character, static_cast<int>(code), 0, 0, 0, {}}); }
    void button(int button, int action);
    void move(ImVec2 to);
    void scroll(ImVec2 by) { events_.push_back({Kind::scroll, 0, 0, 0, 0, by}); }

    bool empty() const { return events_.empty(); }
    /// Hands the next events to ImGui; to be called between the backends' NewFrame and ImGui's. Returns the keys that
    /// went down. With `hold_keys` keys wait, and what comes after them.
    std::vector<KeyPress> deliver(GLFWwindow* window, bool hold_keys);

private:
    enum class Kind { key, character, button, move, scroll };
    struct Event {
        Kind kind;
        int code, scancode, action, modifiers;
        ImVec2 position;
        double time = 0.0;  ///< of a button: when it arrived, seconds
    };
    static constexpr int buttons = 5;  ///< that ImGui knows

    std::deque<Event> events_;
    ImVec2 mouse_{-1e6f, -1e6f};
    bool down_[buttons] = {};
    double pressed_[buttons] = {};  ///< when each went down last
};

}  // namespace farfield
