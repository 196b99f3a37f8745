// OpenGL 4.3 core (or later) without caring where it comes from: EGL, OSMesa or a window.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

namespace farfield {

struct ContextError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

class Context {
public:
    virtual ~Context() = default;
    virtual void make_current() = 0;       ///< on the calling thread; loads the OpenGL functions the first time
    virtual void release() = 0;            ///< no context is current on the calling thread afterwards
    virtual std::string name() const = 0;  ///< as "EGL device", "EGL surfaceless", "OSMesa", "GLFW window"
};

enum class ContextKind { automatic, egl, osmesa };

/// A headless context, not yet current. automatic: EGL on a GPU, else EGL surfaceless, else OSMesa.
/// Throws ContextError that says what was tried and why each failed.
std::unique_ptr<Context> make_headless_context(ContextKind kind);
std::unique_ptr<Context> make_egl_context();
std::unique_ptr<Context> make_osmesa_context();

/// Whether the current context is one of Mesa's that render on the CPU.
bool renders_on_cpu();
/// Of the current context.
bool has_extension(std::string_view name);

/// Loads OpenGL through `get_address` and checks the version; for the makers of contexts. Throws ContextError.
void load_gl(void (*(*get_address)(const char*))());

}  // namespace farfield
