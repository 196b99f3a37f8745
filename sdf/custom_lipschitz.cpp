#include "sdf/custom_lipschitz.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <cmath>
#include <random>

namespace farfield {

float estimate_lipschitz(const CustomCode& code, glm::vec3 low, glm::vec3 high, std::span<const glm::vec3> values,
                         int pairs) {
    std::mt19937 random(1);
    const auto uniform = [&](float from, float to) {
        return from + (to - from) * static_cast<float>(random() >> 8) * 0x1p-24f;
    };
    const auto direction = [&] {
        glm::vec3 d;
        do d = {uniform(-1.0f, 1.0f), uniform(-1.0f, 1.0f), uniform(-1.0f, 1.0f)};
        while (glm::dot(d, d) > 1.0f || glm::dot(d, d) < 1e-4f);
        return glm::normalize(d);
    };
    const float size = glm::length(high - low);
    struct Pair {
        glm::vec3 at, along;  // unit
        float length;
        float slope = 0.0f;
    };
    const auto measure = [&](Pair pair) {
        const glm::vec3 a = pair.at, b = pair.at + pair.length * pair.along;
        const float slope = std::abs(code.evaluate(a, values) - code.evaluate(b, values)) / glm::distance(a, b);
        pair.slope = std::isfinite(slope) ? slope : 0.0f;
        return pair;
    };
    // Lengths down to 1e-3 of the box: below, the rounding of the values, 1e-7 of their size, would show.
    Pair best{low, {1.0f, 0.0f, 0.0f}, size};
    for (int i = 0; i < pairs; ++i) {
        const bool near = i % 2 == 1;
        const float spread = std::exp2(uniform(-10.0f, 0.0f));
        Pair next{{uniform(low.x, high.x), uniform(low.y, high.y), uniform(low.z, high.z)}, direction(), size * spread};
        if (near) {
            next.at = glm::clamp(best.at + 0.2f * next.length * direction(), low, high);
            next.along = glm::normalize(best.along + spread * next.along * 0.999f);
            next.length = best.length * uniform(0.5f, 1.5f);
        }
        next.length = glm::clamp(next.length, 1e-3f * size, size);
        next = measure(next);
        if (next.slope > best.slope) best = next;
    }
    return best.slope;
}

}  // namespace farfield
