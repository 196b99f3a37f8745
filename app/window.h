// The window: GLFW, OpenGL and Dear ImGui behind one object. Lives on the main thread.
#pragma once

#include "app/input_queue.h"
#include "renderer/context.h"

#include <glm/vec2.hpp>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

struct GLFWwindow;

namespace farfield {

class Window {
public:
    /// Where and how large; what does not lie on a screen is put there.
    struct Frame {
        /// When it is not maximised, screen coordinates; none: what suits the display.
        std::optional<glm::ivec2> size;
        std::optional<glm::ivec2> place;
        bool maximised = false;
    };
    /// Throws ContextError when there is no display or no OpenGL 4.3.
    Window(const Frame& frame, const std::string& title);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// A context for another thread that shares objects with this one. It must be gone before the window.
    std::unique_ptr<Context> make_shared_context();

    /// Waits for input, `seconds` at most. True when something arrived since the last call.
    bool wait(double seconds);
    /// `hold_keys`: a field is about to get the keyboard; what is typed meanwhile is for that.
    void begin_frame(bool hold_keys);
    void end_frame();

    void set_title(const std::string& title);
    glm::ivec2 size() const;            ///< in screen coordinates, as the mouse has
    glm::vec2 pixels_per_unit() const;  ///< framebuffer pixels for each screen coordinate
    Frame frame() const;
    float density() const;  ///< of the display: 1 at 96 dpi
    bool take_close();      ///< whether it was asked to close since the last call

    bool is_down(int key) const;                                 ///< one of GLFW's keys, by its place on the keyboard
    const std::vector<KeyPress>& keys() const { return keys_; }  ///< that went down before this frame
    std::vector<std::filesystem::path> take_dropped_files();

private:
    struct Input {
        bool arrived = true;
        InputQueue queue;
        std::vector<std::filesystem::path> dropped;
    };
    /// Gives it a size, and the least that panels have room in.
    void set_size(std::optional<glm::ivec2> wanted);
    static Input& input_of(GLFWwindow* window);
    void install_callbacks();

    GLFWwindow* window_ = nullptr;
    Input input_;
    std::vector<KeyPress> keys_;
    std::string title_;
    mutable Frame frame_;  ///< the last one when it was not maximised
};

}  // namespace farfield
