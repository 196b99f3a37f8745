// The C++ side of the records and bindings of shaders/common.glsl; a test compares the layouts with the driver's.
#pragma once

#include "renderer/gl.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>

namespace farfield {

struct FrameRecord {
    glm::vec3 camera_position;
    float pixel_angle;
    glm::vec3 camera_right;
    float jitter_x;
    glm::vec3 camera_up;
    float jitter_y;
    glm::vec3 camera_forward;
    std::uint32_t seed;
    glm::vec3 sky_horizon;
    std::int32_t light_count;
    glm::vec3 sky_zenith;
    float minimum_step;
    glm::ivec2 image_size;
    std::int32_t step_limit;
    std::int32_t emitter_count;
};
static_assert(sizeof(FrameRecord) == 112);

struct MaterialRecord {
    glm::vec3 albedo;
    float specular;
    glm::vec3 emission;
    float exponent;
    friend bool operator==(const MaterialRecord&, const MaterialRecord&) = default;
};
static_assert(sizeof(MaterialRecord) == 32);

struct LightRecord {
    glm::vec3 position;
    std::uint32_t directional;
    glm::vec3 intensity;
    float unused;
    friend bool operator==(const LightRecord&, const LightRecord&) = default;
};
static_assert(sizeof(LightRecord) == 32);

struct EmitterRecord {
    glm::vec3 low;
    float radiance;
    glm::vec3 high;
    float unused;
};
static_assert(sizeof(EmitterRecord) == 32);

struct PathRecord {
    glm::vec3 radiance;
    float first_hit;
    glm::vec3 pending;
    float weight;
    glm::vec3 throughput;
    float unused;
};
static_assert(sizeof(PathRecord) == 48);

struct CounterRecord {
    std::uint32_t rays = 0, steps = 0, exhausted_rays = 0, unused = 0;
};

inline constexpr std::size_t ray_bytes = 32, hit_bytes = 16, surface_bytes = 32, path_bytes = sizeof(PathRecord),
                             sum_bytes = 16, square_bytes = 4;

/// Binding points of storage buffers, and of uniform buffers. The texture units from first_texels on have the same
/// buffers as textures, see shaders/common.glsl.
namespace binding {
inline constexpr unsigned first_texels = 8;
inline constexpr unsigned rays = 0, hits = 1, surfaces = 2, paths = 3, queue = 4, direct = 6, geometry = 7,
                          reflectance = 8, far_light = 9, indirect = 10, occlusion = 11, counters = 12, split_far = 13,
                          split_near = 14, squares = 15;
/// As texels alone.
inline constexpr unsigned boxes = 16, members = 17, emitters = 18, materials = 19, lights = 20;
inline constexpr unsigned frame = 0, parameters = 1;  // of uniform buffers
}  // namespace binding

/// Storage that kernels write, and the same as a texture that they read.
inline void bind_records(const gl::Buffer& buffer, unsigned at) {
    buffer.bind_storage(at);
    buffer.bind_texels(binding::first_texels + at, at == binding::squares ? GL_R32UI : GL_RGBA32UI);
}

}  // namespace farfield
