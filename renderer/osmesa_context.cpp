// Headless OpenGL through OSMesa, Mesa's off-screen software renderer: the fallback where EGL is missing. Mesa 25.1
// dropped it, so the library is opened at run time and only its header is needed to build. Opened locally: its gl*
// symbols must not shadow those of libGL.
#include "renderer/context.h"

#ifdef FARFIELD_OSMESA
#include <GL/osmesa.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <array>

namespace farfield {
namespace {

struct Library {
    decltype(&OSMesaCreateContextAttribs) create = nullptr;
    decltype(&OSMesaMakeCurrent) make_current = nullptr;
    decltype(&OSMesaDestroyContext) destroy = nullptr;
    decltype(&OSMesaGetProcAddress) get_address = nullptr;

    Library() {
        void* handle = nullptr;
        for (const char* file : {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"})
            if (!handle) handle = dlopen(file, RTLD_NOW | RTLD_LOCAL);
        if (!handle) throw ContextError("OSMesa: libOSMesa is not installed");
        const auto load = [&](auto& function, const char* name) {
            function = reinterpret_cast<std::decay_t<decltype(function)>>(dlsym(handle, name));
            if (!function) throw ContextError(fmt::format("OSMesa: {} is missing", name));
        };
        load(create, "OSMesaCreateContextAttribs");
        load(make_current, "OSMesaMakeCurrent");
        load(destroy, "OSMesaDestroyContext");
        load(get_address, "OSMesaGetProcAddress");
    }
    static const Library& get() {
        static const Library library;  // stays open: contexts may outlive everything else
        return library;
    }
};

class OsMesaContext final : public Context {
public:
    OsMesaContext() {
        const int attributes[] = {OSMESA_FORMAT,
                                  OSMESA_RGBA,
                                  OSMESA_PROFILE,
                                  OSMESA_CORE_PROFILE,
                                  OSMESA_CONTEXT_MAJOR_VERSION,
                                  4,
                                  OSMESA_CONTEXT_MINOR_VERSION,
                                  3,
                                  0};
        context_ = library_.create(attributes, nullptr);
        if (!context_) throw ContextError("OSMesa: has no OpenGL 4.3 core");
    }
    ~OsMesaContext() override { library_.destroy(context_); }
    void make_current() override {
        if (!library_.make_current(context_, pixel_.data(), GL_UNSIGNED_BYTE, 1, 1))
            throw ContextError("OSMesa: cannot be made current");
        load_gl([](const char* name) { return Library::get().get_address(name); });
    }
    void release() override { library_.make_current(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0); }
    std::string name() const override { return "OSMesa"; }

private:
    const Library& library_ = Library::get();
    OSMesaContext context_ = nullptr;
    std::array<unsigned char, 4> pixel_{};  ///< OSMesa insists on a colour buffer
};

}  // namespace

std::unique_ptr<Context> make_osmesa_context() { return std::make_unique<OsMesaContext>(); }

}  // namespace farfield

#else

namespace farfield {

std::unique_ptr<Context> make_osmesa_context() { throw ContextError("OSMesa: not built in"); }

}  // namespace farfield

#endif
