// The tracer with its safe steps against a march in steps of 1e-4 m that looks at nothing but the field's sign.
#include "sdf/edit.h"
#include "sdf/evaluate.h"
#include "tests/gl_test.h"
#include "tests/test_support.h"
#include "tests/tiny_steps.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace farfield {
namespace {

/// Rays from places in the box where there is nothing, all ways: as light travels.
std::vector<RayRecord> inner_rays(const Box& box, const FieldEvaluator& field, std::mt19937& random) {
    const auto uniform = [&] { return static_cast<float>(random() >> 8) * 0x1p-23f - 1.0f; };
    std::vector<RayRecord> rays;
    for (int tries = 0; rays.size() < 1024 && tries < 50000; ++tries) {
        const glm::vec3 origin = box.centre() + 0.5f * box.size() * glm::vec3(uniform(), uniform(), uniform());
        const glm::vec3 direction(uniform(), uniform(), uniform());
        if (field.distance(origin) > 0.01f && glm::length(direction) > 0.1f)
            rays.push_back({origin, 2.0f * glm::length(box.size()), glm::normalize(direction), fine_footprint});
    }
    return rays;
}

std::vector<float> distances(const std::vector<HitRecord>& hits) {
    std::vector<float> all;
    for (const HitRecord& hit : hits) all.push_back(hit.distance);
    return all;
}

/// Whether there is surface within a millimetre of p, a twentieth of a pixel here: a point inside. The tracer stops
/// where the field is below its tolerance, which is further out where the field is flatter than the distance.
bool is_at_surface(const FieldEvaluator& field, glm::vec3 p, std::mt19937& random) {
    const auto uniform = [&] { return static_cast<float>(random() >> 8) * 0x1p-23f - 1.0f; };
    for (int i = 0; i < 3000; ++i) {
        const glm::vec3 offset(uniform(), uniform(), uniform());
        if (glm::length(offset) <= 1.0f && field.distance(p + 1e-3f * offset) < 0.0f) return true;
    }
    return false;
}

class March : public GlTest {
protected:
    /// `node` over a beam and a ball, which lie off all axes and symmetries.
    void expect_no_difference(Node node, const std::string& name, const char* code = nullptr) {
        if (info(node.kind).takes_children()) node.children = {beam(), ball()};
        Scene scene;
        const Id id = apply(scene, InsertNode{scene.root.id, -1, node});
        if (code) apply(scene, SetCode{id, code});
        expect_no_difference(scene, Tier::specialised, name);
    }

    void expect_no_difference(const Scene& scene, Tier tier, const std::string& name, int early_allowed = 0,
                              int least_hits = 51) {
        const FieldEvaluator field(scene);
        const Box box = field.tree().bounds().common({glm::vec3(-2.0f), glm::vec3(2.0f)});
        std::mt19937 random(1);
        std::vector<RayRecord> rays = camera_rays(box);
        const std::vector<RayRecord> inner = inner_rays(box, field, random);
        rays.insert(rays.end(), inner.begin(), inner.end());
        const std::vector<float> expected = marched(scene, rays), found = distances(traced(scene, tier, rays));
        int hits = 0, holes = 0, early = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const float tolerance = 2.0f * fine_footprint * rays[i].reach;
            hits += expected[i] >= 0.0f;
            if (expected[i] >= 0.0f && (found[i] < 0.0f || found[i] > expected[i] + tolerance)) ++holes;
            if (found[i] >= 0.0f && (expected[i] < 0.0f || found[i] < expected[i] - tolerance) &&
                !is_at_surface(field, rays[i].origin + found[i] * rays[i].direction, random))
                ++early;
        }
        EXPECT_GE(hits, least_hits) << name;
        EXPECT_EQ(holes, 0) << name << ": rays went through the surface, of " << hits << " that meet it";
        EXPECT_LE(early, early_allowed) << name << ": rays met a surface that is not there, of " << rays.size();
    }

    static Node beam() {
        Node node = make_node(NodeKind::box);
        node.values[0] = {0.4f, 0.5f, 0.06f};
        node.transform.rotate = {0.0f, 20.0f, 0.0f};
        return node;
    }

    static Node ball() {
        Node node = make_node(NodeKind::sphere);
        node.values[0].x = 0.2f;
        node.transform.translate = {0.35f, 0.3f, 0.1f};
        return node;
    }
};

