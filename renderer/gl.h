// OpenGL objects as move-only values with debug labels. Made, used and destroyed with a context current; a failure
// throws.
#pragma once

#include <glad/gl.h>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace farfield {

struct ShaderError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

namespace gl {

/// Owns the name of one object; Traits::destroy gives it back.
template <class Traits>
class Handle {
public:
    Handle() = default;
    explicit Handle(GLuint name) : name_(name) {}
    Handle(Handle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    Handle& operator=(Handle&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    ~Handle() {
        if (name_) Traits::destroy(name_);
    }
    GLuint name() const { return name_; }
    explicit operator bool() const { return name_ != 0; }

private:
    GLuint name_ = 0;
};

struct BufferTraits {
    static void destroy(GLuint name) { glDeleteBuffers(1, &name); }
};
struct TextureTraits {
    static void destroy(GLuint name) { glDeleteTextures(1, &name); }
};
struct ProgramTraits {
    static void destroy(GLuint name) { glDeleteProgram(name); }
};
struct QueryTraits {
    static void destroy(GLuint name) { glDeleteQueries(1, &name); }
};

/// Storage or uniform buffer.
class Buffer {
public:
    explicit Buffer(std::string label) : label_(std::move(label)) {}
    void resize(std::size_t bytes);                    ///< keeps nothing; does nothing when it has that size
    void clear();                                      ///< all bytes 0
    void upload(const void* data, std::size_t bytes);  ///< resizes
    template <class T>
    void upload(std::span<const T> items) {
        upload(items.data(), items.size_bytes());
    }
    void read(void* data, std::size_t bytes, std::size_t offset = 0) const;
    std::size_t bytes() const { return size_; }
    void bind_storage(GLuint binding) const { glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, handle_.name()); }
    /// As a texture of what it holds now: elements of `format`, GL_RGBA32UI for example.
    void bind_texels(GLuint unit, GLenum format) const;
    void bind_uniform(GLuint binding) const { glBindBufferBase(GL_UNIFORM_BUFFER, binding, handle_.name()); }

private:
    std::string label_;
    Handle<BufferTraits> handle_;
    mutable Handle<TextureTraits> texels_;
    std::size_t size_ = 0;
};

/// A picture in a buffer: `channels` floats (1 or 4) for each pixel, by rows. Kernels write it as storage and read it
/// as texels: on llvmpipe those come 3.5 times as fast as texels of a two-dimensional texture, and storing is 6 times
/// as fast as into an image, and as fast as drawing.
class Raster {
public:
    Raster() = default;
    Raster(std::string label, glm::ivec2 size, int channels = 4);
    glm::ivec2 size() const { return size_; }
    std::size_t bytes() const { return buffer_ ? buffer_->bytes() : 0; }
    void bind(GLuint unit) const { buffer_->bind_texels(unit, channels_ == 1 ? GL_R32F : GL_RGBA32F); }
    void bind_target(GLuint binding) const { buffer_->bind_storage(binding); }
    std::vector<float> read() const;  ///< one or three floats for each pixel
    explicit operator bool() const { return buffer_.has_value(); }

private:
    std::optional<Buffer> buffer_;
    glm::ivec2 size_{0};
    int channels_ = 0;
};

/// Two-dimensional texture with immutable storage.
class Texture {
public:
    Texture() = default;
    Texture(const std::string& label, GLenum format, glm::ivec2 size, int levels = 1);
    GLuint name() const { return handle_.name(); }
    glm::ivec2 size() const { return size_; }
    int levels() const { return levels_; }
    std::size_t bytes() const;
    void bind(GLuint unit) const;
    void bind_image(GLuint unit, GLenum access, int level = 0) const;
    explicit operator bool() const { return static_cast<bool>(handle_); }

private:
    Handle<TextureTraits> handle_;
    GLenum format_ = 0;
    glm::ivec2 size_{0};
    int levels_ = 0;
};

/// GL_COMPUTE_SHADER for GLSL that says how large its groups are, else GL_FRAGMENT_SHADER.
GLenum stage_of(std::string_view source);

/// A program of one shader, for compute groups (`run`) or for every pixel of a texture (`draw`); stage_of tells.
/// Uniforms are set by name; a name that the program does not use is an error in the pass that sets it.
class Program {
public:
    Program() = default;
    /// Throws ShaderError with the driver's log. `label` names it in messages and debuggers.
    Program(std::string label, std::string_view source);
    void use() const { glUseProgram(handle_.name()); }
    void set(const char* name, int v) const { glProgramUniform1i(handle_.name(), location(name), v); }
    void set(const char* name, unsigned v) const { glProgramUniform1ui(handle_.name(), location(name), v); }
    void set(const char* name, float v) const { glProgramUniform1f(handle_.name(), location(name), v); }
    void set(const char* name, glm::ivec2 v) const { glProgramUniform2i(handle_.name(), location(name), v.x, v.y); }
    void set(const char* name, glm::vec3 v) const { glProgramUniform3f(handle_.name(), location(name), v.x, v.y, v.z); }
    /// The first elements of an array.
    void set(const char* name, std::span<const glm::uvec2> v) const {
        glProgramUniform2uiv(handle_.name(), location(name), static_cast<GLsizei>(v.size()), &v.front().x);
    }
    /// Runs at least `count` invocations in groups of 64x1, and as many for each layer, and makes their writes visible
    /// to what follows.
    void run(std::size_t count, std::size_t layers = 1) const;
    /// The same over a grid.
    void run(glm::ivec2 size) const;
    /// Runs once for each pixel of the target.
    void draw(const Texture& target) const;
    GLuint name() const { return handle_.name(); }
    explicit operator bool() const { return static_cast<bool>(handle_); }

private:
    GLint location(const char* name) const;
    std::string label_;
    Handle<ProgramTraits> handle_;
};

}  // namespace gl

/// The text of renderer/shaders/NAME.
std::string_view shader_text(std::string_view name);
/// The same with the #version line and shaders/common.glsl in front and #line directives so
/// that messages name the file.
std::string shader_source(std::string_view name, std::string_view constants = "");
/// shader_source compiled; `constants` are lines in front of it.
gl::Program load_program(std::string_view name, std::string_view constants = "");

}  // namespace farfield
