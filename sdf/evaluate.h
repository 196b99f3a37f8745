// The scene's field on the CPU, by the same functions of shapes.glsl that the generated program uses.
#pragma once

#include "sdf/scene.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace farfield {

/// What a scene without any shape answers, metres: far beyond everything that a ray may reach.
inline constexpr float empty_distance = 1e9f;

/// A scene prepared for evaluation; independent of the scene afterwards.
class FieldEvaluator {
public:
    explicit FieldEvaluator(const Scene& scene);
    /// Signed distance bound at p (world frame, metres), negative inside.
    float distance(glm::vec3 p) const;
    /// Unit direction of steepest ascent by central differences over 2 h; the up direction where the field is flat.
    glm::vec3 normal(glm::vec3 p, float h = 1e-3f) const;
    /// Material code (see blend_materials) of the surface nearest to p.
    std::uint32_t material(glm::vec3 p) const;

private:
    struct Sample {
        float distance;
        std::uint32_t material;
    };
    struct Part {
        const KindInfo* kind;
        std::vector<glm::vec3> values;  ///< in code units
        glm::vec3 translate;
        glm::mat3 to_own;  ///< inverse rotation
        float scale;
        std::uint32_t material;
        std::vector<Part> children;
    };
    static Part prepare(const Scene& scene, const Node& node, std::uint32_t inherited);
    static Sample evaluate(const Part& part, glm::vec3 p);
    static Sample fold(const Part& part, glm::vec3 p);

    std::vector<Part> root_;  ///< one part, or none when the scene is empty
};

}  // namespace farfield
