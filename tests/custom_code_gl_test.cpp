// Custom code on the GPU, as it is given to the driver, against its evaluation on the CPU.
#include "sdf/custom_code.h"
#include "sdf/shape_library.h"
#include "tests/custom_code_samples.h"
#include "tests/gl_test.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace farfield {
namespace {

std::vector<float> gpu_values(const CustomCode& code, const std::vector<std::string>& arguments,
                              const std::vector<glm::vec4>& points) {
    const std::string text = code.glsl("7", arguments);
    std::vector<float> block;
    for (const Parameter& parameter : code.parameters())
        for (int k = 0; k < 3; ++k) block.push_back(to_code_units(parameter, parameter.initial)[k]);
    block.push_back(0.0f);  // never empty
    return farfield::gpu_values(
        "#define PI 3.14159265358979\n"
        "vec3 parameter3(int i) { return vec3(parameter(i), parameter(i + 1), parameter(i + 2)); }\n" +
            used_shapes(text) + text,
        "sdf_7", points, block);
}

struct Sample {
    const char* name;
    const char* text;
    double tolerance = 1e-5;
};

const Sample samples[] = {
    {"parameters", R"(uniform float radius = 0.5;   // [0, 2] m   Radius of the ball
uniform vec3 offset = vec3(0.1, 0.2, 0.3);  // [-1, 1] m
uniform int folds = 4;  // [1, 12]
uniform bool hollow = true;
uniform float turn = 30.0;  // [0, 360] °
uniform ivec3 counts = ivec3(1, 2, 3);
uniform bvec3 axes = bvec3(true, false, true);
float sdf(vec3 p) {
    p = mix(p, abs(p), axes);
    for (int i = 0; i < folds; ++i) p += offset * float(counts[i % 3]) * cos(turn);
    float d = length(p) - radius;
    return hollow ? abs(d) - 0.1 : d;
})"},
    {"library and own names", R"(float box(vec3 p) { return length(p - vec3(1.0)) - 0.5; }
float place(vec3 p) { return sphere(p, 0.4); }
float sdf(vec3 p) {
    float PI = 3.0, scene_distance = smooth_union(box(p), rounded_box(p, vec3(0.5), 0.1), 0.3);
    float sphere_7 = min(scene_distance, place(p - vec3(0.0, PI, 0.0)));
    return min(sphere_7, torus(p, 1.5, 0.2));
})"},
    {"gyroid", R"(const float scale = 3.0;
const float lipschitz = 2.0;
float sdf(vec3 p) {
    vec3 q = p * scale;
    float g = dot(sin(q), cos(q.zxy)) / scale;
    return max(abs(g) - 0.03, length(p) - 2.0);
})"},
    {"Menger sponge", R"(float cube(vec3 p, float s) { vec3 q = abs(p) - s; return max(q.x, max(q.y, q.z)); }
float sdf(vec3 p) {
    float d = cube(p, 1.0), s = 1.0;
    for (int m = 0; m < 3; m++) {
        vec3 a = mod(p * s, 2.0) - 1.0;
        s *= 3.0;
        vec3 r = abs(1.0 - 3.0 * abs(a));
        vec3 m3 = max(r.xyz, r.yzx);
        d = max(d, (min(m3.x, min(m3.y, m3.z)) - 1.0) / s);
    }
    return d;
})"},
    {"arrays and structures", R"(struct Ball { vec3 centre; float radius[2]; };
const Ball balls[3] = Ball[3](Ball(vec3(0.0), float[2](0.5, 0.1)), Ball(vec3(1.0, 0.0, 0.0), float[2](0.25, 0.2)),
                              Ball(vec3(0.0, 1.0, 0.0), float[](0.3, 0.3)));
void grow(inout Ball b, out float by, in float amount) { by = amount; b.radius[0] += by; amount = 3.0; b.centre.zx -= vec2(by, 0.5); }
float sdf(vec3 p) {
    float d = 1e6, by;
    float seen[3];
    for (int i = 0; i < 3; ++i) {
        Ball b = balls[i];
        grow(b, by, 0.1 * float(i));
        seen[2 - i] = length(p - b.centre) - b.radius[0] - b.radius[i & 1];
        d = min(d, seen[2 - i]);
    }
    vec2[2] pair = vec2[2](p.xy, p.yz);
    pair[1].yx += pair[0];
    return d + 0.1 * seen[1] + (pair[0] == pair[1] ? 1.0 : 0.0) + 0.1 * pair[1].x;
})"},
    {"matrices",
     R"(mat3 turned(float a) { float c = cos(a), s = sin(a); return mat3(c, 0.0, -s, 0.0, 1.0, 0.0, s, 0.0, c); }
float sdf(vec3 p) {
    mat3 m = turned(0.7) * transpose(turned(0.2)) + 0.5 * outerProduct(vec3(1.0, 2.0, 0.5), vec3(0.1, 0.2, 0.3));
    vec3 q = inverse(m) * p + p * m;
    mat2 r = mat2(m);
    q.xz *= r;
    m[1] = q; m[2][0] = 0.5; m += 1.0;
    mat2x3 a = mat2x3(1.0, 2.0, 3.0, 4.0, 5.0, 6.0);
    mat4 i4 = mat4(2.0);
    i4[3] = vec4(q, 1.0);
    return length(q) - 0.5 + 0.01 * determinant(m) + dot(a * q.xy, m[0]) * 0.01 + determinant(i4) * 0.01 + (inverse(i4) * vec4(p, 1.0)).x + determinant(matrixCompMult(r, r));
})"},
    {"whole numbers", R"(uint hash(uvec3 v) {
    uint h = v.x * 1664525u + 1013904223u;
    h ^= (v.y << 7) | (v.z >> 3u);
    h *= 2246822519u; h ^= h >> 13; h -= 77u; h %= 100000u;
    return h / 3u;
}
float sdf(vec3 p) {
    ivec3 cell = ivec3(floor(p * 2.0));
    uint h = hash(uvec3(cell + 100)) & 0xffu;
    int k = cell.x * 3 - (cell.y + 50) / 2 + (cell.z + 20) % 7 + int(h);
    k = -k + abs(~k) * sign(k) + clamp(k, -2, 5) + min(k, 3) - max(cell.x, cell.y);
    switch (k & 3) {
        case 0: return length(p);
        case 1: k += 2; break;
        case 2: k *= 2;
        default: { k -= 1; }
    }
    bool odd = (k & 1) == 1 ^^ p.x > 0.0;
    return length(p) + (odd ? float(k) : -0.5 * float(h)) + (any(lessThan(cell, ivec3(0))) && all(notEqual(cell, ivec3(7))) ? 1.0 : 2.0);
})"},
    {"common functions", R"(float sdf(vec3 p) {
    vec3 a = fract(p) + floor(p) * 0.5 + ceil(p.zxy) + round(p * 1.3 + 0.01) + trunc(p) + sign(p);
    a += clamp(p, -1.0, vec3(0.5).x) + step(0.3, p) + smoothstep(-1.0, 2.0, p) + mix(p, a, 0.25) + mix(p, a, p * 0.1);
    a += mod(p, vec3(0.7, 1.1, 1.3)) + radians(p) + degrees(p) * 0.01 + abs(p) + min(p, 0.2) + max(p, p.yzx);
    vec3 n = normalize(p + 0.01);
    a += reflect(p, n) + refract(n, vec3(0.0, 1.0, 0.0), 0.6) + faceforward(n, p, vec3(1.0)) + cross(p, n);
    float whole, part = modf(p.x, whole);
    return distance(a, p) + dot(p, n) + part + whole + inversesqrt(dot(p, p) + 1.0) + sqrt(abs(p.y)) + fma(p.x, p.y, p.z)
         + (isnan(p.x) || isinf(p.y) ? 1.0 : 0.0) + uintBitsToFloat(floatBitsToUint(p.x) & 0xffff0000u);
})"},
    // Transcendental functions are approximate on the GPU: GLSL asks no precision of most of them.
    {"transcendental functions", R"(float sdf(vec3 p) {
    vec3 u = clamp(p * 0.12, -0.99, 0.99), q = abs(p) + 0.1;
    return dot(asin(u) + acos(u.yzx) + atan(p, q) + atan(p.zxy), vec3(0.1)) + dot(exp(u) + log(q) + exp2(u) + log2(q), vec3(0.1))
         + dot(pow(q, vec3(0.3, 1.7, 0.5)), vec3(0.1)) + dot(sin(p) + cos(p) + 0.01 * tan(u), vec3(0.1))
         + 0.1 * (sinh(u.x) + cosh(u.y) + tanh(p.z) + asinh(p.x) + acosh(1.0 + q.y) + atanh(u.z));
})",
     1e-4},
    {"flow", R"(float f(float x) { if (x < 0.0) return -x; else if (x > 2.0) { return x * 0.5; } return x; }
float g(float x, float y) { return f(f(x) - f(y)) + f(x * y); }
float sdf(vec3 p) {
    float d = 0.0;
    int n = 0;
    for (float t = 0.0; t < 1.0; t += 0.125) {
        if (p.x * t > 2.0) continue;
        for (uint k = 5u; k > 1u; k -= 2u) {
            if (p.y > 3.0 && k == 3u) break;
            d += g(p.z * t, float(k)) * 0.01;
            n++;
        }
        if (d > 4.0) break;
    }
    bool late = n > 5 || (d += 1.0) > 2.0;
    float x = p.x, y = x++ + (late ? ++x : x--) * 2.0, z = (x = 2.0, x * y);
    return d + float(n) * 0.1 + y - z;
})"},
    {"shadowing", R"(uniform float radius = 0.4;
uniform float length_ = 0.3; // [0, 1]
const float step = 0.25;
struct Part { float radius; float step; };
float helper(vec3 p, float radius) { { float step = radius; radius = step * 2.0; } return length(p) - radius - step; }
float sdf(vec3 p) {
    Part radius_7 = Part(0.2, step);
    float d = helper(p, radius_7.radius) + radius_7.step + length_;
    for (int radius = 0; radius < 2; ++radius) d += float(radius) * step;
    return d - radius;
})"},
    {"swizzles", R"(float sdf(vec3 p) {
    vec4 v = p.xyzz.wzyx;
    v.xw = v.wx; v.yz += v.xx; v.rgb *= 0.5; v.st = vec2(v.q, v.p);
    vec3 q = vec3(v.xy, p.z).zzx;
    for (int i = 0; i < 3; ++i) { q[i] += v[i + 1] * p[2 - i]; v.wzyx[i] ; }
    q.yx = q.xy; p.x = p.y = q.z; q.zxy = q; q--; q.xz = q.zx++;
    return length(q) + p.x - v.wzyx.x;
})"},
};

