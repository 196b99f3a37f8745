// The scene as code generation and evaluation see it: nodes that add a shape, numbers in code units, materials
// resolved, and what follows from a node's content: bounds, symmetry, safe steps.
//
// Bounds. A node's box holds all points where its field is at most 0. Higher levels matter too: `round` shows the level
// of its radius, a smooth union that of its fill. So bounds are taken of a level, which each operation passes down
// raised by what it adds (KindInfo::reach); where a distance is a bound its levels reach further than the shape, and so
// does the box. All is conservative, nothing is minimal.
//
// Definitions are prepared once, however many instances show them. The box of one at another level is kept for the next
// instance that asks for it; such levels are rounded up to a few for each octave, or definitions that use each other at
// different scales and blends would ask for a number of levels that grows exponentially.
//
// Safe steps. Every node's field is 1-Lipschitz in its own frame, so that a step as long as its value is safe and
// blends of it stay so. Isometries, combinations and scales (which multiply the distance) keep that by themselves. What
// stretches the domain divides by the stretch, which follows from its parameters and the bounds of its content, and at
// p from p too: a twist is slower away from its axis than on it, and nothing beyond its content slows down
// (KindInfo::stretch).
#pragma once

#include "sdf/custom_code.h"
#include "sdf/scene.h"

#include <glm/mat3x3.hpp>

#include <optional>
#include <string>
#include <vector>

namespace farfield {

/// What a scene without any shape answers, metres: far beyond everything that a ray may reach.
inline constexpr float empty_distance = 1e9f;

/// In place of a material's index in definitions: that of the instance.
inline constexpr std::uint32_t inherited_material = 0xffffffff;

struct FieldNode {
    Id id;
    std::string name;
    const KindInfo* kind;
    std::vector<glm::vec3> values;  ///< in code units, the derived ones at the end
    glm::vec3 translate;
    glm::mat3 to_own;  ///< inverse rotation
    float scale;
    std::uint32_t material;  ///< index, or inherited_material
    Box region;              ///< what the node fills in its own frame; stretched content is evaluated within it
    Extent extent;           ///< the same in the parent's frame
    std::vector<FieldNode> children;
    bool guarded = false;                              ///< repetitions: see KindInfo::guard_copy
    std::size_t definition = 0;                        ///< instances: index in FieldTree::definitions
    std::vector<Parameter> parameters{};               ///< what the values belong to, but for the derived ones
    std::shared_ptr<const CustomCode> code = nullptr;  ///< of a custom node

    /// How much higher a level its children are asked for; see Bounds.
    float reach() const;
    /// How much the node would shorten steps at worst: the Lipschitz constant of its field before it is made safe.
    float stretch() const { return code ? code->lipschitz() : kind->stretch ? kind->stretch(values) : 1.0f; }

    /// Whether both come to the same code, whatever they are called.
    friend bool operator==(const FieldNode& a, const FieldNode& b);
};

struct FieldTree {
    FieldTree() = default;
    /// The scene must have no nesting problem (see scene.h).
    explicit FieldTree(const Scene& scene);

    /// Of the whole scene, world frame; unbounded along axes where it has no end. A point for an empty scene.
    Box bounds() const { return root ? root->extent.box : Box{glm::vec3(0.0f), glm::vec3(0.0f)}; }

    std::optional<FieldNode> root;       ///< none when the scene adds no shape
    std::vector<FieldNode> definitions;  ///< those that show, each after all that it uses

    friend bool operator==(const FieldTree& a, const FieldTree& b) = default;
};

/// What the node's children fill together, in its own frame; what a primitive fills itself.
Extent content_extent(const FieldNode& node);

/// Bounds in the world of what node `id` fills, conservatively: operations above it move, copy and bend it, and do not
/// take anything away. Unbounded along axes where it has no end. None where the node adds no shape.
std::optional<Box> world_bounds(const FieldTree& tree, Id id);
/// As world_bounds, without those parts of unions that have no end; bounded, and none where nothing is.
std::optional<Box> finite_bounds(const FieldTree& tree, Id id);

/// Gives the node another place in its parent's frame.
void move(FieldNode& node, glm::vec3 translate, const glm::mat3& to_own);

/// Whether the node is nothing but all of its children.
bool is_hard_union(const FieldNode& node);
/// The scene with its hard unions opened: what they unite, each with its place in the world.
std::vector<FieldTree> united(FieldTree tree);

/// The node below `node` (itself included) with this id; null where it adds no shape.
const FieldNode* find(const FieldNode& node, Id id);

}  // namespace farfield
