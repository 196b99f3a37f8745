#include "app/window.h"

#include "ui/ui.h"

#include <glad/gl.h>

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <glm/common.hpp>
#include <imgui.h>

#include <algorithm>
#include <utility>

namespace farfield {
namespace {

// At 96 dpi.
constexpr glm::ivec2 usual_size{1440, 900}, least_size{800, 500};

std::string last_error() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text ? text : "unknown error";
}

void set_hints(bool visible) {
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    glfwWindowHint(GLFW_VISIBLE, visible ? GLFW_TRUE : GLFW_FALSE);
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
}

/// No larger than the main screen has room for.
glm::ivec2 fitted(glm::ivec2 size) {
    GLFWmonitor* monitor = glfwGetPrimaryMonitor();
    if (!monitor) return size;
    glm::ivec2 corner{0}, room{0};
    glfwGetMonitorWorkarea(monitor, &corner.x, &corner.y, &room.x, &room.y);
    return room.x > 0 && room.y > 0 ? glm::min(size, room) : size;
}

/// Whether a good part of the title bar of such a window would be on a screen, so that it can be moved.
bool on_screen(glm::ivec2 place, glm::ivec2 size) {
    int count = 0;
    GLFWmonitor** monitors = glfwGetMonitors(&count);
    for (int i = 0; i < count; ++i) {
        glm::ivec2 corner{0}, room{0};
        glfwGetMonitorWorkarea(monitors[i], &corner.x, &corner.y, &room.x, &room.y);
        const int width = std::min(place.x + size.x, corner.x + room.x) - std::max(place.x, corner.x);
        if (width >= 200 && place.y >= corner.y && place.y <= corner.y + room.y - 50) return true;
    }
    return false;
}

/// An invisible window, for its context alone.
class SharedContext final : public Context {
public:
    explicit SharedContext(GLFWwindow* main) {
        set_hints(false);
        window_ = glfwCreateWindow(16, 16, "", nullptr, main);
        if (!window_) throw ContextError("no second OpenGL context can be made: " + last_error());
    }
    ~SharedContext() override { glfwDestroyWindow(window_); }
    // The functions were loaded with the main window's context; contexts that share have the same.
    void make_current() override { glfwMakeContextCurrent(window_); }
    void release() override { glfwMakeContextCurrent(nullptr); }
    std::string name() const override { return "GLFW window"; }

private:
    GLFWwindow* window_;
};

}  // namespace

Window::Window(const Frame& frame, const std::string& title) : title_(title) {
    if (!glfwInit()) throw ContextError("no window can be opened: " + last_error());
    const glm::ivec2 size = fitted(frame.size.value_or(usual_size));
    set_hints(true);
    glfwWindowHint(GLFW_MAXIMIZED, frame.maximised ? GLFW_TRUE : GLFW_FALSE);
    window_ = glfwCreateWindow(size.x, size.y, title.c_str(), nullptr, nullptr);
    if (!window_) {
        const std::string error = last_error();
        glfwTerminate();
        throw ContextError("no window with OpenGL 4.3 can be opened: " + error);
    }
    set_size(frame.size);
    if (frame.place && !frame.maximised && on_screen(*frame.place, *frame_.size))
        glfwSetWindowPos(window_, frame.place->x, frame.place->y);
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    try {
        load_gl(glfwGetProcAddress);
    } catch (...) {
        glfwDestroyWindow(window_);
        glfwTerminate();
        throw;
    }
    install_callbacks();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    ImGui::GetIO().ConfigWindowsMoveFromTitleBarOnly = true;
    ImGui_ImplGlfw_InitForOpenGL(window_, false);  // the queue hands on what arrives
    ImGui_ImplOpenGL3_Init("#version 430");
}

Window::~Window() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwDestroyWindow(window_);
    glfwTerminate();
}

void Window::set_size(std::optional<glm::ivec2> wanted) {
    const float scale = std::max(density() / pixels_per_unit().x, 1.0f);
    const glm::ivec2 least = fitted(glm::ivec2(glm::vec2(least_size) * scale));
    glfwSetWindowSizeLimits(window_, least.x, least.y, GLFW_DONT_CARE, GLFW_DONT_CARE);
    const glm::ivec2 size = glm::max(fitted(wanted.value_or(glm::ivec2(glm::vec2(usual_size) * scale))), least);
    if (size != this->size() && !glfwGetWindowAttrib(window_, GLFW_MAXIMIZED))
        glfwSetWindowSize(window_, size.x, size.y);
    frame_.size = size;
}

