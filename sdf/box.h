// Axis-aligned boxes: conservative bounds of what a node fills.
#pragma once

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <cmath>

namespace farfield {

/// Coordinates of this size stand for infinity: finite, so that sums and products of them stay numbers.
inline constexpr float unbounded = 1e9f;
inline bool is_unbounded(float v) { return std::abs(v) > 0.5f * unbounded; }

struct Box {
    glm::vec3 low{-unbounded};
    glm::vec3 high{unbounded};

    glm::vec3 centre() const { return 0.5f * (low + high); }
    glm::vec3 size() const { return high - low; }
    /// Whether the box ends on both sides of the axis.
    bool is_bounded(int axis) const { return !is_unbounded(low[axis]) && !is_unbounded(high[axis]); }
    bool is_bounded() const { return is_bounded(0) && is_bounded(1) && is_bounded(2); }

    /// Further by r on every side; a box without extent where r is negative and larger than the box.
    Box grown(float r) const { return Box{low - r, high + r}.valid(); }
    Box united(const Box& b) const { return {glm::min(low, b.low), glm::max(high, b.high)}; }
    /// What both hold; where they hold nothing in common, a point between them.
    Box common(const Box& b) const { return Box{glm::max(low, b.low), glm::min(high, b.high)}.valid(); }
    /// The box around all of rotation * (scale * p) + translate, p in this box.
    Box transformed(const glm::mat3& rotation, float scale, glm::vec3 translate) const {
        Box box{translate, translate};
        for (int column = 0; column < 3; ++column)
            for (int row = 0; row < 3; ++row) {
                const float m = rotation[column][row];
                if (m == 0.0f) continue;
                box.low[row] += along(m, m > 0.0f ? low[column] : high[column], scale);
                box.high[row] += along(m, m > 0.0f ? high[column] : low[column], scale);
            }
        return box.valid();
    }
    friend bool operator==(const Box&, const Box&) = default;
    Box valid() const {
        const glm::vec3 middle = centre();
        return {glm::clamp(glm::min(low, middle), -unbounded, unbounded),
                glm::clamp(glm::max(high, middle), -unbounded, unbounded)};
    }

private:
    static float along(float m, float v, float scale) {
        return is_unbounded(v) ? std::copysign(4.0f * unbounded, m * v) : m * scale * v;
    }
};

}  // namespace farfield
