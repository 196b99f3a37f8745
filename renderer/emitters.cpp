#include "renderer/emitters.h"

#include "sdf/local_scene.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace farfield {
namespace {

/// Metres. What is larger, most rays meet anyway, and the shader's numbers are good for no more.
constexpr float largest = 1e4f;

float luminance(glm::vec3 rgb) {
    return glm::dot(rgb, glm::vec3(0.2126f, 0.7152f, 0.0722f));  // Rec. 709
}

/// Radiance of what is neither an emitter nor lit by one, roughly: the sky, and surfaces that reflect half of what they
/// get, half of which a directional light reaches, and all of which at the distance of the scene's size a point light.
float other_radiance(const Scene& scene, const FieldTree& geometry) {
    constexpr float reflected = 1.0f / std::numbers::pi_v<float>;
    const Box box = finite_bounds(geometry, geometry.root->id).value_or(Box{glm::vec3(0.0f), glm::vec3(0.0f)});
    const glm::vec3 half = 0.5f * box.size();
    float sum = 0.5f * luminance(scene.sky.horizon + scene.sky.zenith);
    for (const Light& light : scene.lights) {
        const glm::vec3 way = light.position - box.centre();
        const float square = std::max(glm::dot(way, way), glm::dot(half, half) / 3.0f);
        sum += reflected * luminance(light.intensity) *
               (light.kind == LightKind::directional ? 0.5f : 1.0f / std::max(square, 1e-6f));
    }
    return sum;
}

/// In one of the parts that a hard union unites, which has definitions of its own.
class Finder {
public:
    Finder(const Scene& scene, const FieldTree& part) : scene_(scene), part_(part) {
        for (const FieldNode& definition : part.definitions) of_definitions_.push_back(shown_by(definition));
    }

    void add_to(std::vector<EmitterRecord>& found) const { add_to(found, *part_.root); }

private:
    /// What a node shows: the most that its own materials emit, and whether it takes another from its instances.
    struct Shown {
        float radiance = 0.0f;
        bool inherits = false;
    };

    float emitted(std::uint32_t material) const {
        return material == inherited_material ? 0.0f : luminance(scene_.materials[material].emission);
    }

    Shown shown_by(const FieldNode& node) const {
        if (node.kind->role == Role::instance) {
            const Shown& all = of_definitions_[node.definition];
            return {std::max(all.radiance, all.inherits ? emitted(node.material) : 0.0f),
                    all.inherits && node.material == inherited_material};
        }
        if (node.children.empty()) return {emitted(node.material), node.material == inherited_material};
        Shown all;
        for (const FieldNode& child : node.children) {
            const Shown one = shown_by(child);
            all = {std::max(all.radiance, one.radiance), all.inherits || one.inherits};
        }
        return all;
    }

    void add_to(std::vector<EmitterRecord>& found, const FieldNode& node) const {
        for (const FieldNode& child : node.children) add_to(found, child);
        if (!node.children.empty()) return;
        const float radiance = shown_by(node).radiance;
        if (!(radiance > 0.0f)) return;
        const std::optional<Box> box = world_bounds(part_, node.id);
        if (!box) return;
        const Box shown = box->common(part_.bounds());
        const glm::vec3 side = shown.size();
        if (std::max({side.x, side.y, side.z}) < largest) found.push_back({shown.low, radiance, shown.high, 0.0f});
    }

    const Scene& scene_;
    const FieldTree& part_;
    std::vector<Shown> of_definitions_;
};

float flux(const EmitterRecord& e) {
    const glm::vec3 side = e.high - e.low;
    return e.radiance * (side.x * side.y + side.y * side.z + side.z * side.x);
}

}  // namespace

std::vector<EmitterRecord> find_emitters(const Scene& scene, const FieldTree& geometry) {
    std::vector<EmitterRecord> found;
    const bool any = std::any_of(scene.materials.begin(), scene.materials.end(),
                                 [](const Material& m) { return luminance(m.emission) > 0.0f; });
    if (!any || !geometry.root) return found;
    for (const FieldTree& part : united(geometry)) Finder(scene, part).add_to(found);
    const std::size_t kept = std::min(found.size(), most_emitters);
    std::partial_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(kept), found.end(),
                      [](const EmitterRecord& a, const EmitterRecord& b) { return flux(a) > flux(b); });
    found.resize(kept);
    const glm::vec3 origin = local_origin(scene.camera);
    const float others = other_radiance(scene, geometry);
    for (EmitterRecord& e : found) {
        e.low -= origin;
        e.high -= origin;
        e.radiance /= std::max(others, 1e-6f * e.radiance);
    }
    return found;
}

}  // namespace farfield
