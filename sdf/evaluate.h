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
    static float distance(const FieldNode& node, glm::vec3 p) { return evaluate(node, p).distance; }
    /// Before a node with a stretch is made safe; p in the node's own frame. Its steepest slope is promised where p
    /// lies in the node's region and its image in what its children fill.
    static float unsafe_distance(const FieldNode& node, glm::vec3 p);
    /// Unit direction of steepest ascent by central differences over 2 h; the up direction where the field is flat.
    glm::vec3 normal(glm::vec3 p, float h = 1e-3f) const;
    /// Material code (see blend_materials) of the surface nearest to p.
    std::uint32_t material(glm::vec3 p) const;

private:
    struct Sample {
        float distance;
        std::uint32_t material;
    };
    static Sample evaluate(const FieldNode& node, glm::vec3 p);
    static Sample fold(const FieldNode& node, glm::vec3 p);

    FieldTree tree_;
};

}  // namespace farfield