class CustomCodeOnGpu : public GlTest {
protected:
    void SetUp() override {
        GlTest::SetUp();
        std::mt19937 random(1);
        std::uniform_real_distribution<float> uniform(-4.0f, 4.0f);
        points_.resize(4'000);
        for (glm::vec4& p : points_) p = {uniform(random), uniform(random), uniform(random), 0.0f};
    }
    std::vector<glm::vec4> points_;
};

/// Relative to the result and to 1; the values of these samples are of that size.
TEST_F(CustomCodeOnGpu, AgreesWithTheCpu) {
    for (const Sample& sample : samples) {
        SCOPED_TRACE(sample.name);
        const auto parsed = CustomCode::parse(sample.text);
        for (const CodeError& e : parsed.errors) ADD_FAILURE() << e.line << ": " << e.message;
        if (!parsed.code) continue;
        std::vector<glm::vec3> values;
        std::vector<std::string> literals, live;
        for (const Parameter& parameter : parsed.code->parameters()) {
            const glm::vec3 v = to_code_units(parameter, parameter.initial);
            const bool one = parameter.components() == 1;
            live.push_back(fmt::format("{}({})", one ? "parameter" : "parameter3", 3 * values.size()));
            literals.push_back(one ? fmt::format("float({})", v.x) : fmt::format("vec3({}, {}, {})", v.x, v.y, v.z));
            values.push_back(v);
        }
        for (const auto& arguments : {literals, live}) {
            const std::vector<float> gpu = gpu_values(*parsed.code, arguments, points_);
            // A comparison that rounding decides differently may turn a point into another case; those are few.
            int beyond = 0;
            double worst = 0.0;
            glm::vec4 where{};
            for (std::size_t i = 0; i < points_.size(); ++i) {
                const double cpu = parsed.code->evaluate(glm::vec3(points_[i]), values);
                const double error = std::abs(cpu - gpu[i]) / std::max(1.0, std::abs(cpu));
                if (!(error <= sample.tolerance)) ++beyond;
                if (!(error <= worst)) worst = error, where = points_[i];
            }
            EXPECT_LE(beyond, 2) << "worst " << worst << " at " << where.x << ", " << where.y << ", " << where.z;
        }
    }
}

/// What glslang takes and the checks let pass must not be refused by the driver.
TEST_F(CustomCodeOnGpu, WhatIsAcceptedCompiles) {
    points_.resize(1);
    int accepted = 0;
    for (unsigned seed = 10'000; accepted < 20; ++seed) {
        const std::string text = mutated_code(seed);
        const auto parsed = CustomCode::parse(text);
        if (!parsed.code) continue;
        ++accepted;
        const std::vector<std::string> arguments(parsed.code->parameters().size(), "1.0");
        EXPECT_NO_THROW(gpu_values(*parsed.code, arguments, points_)) << text;
    }
}

}  // namespace
}  // namespace farfield
