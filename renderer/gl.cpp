#include "renderer/gl.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <vector>

namespace farfield {

std::string_view embedded_shader(std::string_view name);  // generated from shaders/*.glsl by embed.cmake

namespace gl {

void Buffer::resize(std::size_t bytes) {
    bytes = std::max<std::size_t>(bytes, 16);  // a binding needs some storage
    if (bytes == size_) return;
    GLuint name = 0;
    glGenBuffers(1, &name);
    handle_ = Handle<BufferTraits>(name);
    texels_ = {};
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, name);
    glBufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(bytes), nullptr, GL_DYNAMIC_COPY);
    glObjectLabel(GL_BUFFER, name, -1, label_.c_str());
    if (glGetError() == GL_OUT_OF_MEMORY)
        throw std::runtime_error(fmt::format("not enough memory for buffer \"{}\" of {} bytes", label_, bytes));
    size_ = bytes;
}

void Buffer::bind_texels(GLuint unit, GLenum format) const {
    glActiveTexture(GL_TEXTURE0 + unit);
    if (!texels_) {
        GLint most = 0;
        glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
        if (size_ / 4 > 4 * static_cast<std::size_t>(most))
            throw std::runtime_error(fmt::format(
                "buffer \"{}\" of {} bytes is larger than the {} texels that this driver allows", label_, size_, most));
        GLuint name = 0;
        glGenTextures(1, &name);
        texels_ = Handle<TextureTraits>(name);
        glBindTexture(GL_TEXTURE_BUFFER, name);
        glTexBuffer(GL_TEXTURE_BUFFER, format, handle_.name());
    }
    glBindTexture(GL_TEXTURE_BUFFER, texels_.name());
}

void Buffer::clear() {
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, handle_.name());
    glClearBufferData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
}

void Buffer::upload(const void* data, std::size_t bytes) {
    resize(bytes);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, handle_.name());
    if (bytes > 0) glBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(bytes), data);
}

void Buffer::read(void* data, std::size_t bytes, std::size_t offset) const {
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, handle_.name());
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
}

Raster::Raster(std::string label, glm::ivec2 size, int channels)
    : buffer_(std::move(label)), size_(size), channels_(channels) {
    buffer_->resize(sizeof(float) * static_cast<std::size_t>(channels) * static_cast<std::size_t>(size.x) *
                    static_cast<std::size_t>(size.y));
}

std::vector<float> Raster::read() const {
    const auto width = static_cast<std::size_t>(size_.x), rows = static_cast<std::size_t>(size_.y),
               stored = static_cast<std::size_t>(channels_), kept = std::min<std::size_t>(stored, 3);
    std::vector<float> values(kept * width * rows), row(stored * width);
    for (std::size_t y = 0; y < rows; ++y) {
        buffer_->read(row.data(), row.size() * sizeof(float), y * row.size() * sizeof(float));
        for (std::size_t x = 0; x < width; ++x) std::copy_n(&row[stored * x], kept, &values[kept * (y * width + x)]);
    }
    return values;
}

Texture::Texture(const std::string& label, GLenum format, glm::ivec2 size, int levels)
    : format_(format), size_(size), levels_(levels) {
    GLuint name = 0;
    glGenTextures(1, &name);
    handle_ = Handle<TextureTraits>(name);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexStorage2D(GL_TEXTURE_2D, levels, format, size.x, size.y);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, levels > 1 ? GL_LINEAR_MIPMAP_NEAREST : GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glObjectLabel(GL_TEXTURE, name, -1, label.c_str());
    if (glGetError() != GL_NO_ERROR)
        throw std::runtime_error(fmt::format("cannot make texture \"{}\" of {} x {}", label, size.x, size.y));
}

std::size_t Texture::bytes() const {
    const std::size_t pixel = format_ == GL_RGBA32F ? 16 : 4;
    std::size_t sum = 0;
    for (int level = 0; level < levels_; ++level)
        sum += pixel * static_cast<std::size_t>(std::max(size_.x >> level, 1)) *
               static_cast<std::size_t>(std::max(size_.y >> level, 1));
    return sum;
}

void Texture::bind(GLuint unit) const {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D, name());
}