Window::Input& Window::input_of(GLFWwindow* window) {
    Input& input = *static_cast<Input*>(glfwGetWindowUserPointer(window));
    input.arrived = true;
    return input;
}

void Window::install_callbacks() {
    glfwSetWindowUserPointer(window_, &input_);
    // ImGui learns of the focus and of the mouse leaving by what these leave in the queue.
    glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) {
        input_of(w).queue.move({static_cast<float>(x), static_cast<float>(y)});
    });
    glfwSetCursorEnterCallback(window_, [](GLFWwindow* w, int entered) {
        if (!entered) input_of(w).queue.move({-1e6f, -1e6f});
    });
    glfwSetMouseButtonCallback(
        window_, [](GLFWwindow* w, int button, int action, int) { input_of(w).queue.button(button, action); });
    glfwSetScrollCallback(window_, [](GLFWwindow* w, double x, double y) {
        input_of(w).queue.scroll({static_cast<float>(x), static_cast<float>(y)});
    });
    glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int scancode, int action, int modifiers) {
        if (key >= 0) input_of(w).queue.key(key, scancode, action, modifiers);
    });
    glfwSetCharCallback(window_, [](GLFWwindow* w, unsigned code) { input_of(w).queue.character(code); });
    glfwSetWindowFocusCallback(window_, [](GLFWwindow* w, int) { input_of(w); });
    glfwSetWindowRefreshCallback(window_, [](GLFWwindow* w) { input_of(w); });
    glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* w, int, int) { input_of(w); });
    glfwSetWindowCloseCallback(window_, [](GLFWwindow* w) { input_of(w); });
    glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** paths) {
        input_of(w).dropped.assign(paths, paths + count);
    });
}

std::unique_ptr<Context> Window::make_shared_context() { return std::make_unique<SharedContext>(window_); }

bool Window::wait(double seconds) {
    if (input_.queue.empty())
        glfwWaitEventsTimeout(seconds);
    else
        glfwPollEvents();
    return std::exchange(input_.arrived, false) || !input_.queue.empty();
}

void Window::begin_frame(bool hold_keys) {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    keys_ = input_.queue.deliver(window_, hold_keys);
    ImGui::NewFrame();
    forget_text_undo();
}

void Window::end_frame() {
    ImGui::Render();
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    glViewport(0, 0, width, height);
    const ImVec4 background = ImGui::GetStyle().Colors[ImGuiCol_WindowBg];
    glClearColor(background.x, background.y, background.z, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    glfwSwapBuffers(window_);
}

void Window::set_title(const std::string& title) {
    if (title == title_) return;
    title_ = title;
    glfwSetWindowTitle(window_, title.c_str());
}

glm::ivec2 Window::size() const {
    glm::ivec2 size;
    glfwGetWindowSize(window_, &size.x, &size.y);
    return size;
}

glm::vec2 Window::pixels_per_unit() const {
    glm::ivec2 pixels;
    glfwGetFramebufferSize(window_, &pixels.x, &pixels.y);
    const glm::ivec2 units = size();
    return units.x > 0 && units.y > 0 ? glm::vec2(pixels) / glm::vec2(units) : glm::vec2(1.0f);
}

Window::Frame Window::frame() const {
    frame_.maximised = glfwGetWindowAttrib(window_, GLFW_MAXIMIZED) == GLFW_TRUE;
    if (!frame_.maximised && !glfwGetWindowAttrib(window_, GLFW_ICONIFIED)) {
        frame_.size = size();
        glm::ivec2 place{0};
        glfwGetWindowPos(window_, &place.x, &place.y);
        frame_.place = place;
    }
    return frame_;
}

float Window::density() const {
    float x = 1.0f, y = 1.0f;
    glfwGetWindowContentScale(window_, &x, &y);
    return x > 0.0f ? x : 1.0f;
}

bool Window::is_down(int key) const { return glfwGetKey(window_, key) == GLFW_PRESS; }

bool Window::take_close() {
    const bool asked = glfwWindowShouldClose(window_);
    glfwSetWindowShouldClose(window_, GLFW_FALSE);
    return asked;
}

std::vector<std::filesystem::path> Window::take_dropped_files() { return std::exchange(input_.dropped, {}); }

}  // namespace farfield
