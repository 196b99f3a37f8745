// The scene's field on the CPU, by the same functions of shapes.glsl that the generated program uses.
#pragma once

#include "sdf/field_tree.h"

#include <glm/vec3.hpp>

#include <cstdint>

namespace farfield {

/// A scene prepared for evaluation; independent of the scene afterwards.
class FieldEvaluator {
public:
    explicit FieldEvaluator(const Scene& scene) : tree_(scene) {}
    const FieldTree& tree() const { return tree_; }
    /// Signed distance bound at p (world frame, metres), negative inside.
    float distance(glm::vec3 p) const;
    /// The same of one node alone, p in its parent's frame.
    float distance(const FieldNode& node, glm::vec3 p) const { return evaluate(node, p, 0).distance; }
    /// Before a node with a stretch is made safe; p in the node's own frame. Its steepest slope is promised where p
    /// lies in the node's region and its image in what its children fill.
    float unsafe_distance(const FieldNode& node, glm::vec3 p) const;
    /// Unit direction of steepest ascent by central differences over 2 h; the up direction where the field is flat.
    glm::vec3 normal(glm::vec3 p, float h = 1e-3f) const;
    /// Material code (see blend_materials) of the surface nearest to p.
    std::uint32_t material(glm::vec3 p) const;
    /// The primitive or instance whose surface is nearest to p, that of a blend's larger part; 0 in an empty scene.
    Id owner(glm::vec3 p) const;

private:
    struct Sample {
        float distance;
        std::uint32_t material;
        Id owner;
    };
    /// `inherited`: the material of nodes in definitions that have none of their own.
    Sample evaluate(const FieldNode& node, glm::vec3 p, std::uint32_t inherited) const;
    Sample fold(const FieldNode& node, glm::vec3 p, std::uint32_t inherited) const;
    static float custom(const FieldNode& node, glm::vec3 p);

    FieldTree tree_;
};

}  // namespace farfield