TEST_F(March, FindsWhatTinyStepsFind) {
    struct Case {
        NodeKind kind;
        std::vector<std::vector<glm::vec3>> values;  ///< beside the defaults
    };
    const auto x = [](float v) { return glm::vec3(v, 0.0f, 0.0f); };
    using K = NodeKind;
    const Case cases[] = {
        {K::twist, {{x(-40.0f)}, {x(700.0f)}, {x(3000.0f)}}},
        {K::bend, {{x(-120.0f)}, {x(400.0f)}}},
        {K::taper, {{x(1.9f)}, {x(-6.0f)}}},
        {K::stretch, {{{0.05f, 3.0f, 0.4f}}, {{0.3f, 4.0f, 0.08f}}}},
        {K::displace_sine, {{x(0.1f), x(0.08f)}, {x(0.3f), x(0.05f)}}},
        {K::displace_noise, {{x(0.1f), x(0.1f), x(8.0f)}, {x(0.02f), x(0.01f), x(2.0f)}}},
        {K::repeat,
         {{{0.3f, 0.0f, 0.21f}, {4.0f, 1.0f, 3.0f}},
          {{0.7f, 0.9f, 0.8f}, {2.0f, 3.0f, 2.0f}},
          {{0.0f, 0.4f, 1.2f}, {1.0f, 5.0f, 3.0f}}}},
        {K::polar_repeat, {{x(1.0f)}, {x(12.0f)}}},
        {K::mirror, {{glm::vec3(1.0f), x(0.3f)}, {glm::vec3(1.0f), x(0.0f)}}},
        {K::elongate, {{glm::vec3(0.4f)}}},
        {K::morph, {{x(0.05f)}}},
        {K::ellipsoid, {{{1.0f, 0.01f, 0.3f}}}},
        {K::menger_sponge, {}},
    };
    for (const Case& c : cases) {
        Node node = make_node(c.kind);
        const std::string name = info(c.kind).key;
        expect_no_difference(node, name + ", defaults");
        for (std::size_t i = 0; i < c.values.size(); ++i) {
            node.values = c.values[i];
            expect_no_difference(node, fmt::format("{}, extreme parameters {}", name, i));
        }
    }
}

/// Where the tracer goes on by more than the distance: see march_writer.h.
TEST_F(March, FindsWhatTinyStepsFindOfConvexShapes) {
    const auto placed = [](Node node, glm::vec3 translate, glm::vec3 rotate, float scale) {
        node.transform = {translate, rotate, scale};
        return node;
    };
    const auto group = [](NodeKind kind, float radius, std::vector<Node> children) {
        Node node = make_node(kind);
        if (!node.values.empty()) node.values[0].x = radius;
        node.children = std::move(children);
        return node;
    };
    Node room = make_node(NodeKind::box), hollow = make_node(NodeKind::box),
         bore = make_node(NodeKind::capped_cylinder);
    room.values[0] = {1.0f, 0.7f, 0.9f};
    hollow.values[0] = {0.9f, 0.6f, 0.8f};
    bore.values[1].x = 2.0f;
    for (const KindInfo& kind : node_kinds()) {
        const bool combines = kind.role == Role::combine;
        if (!kind.along && !combines && kind.role != Role::distance) continue;
        Scene scene;
        const auto add = [&](const Node& node) { apply(scene, InsertNode{scene.root.id, -1, node}); };
        if (combines || kind.role == Role::distance) {
            // With an edge, turned and scaled, and within a blend, where a level above 0 is asked for.
            const Node pair = group(kind.kind, kind.kind == NodeKind::morph ? 0.4f : 0.08f, {beam(), ball()});
            add(placed(pair, {-0.7f, 0.0f, 0.1f}, {20.0f, 30.0f, 10.0f}, 0.8f));
            add(group(NodeKind::union_, 0.2f, {placed(pair, {0.6f, 0.1f, 0.0f}, {0.0f, 50.0f, 0.0f}, 1.2f), ball()}));
        } else {
            // Alone, taken away from another one, and both in a room.
            const Node shape = make_node(kind.kind);
            if (kind.kind == NodeKind::plane) add(placed(shape, {0.0f, -0.8f, 0.0f}, {10.0f, 0.0f, 5.0f}, 1.0f));
            add(placed(shape, {-0.5f, -0.3f, 0.0f}, {20.0f, 30.0f, 10.0f}, 0.7f));
            add(group(NodeKind::subtract, 0.02f,
                      {beam(), placed(shape, {0.1f, 0.4f, 0.1f}, {40.0f, 0.0f, 0.0f}, 0.6f)}));
            const Node hollows = group(NodeKind::union_, 0.05f, {hollow, placed(bore, {}, {90.0f, 0.0f, 0.0f}, 0.9f)});
            add(group(NodeKind::subtract, 0.0f, {room, hollows}));
        }
        // A few rays that graze edges stop where the field is flatter than the distance, more than a millimetre off.
        constexpr int grazing = 12;
        expect_no_difference(scene, Tier::specialised, kind.key, grazing);
        if (kind.kind == NodeKind::box || kind.kind == NodeKind::union_ || kind.kind == NodeKind::subtract)
            expect_no_difference(scene, Tier::live, std::string(kind.key) + ", live", grazing);
    }
}

