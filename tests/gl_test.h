// What tests on the GPU share.
#pragma once

#include "renderer/context.h"
#include "renderer/gl.h"
#include "renderer/image.h"

#include <glm/vec4.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace farfield {

/// A headless context of its own for each test.
class GlTest : public testing::Test {
protected:
    void SetUp() override {
        context_ = make_headless_context(ContextKind::automatic);
        context_->make_current();
    }
    void TearDown() override { context_->release(); }
    std::unique_ptr<Context> context_;
};

/// How many pixels differ by more than `tolerance` in a channel.
inline std::size_t differing_pixels(const Image& a, const Image& b, float tolerance) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.pixels.size(); i += 3) {
        float most = 0.0f;
        for (std::size_t k = i; k < i + 3; ++k) most = std::max(most, std::abs(a.pixels[k] - b.pixels[k]));
        count += most > tolerance ? 1 : 0;
    }
    return count;
}

/// `float function(vec3)` of these GLSL functions at each point; `float parameter(int)` answers the parameters.
inline std::vector<float> gpu_values(const std::string& functions, const std::string& function,
                                     const std::vector<glm::vec4>& points, std::span<const float> parameters) {
    const gl::Program program("values",
                              "#version 430 core\nlayout(local_size_x = 64) in;\n"
                              "layout(std430, binding = 0) readonly buffer Points { vec4 points[]; };\n"
                              "layout(std430, binding = 1) writeonly buffer Results { float results[]; };\n"
                              "layout(std430, binding = 2) readonly buffer P { float block[]; };\n"
                              "float parameter(int i) { return block[i]; }\n" +
                                  functions +
                                  "void main() {\n"
                                  "    uint i = gl_GlobalInvocationID.x;\n"
                                  "    if (i < uint(points.length())) results[i] = " +
                                  function +
                                  "(points[i].xyz);\n"
                                  "}\n");
    gl::Buffer in("points"), out("results"), block("parameters");
    in.upload(std::span(points));
    out.resize(points.size() * sizeof(float));
    block.upload(parameters);
    in.bind_storage(0);
    out.bind_storage(1);
    block.bind_storage(2);
    program.run(points.size());
    std::vector<float> results(points.size());
    out.read(results.data(), results.size() * sizeof(float));
    return results;
}

}  // namespace farfield
