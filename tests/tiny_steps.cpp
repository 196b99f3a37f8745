#include "tests/tiny_steps.h"

#include "renderer/gl.h"
#include "renderer/trace_program.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace farfield {

std::vector<RayRecord> camera_rays(const Box& box, int width) {
    const glm::vec3 target = box.centre();
    const float radius = 0.5f * glm::length(box.size());
    const glm::vec3 origin = target + 2.5f * radius * glm::normalize(glm::vec3(1.0f, 0.7f, 1.3f));
    const glm::vec3 forward = glm::normalize(target - origin);
    const glm::vec3 right = glm::normalize(glm::cross(forward, glm::vec3(0.0f, 1.0f, 0.0f)));
    const glm::vec3 up = glm::cross(right, forward);
    std::vector<RayRecord> rays;
    for (int y = 0; y < width; ++y)
        for (int x = 0; x < width; ++x) {
            const glm::vec2 at = (glm::vec2(x, y) + 0.5f) / (0.5f * static_cast<float>(width)) - 1.0f;
            rays.push_back(
                {origin, 5.0f * radius, glm::normalize(forward + 0.4f * (at.x * right + at.y * up)), fine_footprint});
        }
    return rays;
}

std::vector<HitRecord> traced(const Scene& scene, Tier tier, const std::vector<RayRecord>& rays) {
    TracePrograms tracer;
    gl::Buffer in("rays"), out("hits"), counters("counters");
    in.upload(std::span(rays));
    out.resize(rays.size() * sizeof(HitRecord));
    counters.resize(sizeof(CounterRecord));
    bind_records(in, binding::rays);
    bind_records(out, binding::hits);
    counters.bind_storage(binding::counters);
    const FrameRecord frame{};
    gl::Buffer frame_buffer("frame");
    frame_buffer.upload(&frame, sizeof frame);
    frame_buffer.bind_uniform(binding::frame);
    tracer.select(scene, tier);
    tracer.trace(rays.size(), true, false);  // the nearest hit
    std::vector<HitRecord> hits(rays.size());
    out.read(hits.data(), hits.size() * sizeof(HitRecord));
    return hits;
}

std::vector<float> marched(const Scene& scene, const std::vector<RayRecord>& rays) {
    const GeneratedScene generated = generate(scene, Tier::specialised);
    const std::string source = fmt::format(
        "#version 430 core\n"
        "layout(local_size_x = 64) in;\n"
        "{}"
        "struct Ray {{ vec3 origin; float reach; vec3 direction; float footprint; }};\n"
        "layout(std430, binding = 0) readonly buffer Rays {{ Ray rays[]; }};\n"
        "layout(std430, binding = 1) writeonly buffer Results {{ float results[]; }};\n"
        "uniform vec3 scene_low, scene_high;\n"
        "void main() {{\n"
        "    uint i = gl_GlobalInvocationID.x;\n"
        "    if (i >= uint(rays.length())) return;\n"
        "    vec3 a = (scene_low - rays[i].origin) / rays[i].direction, b = (scene_high - rays[i].origin) / "
        "rays[i].direction;\n"
        "    vec3 enter = min(a, b), leave = max(a, b);\n"
        "    float t = max(max(enter.x, max(enter.y, enter.z)) - {step}, 0.0);\n"
        "    float end = min(leave.x, min(leave.y, leave.z)) + {step};\n"
        "    float low = t, high = -1.0;\n"
        "    int halvings = 0;\n"
        "    while (t < end && halvings < 8) {{\n"
        "        bool inside = scene_distance(rays[i].origin + t * rays[i].direction) < 0.0;\n"
        "        if (inside) high = t; else low = t;\n"
        "        if (high >= 0.0) ++halvings;\n"
        "        t = high < 0.0 ? t + {step} : 0.5 * (low + high);\n"
        "    }}\n"
        "    results[i] = high;\n"
        "}}\n",
        generated.text, fmt::arg("step", smallest_step));
    const gl::Program program("march", source);
    gl::Buffer in("rays"), out("results");
    in.upload(std::span(rays));
    out.resize(rays.size() * sizeof(float));
    in.bind_storage(0);
    out.bind_storage(1);
    program.set("scene_low", generated.bounds.low);
    program.set("scene_high", generated.bounds.high);
    program.run(rays.size());
    std::vector<float> results(rays.size());
    out.read(results.data(), results.size() * sizeof(float));
    return results;
}

}  // namespace farfield