/// Where nothing is marched: see cast_writer.h.
TEST_F(March, FindsWhatTinyStepsFindOfHardEdges) {
    std::vector<NodeKind> crossed;
    for (const KindInfo& kind : node_kinds())
        if (kind.span) crossed.push_back(kind.kind);
    for (unsigned seed = 0; seed < 4; ++seed) {
        std::mt19937 random(seed);
        const auto uniform = [&](float low, float high) {
            return low + (high - low) * static_cast<float>(random() >> 8) * 0x1p-24f;
        };
        const auto placed = [&](Node node, float apart) {
            node.transform = {{uniform(-apart, apart), uniform(-apart, apart), uniform(-apart, apart)},
                              {uniform(0.0f, 360.0f), uniform(0.0f, 360.0f), uniform(0.0f, 360.0f)},
                              uniform(0.5f, 1.2f)};
            return node;
        };
        const auto primitive = [&](float apart) {
            return placed(make_node(crossed[random() % crossed.size()]), apart);
        };
        const auto group = [&](NodeKind kind, std::vector<Node> children, float apart) {
            Node node = make_node(kind);
            node.children = std::move(children);
            return placed(node, apart);
        };
        Node common = group(NodeKind::intersect, {primitive(0.1f), primitive(0.1f), primitive(0.1f)}, 0.2f);
        // Five cuts, which overlap, two of them together and one of them what others have in common.
        Node less = group(
            NodeKind::subtract,
            {group(NodeKind::intersect, {primitive(0.1f), make_node(NodeKind::box)}, 0.1f), primitive(0.4f),
             group(NodeKind::union_, {primitive(0.4f), primitive(0.4f)}, 0.1f), primitive(0.4f), std::move(common)},
            0.4f);
        const Node whole = group(NodeKind::subtract, {primitive(0.1f)}, 0.6f);  // nothing is taken away
        Scene scene;
        for (const Node& node : {group(NodeKind::union_, {std::move(less), primitive(0.6f)}, 0.4f), whole})
            apply(scene, InsertNode{scene.root.id, -1, node});
        ASSERT_FALSE(generate(scene, Tier::specialised).marches);
        expect_no_difference(scene, Tier::specialised, fmt::format("hard edges {}", seed), 12, 20);
        // Beside something that is marched.
        apply(scene, InsertNode{scene.root.id, -1, placed(make_node(NodeKind::torus), 0.5f)});
        const GeneratedScene both = generate(scene, Tier::specialised);
        ASSERT_TRUE(both.casts && both.marches);
        expect_no_difference(scene, Tier::specialised, fmt::format("hard edges and a torus {}", seed), 12, 20);
    }
}

/// What is taken away as far as the surface goes, or up to where another one begins, leaves nothing between.
TEST_F(March, NothingIsLeftBetweenFlushCuts) {
    Node plate = make_node(NodeKind::box), bore = make_node(NodeKind::capped_cylinder), half = make_node(NodeKind::box),
         part = make_node(NodeKind::subtract);
    plate.values[0] = {1.0f, 0.3f, 1.0f};
    bore.values[0].x = 0.4f, bore.values[1].x = 0.3f;
    half.values[0] = {0.2f, 0.15f, 0.2f};
    half.transform.translate = {0.7f, 0.15f, 0.0f};
    Node other = half;
    other.transform.translate.y = -0.15f;
    part.children = {plate, bore, half, other};
    part.transform = {{0.1f, 0.2f, 0.3f}, {0.0f, 20.0f, 0.0f}, 1.1f};
    Scene scene;
    apply(scene, InsertNode{scene.root.id, -1, part});
    const glm::mat3 turn = glm::mat3(glm::rotate(glm::mat4(1.0f), glm::radians(20.0f), glm::vec3(0.0f, 1.0f, 0.0f)));
    std::vector<RayRecord> rays;
    for (int i = 0; i < 64; ++i) {
        const float angle = 0.1f * static_cast<float>(i), radius = 0.15f * static_cast<float>(i % 3) / 2.0f;
        const glm::vec3 at{(i % 2 ? 0.7f : 0.0f) + radius * std::cos(angle), 2.0f, radius * std::sin(angle)};
        const glm::vec3 origin = part.transform.translate + 1.1f * (turn * at);
        rays.push_back({origin, 10.0f, {0.0f, -1.0f, 0.0f}, fine_footprint});
    }
    for (const HitRecord& hit : traced(scene, Tier::specialised, rays)) EXPECT_LT(hit.distance, 0.0f);
}

