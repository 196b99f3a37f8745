// What the tracer is told of convex shapes (KindInfo::along, within, span): that their tangents lie below them, rays
// stay inside as long as is said, and lines are inside where that is said.
#include "sdf/node_kinds.h"
#include "tests/test_support.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace farfield {
namespace {

/// Distances of some metres pass through about 20 operations of float rounding, 1.2e-7 relative each.
constexpr float rounding = 2e-5f;

class Convex : public testing::TestWithParam<NodeKind> {
protected:
    float uniform(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }
    glm::vec3 point(float half) {
        const float x = uniform(-half, half), y = uniform(-half, half), z = uniform(-half, half);
        return {x, y, z};
    }
    glm::vec3 direction() {
        for (;;)
            if (const glm::vec3 v = point(1.0f); glm::length(v) > 1e-2f && glm::length(v) < 1.0f)
                return glm::normalize(v);
    }
    /// Sizes from a millimetre to two metres.
    std::vector<glm::vec3> values() {
        std::vector<glm::vec3> result;
        for (const Parameter& parameter : kind_.parameters) {
            glm::vec3 v = parameter.initial;
            for (int i = 0; i < parameter.components(); ++i) v[i] = std::exp2(uniform(-10.0f, 1.0f));
            result.push_back(clamped(parameter, v));
        }
        return result;
    }

    const KindInfo& kind_ = info(GetParam());
    std::mt19937 random_{7};
};

TEST_P(Convex, TangentsLieBelowTheField) {
    int outside = 0;
    for (int i = 0; i < 20000; ++i) {
        const std::vector<glm::vec3> v = values();
        const glm::vec3 p = i % 3 == 0 ? point(0.3f) : point(3.0f), along = direction();
        const glm::vec2 field = kind_.slope(p, along, v);
        ASSERT_NEAR(field.x, kind_.primitive(p, v), rounding);
        if (field.x <= 0.0f) continue;
        ++outside;
        ASSERT_LE(std::abs(field.y), 1.0f + rounding);
        const float t = std::exp2(uniform(-10.0f, 3.0f));
        ASSERT_LE(field.x + field.y * t, kind_.primitive(p + t * along, v) + rounding * (1.0f + t))
            << "at " << testing::PrintToString(p.x) << ", " << p.y << ", " << p.z << ", " << t << " m on";
    }
    EXPECT_GT(outside, 1000);
}

TEST_P(Convex, TangentsTouchTheField) {
    int compared = 0, off = 0;
    for (int i = 0; i < 4000; ++i) {
        const std::vector<glm::vec3> v = values();
        const glm::vec3 p = point(3.0f), along = direction();
        const glm::vec2 field = kind_.slope(p, along, v);
        if (field.x <= 0.05f) continue;
        constexpr float h = 1e-2f;
        const float slope = (kind_.primitive(p + h * along, v) - kind_.primitive(p - h * along, v)) / (2.0f * h);
        ++compared;
        off += std::abs(slope - field.y) > 0.02f;  // beside creases
    }
    EXPECT_LT(off, compared / 20);
}

TEST_P(Convex, RaysStayInsideAsLongAsIsSaid) {
    if (!kind_.stay) return;
    int inside = 0;
    for (int i = 0; i < 20000; ++i) {
        const std::vector<glm::vec3> v = values();
        const glm::vec3 p = point(0.5f), along = direction();
        const float depth = i % 2 == 0 ? 0.0f : std::exp2(uniform(-8.0f, 0.0f));
        const float stay = std::min(kind_.stay(p, along, depth, v), 50.0f);
        ASSERT_GE(stay, 0.0f);
        if (stay == 0.0f) continue;
        ++inside;
        for (const float share : {0.0f, uniform(0.0f, 1.0f), 1.0f})
            ASSERT_LE(kind_.primitive(p + share * stay * along, v), -depth + rounding * (1.0f + stay));
    }
    EXPECT_GT(inside, 200);
}

TEST_P(Convex, LinesAreInsideWhereTheirSpansAre) {
    if (!kind_.crossed) return;
    int crossed = 0;
    for (int i = 0; i < 20000; ++i) {
        const std::vector<glm::vec3> v = values();
        // Along axes, too, whose other coordinates do not change.
        const glm::vec3 p = i % 3 == 0 ? point(0.3f) : point(3.0f), to = i % 2 == 0 ? point(0.5f) - p : direction();
        glm::vec3 along = glm::normalize(to);
        if (i % 5 == 0) along = glm::vec3(0.0f), along[i / 5 % 3] = i % 15 < 5 ? 1.0f : -1.0f;
        const glm::vec2 span = kind_.crossed(p, along, v);
        const auto field = [&](float t) { return kind_.primitive(p + t * along, v); };
        const auto tolerance = [](float t) { return rounding * (1.0f + std::abs(t)); };
        const auto name = [&](float t) {
            return ::testing::Message() << "from (" << p.x << ", " << p.y << ", " << p.z << ") along (" << along.x
                                        << ", " << along.y << ", " << along.z << "), span " << span.x << " to "
                                        << span.y << ", at " << t;
        };
        const glm::vec2 near = glm::clamp(span, -20.0f, 20.0f);
        crossed += span.x < span.y;
        for (int k = 0; k <= 20; ++k) {
            const float t = -10.0f + static_cast<float>(k);
            const float inside = glm::mix(near.x, near.y, 0.05f * static_cast<float>(k));
            if (t < span.x || t > span.y || span.x > span.y) {
                ASSERT_GE(field(t), -tolerance(t)) << name(t);
            }
            if (span.x <= span.y && span.y > -20.0f && span.x < 20.0f) {
                ASSERT_LE(field(inside), tolerance(inside)) << name(inside);
            }
        }
        for (const float t : {span.x, span.y})
            if (span.x <= span.y && std::abs(t) < 20.0f) {
                ASSERT_NEAR(field(t), 0.0f, tolerance(t)) << name(t);
            }
    }
    EXPECT_GT(crossed, 2000);
}

std::vector<NodeKind> convex_kinds() {
    std::vector<NodeKind> kinds;
    for (const KindInfo& kind : node_kinds())
        if (kind.slope) kinds.push_back(kind.kind);
    return kinds;
}

INSTANTIATE_TEST_SUITE_P(Kinds, Convex, testing::ValuesIn(convex_kinds()),
                         [](const testing::TestParamInfo<NodeKind>& test) {
                             return std::string(farfield::info(test.param).key);
                         });

}  // namespace
}  // namespace farfield
