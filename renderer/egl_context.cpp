// Headless OpenGL through EGL: the first device that is not a software rasteriser, else Mesa's surfaceless platform.
#include "renderer/context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

#include <string_view>
#include <vector>

namespace farfield {
namespace {

bool has_extension(const char* list, std::string_view name) {
    return list && (" " + std::string(list) + " ").find(" " + std::string(name) + " ") != std::string::npos;
}

struct Display {
    EGLDisplay display = EGL_NO_DISPLAY;
    std::string name;
};

std::vector<Display> candidates() {
    std::vector<Display> list;
    const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    const auto get_display =
        reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
    if (!get_display) return list;
    if (has_extension(extensions, "EGL_EXT_platform_device") &&
        has_extension(extensions, "EGL_EXT_device_enumeration")) {
        const auto query_devices = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
        const auto query_string =
            reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(eglGetProcAddress("eglQueryDeviceStringEXT"));
        EGLDeviceEXT devices[16];
        EGLint count = 0;
        if (query_devices && query_string && query_devices(16, devices, &count))
            for (EGLint i = 0; i < count; ++i)
                if (!has_extension(query_string(devices[i], EGL_EXTENSIONS), "EGL_MESA_device_software"))
                    list.push_back({get_display(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr), "EGL device"});
    }
    if (has_extension(extensions, "EGL_MESA_platform_surfaceless"))
        list.push_back({get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr), "EGL surfaceless"});
    return list;
}

class EglContext final : public Context {
public:
    EglContext(EGLDisplay display, EGLContext context, std::string name)
        : display_(display), context_(context), name_(std::move(name)) {}
    ~EglContext() override {
        if (eglGetCurrentContext() == context_) release();
        eglDestroyContext(display_, context_);
    }
    void make_current() override {
        if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
            throw ContextError(fmt::format("{}: cannot be made current (error {:#x})", name_, eglGetError()));
        load_gl(eglGetProcAddress);
    }
    void release() override { eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }
    std::string name() const override { return name_; }

private:
    EGLDisplay display_;
    EGLContext context_;
    std::string name_;
};

}  // namespace

std::unique_ptr<Context> make_egl_context() {
    std::string why;
    for (const Display& candidate : candidates()) {
        const auto fail = [&](const char* step) {
            why += fmt::format("; {}: {} (error {:#x})", candidate.name, step, eglGetError());
        };
        if (candidate.display == EGL_NO_DISPLAY || !eglInitialize(candidate.display, nullptr, nullptr)) {
            fail("cannot be initialised");
            continue;
        }
        if (!eglBindAPI(EGL_OPENGL_API)) {
            fail("has no desktop OpenGL");
            continue;
        }
        const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
        EGLConfig config = nullptr;
        EGLint count = 0;
        if (!eglChooseConfig(candidate.display, wanted, &config, 1, &count) || count == 0) config = nullptr;
        const EGLint attributes[] = {
            EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
            EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
        const EGLContext context = eglCreateContext(candidate.display, config, EGL_NO_CONTEXT, attributes);
        if (context == EGL_NO_CONTEXT) {
            fail("has no OpenGL 4.3 core");
            continue;
        }
        return std::make_unique<EglContext>(candidate.display, context, candidate.name);
    }
    throw ContextError("EGL: " + (why.empty() ? std::string("no usable platform") : why.substr(2)));
}

}  // namespace farfield
