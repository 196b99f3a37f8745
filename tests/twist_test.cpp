// The twist's distance is a bound that no rule of the primitives gives: nothing of the surface may lie nearer.
#include "sdf/evaluate.h"
#include "tests/test_support.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace farfield {
namespace {

TEST(Twist, NoSurfaceIsNearerThanTheDistance) {
    std::mt19937 random(1);
    auto within = [&](float half) { return half * (static_cast<float>(random() >> 8) * 0x1p-23f - 1.0f); };
    for (float rate : {-400.0f, -60.0f, 5.0f, 90.0f, 360.0f, 2000.0f}) {
        Scene scene;
        Node twist = make_node(NodeKind::twist);
        twist.values[0].x = rate;
        Node box = make_node(NodeKind::box);
        box.transform.translate = {0.4f, 0.0f, 0.0f};
        twist.children.push_back(box);
        scene.root.children.push_back(twist);
        const FieldEvaluator field(scene);
        for (int i = 0; i < 2000; ++i) {
            const glm::vec3 p(within(2.0f), within(1.0f), within(2.0f));
            const float d = field.distance(p);
            for (int k = 0; k < 20; ++k) {
                const glm::vec3 offset(within(1.0f), within(1.0f), within(1.0f));
                if (glm::length(offset) == 0.0f) continue;
                // 1e-5 metres allows for the rounding of the twisted position; the surface would show as a change of
                // sign.
                const float reach = std::abs(d) - 1e-5f;
                const float other = field.distance(p + glm::normalize(offset) * reach);
                ASSERT_TRUE(reach <= 0.0f || (d > 0.0f) == (other > 0.0f))
                    << rate << " at " << p.x << ' ' << p.y << ' ' << p.z;
            }
        }
    }
}

}  // namespace
}  // namespace farfield
