// Any bytes as a tree of nodes: its code compiles, and the program's field is that of the CPU.
#include "sdf/codegen.h"
#include "sdf/edit.h"
#include "sdf/evaluate.h"
#include "tests/gl_test.h"
#include "tests/test_support.h"

#include <glm/common.hpp>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>

namespace {

using namespace farfield;

/// Bytes taken from the front; 0 at the end.
class Bytes {
public:
    explicit Bytes(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
    unsigned next() {
        if (bytes_.empty()) return 0;
        const unsigned byte = bytes_[0];
        bytes_ = bytes_.subspan(1);
        return byte;
    }
    float within(float low, float high) { return low + (high - low) * static_cast<float>(next()) / 255.0f; }
    glm::vec3 place(float half) {
        const float x = within(-half, half), y = within(-half, half);
        return {x, y, within(-half, half)};
    }

private:
    std::span<const std::uint8_t> bytes_;
};

/// The default, nothing, a little, or three times as much.
glm::vec3 read_value(const Parameter& parameter, Bytes& bytes) {
    constexpr float factors[] = {1.0f, 0.0f, 0.01f, 3.0f, -1.0f, 0.5f, 1.5f, 1.0f};
    glm::vec3 value = parameter.initial;
    for (int i = 0; i < parameter.components(); ++i) value[i] *= factors[bytes.next() % 8];
    return clamped(parameter, value);
}

Node read_tree(Bytes& bytes, int depth) {
    std::vector<const KindInfo*> kinds;
    for (const KindInfo& kind : node_kinds())
        if (kind.role != Role::instance && (depth > 1 || !kind.takes_children())) kinds.push_back(&kind);
    const KindInfo& kind = *kinds[bytes.next() % kinds.size()];
    Node node = make_node(kind.kind);
    const std::vector<Parameter> list = parameters(node);
    for (std::size_t i = 0; i < node.values.size(); ++i) node.values[i] = read_value(list[i], bytes);
    const unsigned moved = bytes.next();
    if (moved & 1) node.transform.translate = bytes.place(1.0f);
    if (moved & 2) node.transform.rotate = bytes.place(180.0f);
    if (moved & 4) node.transform.scale = std::exp2(bytes.within(-2.0f, 2.0f));
    if (kind.takes_children())
        for (unsigned i = 0; i <= bytes.next() % 2; ++i) node.children.push_back(read_tree(bytes, depth - 1));
    return node;
}

void compare(const Scene& scene) {
    static const auto context = [] {
        auto made = make_headless_context(ContextKind::automatic);
        made->make_current();
        return made;
    }();
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform(-3.0f, 3.0f);
    std::vector<glm::vec4> points(500);
    for (glm::vec4& p : points) p = {uniform(random), uniform(random), uniform(random), 0.0f};
    const FieldEvaluator field(scene);
    const GeneratedScene generated = generate(scene, Tier::specialised);
    const std::vector<float> gpu = gpu_values(generated.text, "scene_distance", points, generated.parameters);
    int differing = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const float cpu = field.distance(glm::vec3(points[i]));
        const bool agrees = std::isfinite(cpu) && std::abs(cpu - gpu[i]) <= 1e-4f * std::max(3.0f, std::abs(cpu));
        if (!agrees && differing++ == 0)
            std::fprintf(stderr, "at (%g, %g, %g): %g on the CPU, %g on the GPU\n", points[i].x, points[i].y,
                         points[i].z, cpu, gpu[i]);
    }
    // Where space is folded, rounding decides on which side a point lies: single points may differ, a program must not.
    if (differing <= 5) return;
    std::fprintf(stderr, "%d of %zu points differ:\n%s\n", differing, points.size(), generated.text.c_str());
    std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes bytes(std::span(data, std::min<std::size_t>(size, 256)));
    Scene scene;
    for (unsigned i = 0; i <= bytes.next() % 2; ++i) apply(scene, InsertNode{scene.root.id, -1, read_tree(bytes, 4)});
    compare(scene);
    return 0;
}
