// How steep a field is, by trying: for points a and b, |f(a) - f(b)| / |a - b| is at most the Lipschitz constant of f,
// so every pair is a lower bound of it, and a pair above 1 shows that steps are not safe. A third of the pairs are
// random, a third lie along the gradient at a random point, a third along the one near the steepest place so far. Of
// values that are rounded to within r, |f(a) - f(b)| - r counts, so that rounding never looks like a slope.
#pragma once

#include "sdf/box.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>

namespace farfield {

/// Looks for the steepest pair of points of one field.
class SlopeSearch {
public:
    struct Pair {
        glm::vec3 a{0.0f}, b{0.0f};
        float fa = 0.0f, fb = 0.0f;
        float slope = 0.0f;
    };

    SlopeSearch(const Box& box, std::uint32_t seed)
        : box_(box),
          size_(std::max(0.5f * glm::length(box.size()), 1e-3f)),
          rounding_(1e-5f * (size_ + glm::length(box.centre()))),
          random_(seed) {}

    /// `field(p)` is the value at p; ends early when `stop` is set; pairs for which `counts(a, b)` is false are left
    /// out.
    template <class Field, class Counts>
    void run(int pairs, const std::atomic<bool>* stop, Field field, Counts counts) {
        for (int i = 0; i < pairs && !not_finite_; ++i) {
            if (i % 64 == 0 && stop && *stop) return;
            const Pair pair = i % 3 == 0   ? measured(anywhere(), field)
                              : i % 3 == 1 ? along_gradient(anywhere().a, field)
                                           : along_gradient(steepest_.a + step() * direction(), field);
            ++tried_;
            if (!std::isfinite(pair.fa) || !std::isfinite(pair.fb)) {
                not_finite_ = std::isfinite(pair.fa) ? pair.b : pair.a;
            } else if (counts(pair.a, pair.b)) {
                if (pair.slope > steepest_.slope) steepest_ = pair;
            }
        }
    }

    int tried() const { return tried_; }
    const Pair& steepest() const { return steepest_; }
    const std::optional<glm::vec3>& not_finite() const { return not_finite_; }

private:
    float uniform(float low, float high) { return low + (high - low) * static_cast<float>(random_() >> 8) * 0x1p-24f; }

    glm::vec3 direction() {
        for (;;) {
            const float x = uniform(-1.0f, 1.0f), y = uniform(-1.0f, 1.0f), z = uniform(-1.0f, 1.0f);
            const glm::vec3 d{x, y, z};
            if (const float length = glm::length(d); length < 1.0f && length > 1e-2f) return d / length;
        }
    }

    /// From a thousandth of the size to all of it apart: millimetres to metres for what is of a metre's size.
    float step() { return size_ * std::exp2(uniform(-10.0f, 0.0f)); }

    Pair anywhere() {
        const Box around = random_() % 2 ? box_ : box_.grown(size_);
        const float x = uniform(around.low.x, around.high.x), y = uniform(around.low.y, around.high.y);
        const glm::vec3 a{x, y, uniform(around.low.z, around.high.z)};
        const glm::vec3 to = direction();
        return {a, a + step() * to};
    }

    /// Forward differences give the direction.
    template <class Field>
    Pair along_gradient(glm::vec3 a, Field field) {
        const float h = size_ * std::exp2(uniform(-10.0f, -3.0f)), here = field(a);
        glm::vec3 gradient;
        for (int axis = 0; axis < 3; ++axis) {
            glm::vec3 b = a;
            b[axis] += h;
            gradient[axis] = field(b) - here;
        }
        const float length = glm::length(gradient);
        return measured({a, a + h * (length > 0.0f && std::isfinite(length) ? gradient / length : direction())}, field);
    }

    template <class Field>
    Pair measured(Pair pair, Field field) const {
        pair.fa = field(pair.a), pair.fb = field(pair.b);
        const float apart = glm::distance(pair.a, pair.b);
        if (apart > 0.0f) pair.slope = std::max(std::abs(pair.fa - pair.fb) - rounding_, 0.0f) / apart;
        return pair;
    }

    Box box_;
    float size_, rounding_;
    std::mt19937 random_;
    int tried_ = 0;
    Pair steepest_;
    std::optional<glm::vec3> not_finite_;
};

}  // namespace farfield
