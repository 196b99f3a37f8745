#include "app/window.h"

#include <glad/gl.h>

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <cctype>
#include <utility>

namespace farfield {
namespace {

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

/// The character on the key where it is a letter: Ctrl+Z is where Z is printed. Digits stay digits in every layout.
int layout_key(int key, int scancode) {
    if (key < GLFW_KEY_A || key > GLFW_KEY_Z) return key;
    const char* name = glfwGetKeyName(key, scancode);
    const bool letter = name && name[0] != '\0' && name[1] == '\0' && std::isalpha(static_cast<unsigned char>(name[0]));
    return letter ? std::toupper(static_cast<unsigned char>(name[0])) : key;
}

}  // namespace

Window::Window(glm::ivec2 size, const std::string& title) : title_(title) {
    if (!glfwInit()) throw ContextError("no window can be opened: " + last_error());
    set_hints(true);
    window_ = glfwCreateWindow(size.x, size.y, title.c_str(), nullptr, nullptr);
    if (!window_) {
        const std::string error = last_error();
        glfwTerminate();
        throw ContextError("no window with OpenGL 4.3 can be opened: " + error);
    }
    glfwSetWindowSizeLimits(window_, 800, 500, GLFW_DONT_CARE, GLFW_DONT_CARE);
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
    // ImGui's callbacks call those that are there already.
    ImGui_ImplGlfw_InitForOpenGL(window_, true);
    ImGui_ImplOpenGL3_Init("#version 430");
}

Window::~Window() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwDestroyWindow(window_);
    glfwTerminate();
}

Window::Input& Window::input_of(GLFWwindow* window) {
    Input& input = *static_cast<Input*>(glfwGetWindowUserPointer(window));
    input.arrived = true;
    return input;
}

void Window::install_callbacks() {
    glfwSetWindowUserPointer(window_, &input_);
    glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double, double) { input_of(w); });
    glfwSetCursorEnterCallback(window_, [](GLFWwindow* w, int) { input_of(w); });
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int, int, int) { input_of(w); });
    glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double) { input_of(w); });
    glfwSetCharCallback(window_, [](GLFWwindow* w, unsigned) { input_of(w); });
    glfwSetWindowFocusCallback(window_, [](GLFWwindow* w, int) { input_of(w); });
    glfwSetWindowRefreshCallback(window_, [](GLFWwindow* w) { input_of(w); });
    glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* w, int, int) { input_of(w); });
    glfwSetWindowCloseCallback(window_, [](GLFWwindow* w) { input_of(w); });
    glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int scancode, int action, int mods) {
        Input& input = input_of(w);
        if (action != GLFW_RELEASE)
            input.keys.push_back({layout_key(key, scancode), (mods & GLFW_MOD_CONTROL) != 0, (mods & GLFW_MOD_SHIFT) != 0,
                                  (mods & GLFW_MOD_ALT) != 0});
    });
    glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** paths) {
        input_of(w).dropped.assign(paths, paths + count);
    });
}

std::unique_ptr<Context> Window::make_shared_context() { return std::make_unique<SharedContext>(window_); }

bool Window::wait(double seconds) {
    glfwWaitEventsTimeout(seconds);
    return std::exchange(input_.arrived, false);
}

void Window::begin_frame() {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void Window::end_frame() {
    ImGui::Render();
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    glViewport(0, 0, width, height);
    glClearColor(0.08f, 0.085f, 0.1f, 1.0f);
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

float Window::density() const {
    float x = 1.0f, y = 1.0f;
    glfwGetWindowContentScale(window_, &x, &y);
    return x > 0.0f ? x : 1.0f;
}

bool Window::should_close() const { return glfwWindowShouldClose(window_); }
void Window::keep_open() { glfwSetWindowShouldClose(window_, GLFW_FALSE); }

std::vector<KeyPress> Window::take_keys() { return std::exchange(input_.keys, {}); }
std::vector<std::filesystem::path> Window::take_dropped_files() { return std::exchange(input_.dropped, {}); }

}  // namespace farfield
