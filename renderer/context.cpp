#include "renderer/context.h"

#include "renderer/gl.h"

#include <string_view>
#include <fmt/format.h>

namespace farfield {

void load_gl(void (*(*get_address)(const char*))()) {
    const int version = gladLoadGL(get_address);
    if (version == 0) throw ContextError("the OpenGL functions cannot be loaded");
    if (GLAD_VERSION_MAJOR(version) * 10 + GLAD_VERSION_MINOR(version) < 43)
        throw ContextError(fmt::format("OpenGL 4.3 is needed (compute shaders), this is {}",
                                       reinterpret_cast<const char*>(glGetString(GL_VERSION))));
}

std::unique_ptr<Context> make_headless_context(ContextKind kind) {
    if (kind == ContextKind::egl) return make_egl_context();
    if (kind == ContextKind::osmesa) return make_osmesa_context();
    std::string why;
    for (const auto make : {make_egl_context, make_osmesa_context}) {
        try {
            return make();
        } catch (const ContextError& error) {
            why += fmt::format("\n  {}", error.what());
        }
    }
    throw ContextError("no OpenGL context can be made:" + why);
}

bool renders_on_cpu() {
    const std::string_view device = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    for (const char* name : {"llvmpipe", "softpipe", "SWR", "lavapipe"})
        if (device.find(name) != std::string_view::npos) return true;
    return false;
}

bool has_extension(std::string_view name) {
    GLint count = 0;
    glGetIntegerv(GL_NUM_EXTENSIONS, &count);
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i)
        if (reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, i)) == name) return true;
    return false;
}

}  // namespace farfield