void Texture::bind_image(GLuint unit, GLenum access, int level) const {
    glBindImageTexture(unit, name(), level, GL_FALSE, 0, access, format_);
}

namespace {

template <class GetLength, class GetLog>
std::string driver_log(GLuint object, GetLength get_length, GetLog get_log) {
    GLint length = 0;
    get_length(object, GL_INFO_LOG_LENGTH, &length);
    std::vector<char> log(static_cast<std::size_t>(std::max(length, 1)));
    get_log(object, length, nullptr, log.data());
    return std::string(log.data());
}

/// One triangle that covers it.
constexpr std::string_view whole_picture = R"(#version 430 core
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }
)";

}  // namespace

GLenum stage_of(std::string_view source) {
    return source.find("local_size_x") != std::string_view::npos ? GL_COMPUTE_SHADER : GL_FRAGMENT_SHADER;
}

Program::Program(std::string label, std::string_view source) : label_(std::move(label)) {
    handle_ = Handle<ProgramTraits>(glCreateProgram());
    const auto attach = [&](GLenum stage, std::string_view part) {
        const GLuint shader = glCreateShader(stage);
        const char* text = part.data();
        const GLint length = static_cast<GLint>(part.size());
        glShaderSource(shader, 1, &text, &length);
        glCompileShader(shader);
        GLint ok = GL_FALSE;
        glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
        const std::string log = ok ? "" : driver_log(shader, glGetShaderiv, glGetShaderInfoLog);
        glAttachShader(handle_.name(), shader);
        glDeleteShader(shader);  // when the program goes
        if (!ok) throw ShaderError(fmt::format("{} does not compile:\n{}", label_, log));
    };
    const GLenum stage = stage_of(source);
    attach(stage, source);
    if (stage == GL_FRAGMENT_SHADER) attach(GL_VERTEX_SHADER, whole_picture);
    glLinkProgram(handle_.name());
    GLint ok = GL_FALSE;
    glGetProgramiv(handle_.name(), GL_LINK_STATUS, &ok);
    if (!ok)
        throw ShaderError(fmt::format("{} does not link:\n{}", label_,
                                      driver_log(handle_.name(), glGetProgramiv, glGetProgramInfoLog)));
    glObjectLabel(GL_PROGRAM, handle_.name(), -1, label_.c_str());
}

GLint Program::location(const char* name) const {
    const GLint found = glGetUniformLocation(handle_.name(), name);
    assert(found >= 0 && "the program has no such uniform");
    return found;
}

void Program::run(std::size_t count, std::size_t layers) const {
    if (count == 0) return;
    use();
    glDispatchCompute(static_cast<GLuint>((count + 63) / 64), static_cast<GLuint>(layers), 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
}

void Program::run(glm::ivec2 size) const {
    use();
    glDispatchCompute(static_cast<GLuint>((size.x + 63) / 64), static_cast<GLuint>(size.y), 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

void Program::draw(const Texture& target) const {
    GLuint framebuffer = 0, vertices = 0;
    glGenFramebuffers(1, &framebuffer);
    glGenVertexArrays(1, &vertices);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glBindVertexArray(vertices);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target.name(), 0);
    glViewport(0, 0, target.size().x, target.size().y);
    glDisable(GL_DITHER);
    use();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    // llvmpipe draws later than it computes: the next kernel would write into what is being read here.
    glFinish();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glDeleteFramebuffers(1, &framebuffer);
    glDeleteVertexArrays(1, &vertices);
}

}  // namespace gl

std::string_view shader_text(std::string_view name) {
    const std::string_view text = embedded_shader(name);
    if (text.empty()) throw std::logic_error(fmt::format("no shader {} is built in", name));
    return text;
}

std::string shader_source(std::string_view name, std::string_view constants) {
    // A number, not a name, is what core GLSL takes as the file: 1 is common.glsl, 0 the pass's own.
    return fmt::format("#version 430 core\n{}#line 1 1\n{}\n#line 1 0\n{}", constants, shader_text("common.glsl"),
                       shader_text(name));
}

gl::Program load_program(std::string_view name, std::string_view constants) {
    return gl::Program(std::string(name), shader_source(name, constants));
}

}  // namespace farfield
