// A random hand on mouse and keyboard, for an editor without a window: Dear ImGui without a backend.
#pragma once

#include "app/input_queue.h"
#include "ui/report.h"

#include <imgui.h>

#include <random>
#include <utility>
#include <vector>

namespace farfield {

/// Dear ImGui without a window or a device. Keys have GLFW's numbers, as in the window.
class Headless {
public:
    Headless();
    ~Headless() { ImGui::DestroyContext(); }
    Headless(const Headless&) = delete;
    Headless& operator=(const Headless&) = delete;
    /// After the fonts are chosen.
    static void build_fonts();
};

/// What happens between two frames. Of keys that change something one goes down in a frame, as the window has it.
class Hand {
public:
    explicit Hand(unsigned seed);

    unsigned number() { return static_cast<unsigned>(random_()); }
    bool chance(unsigned one_in) { return random_() % one_in == 0; }
    std::mt19937& random() { return random_; }

    /// Some random events in a window of `size`; `hold_keys` as of InputQueue. `controls`: what there is to aim at.
    void act(ImVec2 size, const Report& report, bool hold_keys);
    void press(KeyPress key);
    void click(const Report::Rectangle& control);
    /// Lets go of everything; the mouse leaves.
    void let_go();
    /// What went down since the last call.
    std::vector<KeyPress> take_keys() { return std::exchange(pressed_, {}); }
    long events() const { return events_; }

private:
    void move(ImVec2 size, const Report& report);
    void type();

    std::mt19937 random_;
    std::vector<KeyPress> commands_;  ///< every key that is a command's
    std::vector<KeyPress> pressed_;
    int down_ = 0;  ///< the key that is held
    int drag_ = 0;  ///< frames until the left button goes up
    long events_ = 0;
};

}  // namespace farfield