/// Primitives of all kinds, three to five of them blended together, scaled, and within another blend.
TEST_F(March, FindsWhatTinyStepsFindOfManyBlendedTogether) {
    std::vector<NodeKind> primitives;
    for (const KindInfo& kind : node_kinds())
        if (kind.role == Role::primitive && !kind.flat && kind.kind != NodeKind::custom &&
            kind.kind != NodeKind::mandelbulb)
            primitives.push_back(kind.kind);
    for (unsigned seed = 0; seed < 8; ++seed) {
        std::mt19937 random(seed);
        const auto uniform = [&](float low, float high) {
            return low + (high - low) * static_cast<float>(random() >> 8) * 0x1p-24f;
        };
        Node blend = make_node(NodeKind::union_);
        blend.values[0].x = uniform(0.02f, 0.4f);
        blend.transform = {{0.1f, 0.0f, 0.0f}, {0.0f, 30.0f, 0.0f}, 0.8f};
        for (unsigned i = 0; i < 3 + seed % 3; ++i) {
            Node child = make_node(i == 0 ? NodeKind::sphere : primitives[random() % primitives.size()]);
            child.transform = {{uniform(-0.7f, 0.7f), uniform(-0.7f, 0.7f), uniform(-0.7f, 0.7f)},
                               {uniform(0.0f, 360.0f), uniform(0.0f, 360.0f), uniform(0.0f, 360.0f)},
                               uniform(0.2f, 0.6f)};
            blend.children.push_back(child);
        }
        Node outer = make_node(NodeKind::union_);
        outer.values[0].x = 0.15f;
        outer.children = {blend, ball()};
        for (const Node& node : {blend, outer}) {
            Scene scene;
            apply(scene, InsertNode{scene.root.id, -1, node});
            expect_no_difference(scene, Tier::specialised, fmt::format("blend {}", seed), 12, 20);
        }
    }
}

TEST_F(March, FindsWhatTinyStepsFindOfRowsTakenAway) {
    for (const float spacing : {0.35f, 0.5f, 0.8f}) {
        Node bore = make_node(NodeKind::capped_cylinder), row = make_node(NodeKind::repeat),
             part = make_node(NodeKind::subtract);
        bore.values[0].x = 0.2f;
        bore.transform.rotate = {90.0f, 0.0f, 0.0f};
        row.values[0] = {spacing, 0.0f, 0.0f};
        row.values[1] = {3.0f, 1.0f, 1.0f};
        row.transform.rotate = {0.0f, 0.0f, 20.0f};
        row.children = {bore};
        part.values[0].x = 0.03f;
        part.children = {beam(), row};
        Scene scene;
        apply(scene, InsertNode{scene.root.id, -1, part});
        expect_no_difference(scene, Tier::specialised, fmt::format("spacing {}", spacing), 12);
    }
}

TEST_F(March, FindsWhatTinyStepsFindOfCustomCode) {
    const std::pair<const char*, const char*> codes[] = {
        {"a gyroid",
         "const float lipschitz = 1.8;\nfloat sdf(vec3 p) { vec3 q = 9.0 * p; "
         "return abs(dot(sin(q), cos(q.yzx))) / 9.0 - 0.03; }"},
        {"a steep field", "const float lipschitz = 25.0;\nfloat sdf(vec3 p) { return 25.0 * (length(p) - 0.5); }"},
        {"a flat field", "float sdf(vec3 p) { return 0.1 * (length(p) - 0.5); }"},
        {"a fold",
         "uniform int n = 5; // [1, 8]\nconst float lipschitz = 1.0;\nfloat sdf(vec3 p) { for (int i = 0; i < n; ++i) "
         "{ p = abs(p) - 0.2; p = vec3(0.8 * p.x - 0.6 * p.z, p.y, 0.6 * p.x + 0.8 * p.z); } "
         "return box(p, vec3(0.11, 0.3, 0.02)); }"},
        {"a jump", "float sdf(vec3 p) { return p.x < 0.3 ? length(p) - 0.5 : max(length(p) - 0.5, 0.3 - p.x); }"},
        {"waves in the library's shapes",
         "const float lipschitz = 3.5;\nfloat sdf(vec3 p) { "
         "return torus(p, 0.6, 0.2) + 0.04 * sin(40.0 * p.x) * sin(40.0 * p.y) * sin(40.0 * p.z); }"}};
    for (const auto& [name, code] : codes) expect_no_difference(make_node(NodeKind::custom), name, code);
}

TEST_F(March, FindsWhatTinyStepsFindOfRandomTrees) {
    for (unsigned seed = 0; seed < 8; ++seed) {
        std::mt19937 random(seed);
        Scene scene;
        for (int i = 0; i < 3; ++i) apply(scene, InsertNode{scene.root.id, -1, random_tree(3, random)});
        // Where rays stop early is not looked at: some of these fields are much flatter than the distance.
        expect_no_difference(scene, Tier::specialised, fmt::format("seed {}", seed), 1 << 20, 1);
    }
}

}  // namespace
}  // namespace farfield
