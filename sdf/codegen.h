// Scene tree to GLSL. The text is shown to users, so it reads like hand-written code: one line for each node, its name
// as comment, nothing but what the scene uses. Two tiers of the same program exist, because on llvmpipe a number from a
// buffer costs far more than a literal: `specialised` has literals, so that identity transforms and hard blends fold
// away; `live` reads every number from a parameter block, so that no parameter edit needs a new program. In between, a
// specialised program can have one `tuned` node whose numbers are live: what the editor uses while a hand moves them.
// Each definition becomes one function, called by all of its instances, with one set of values in the parameter block;
// where its material is not the same everywhere, a second one tells the material too.
#pragma once

#include "sdf/scene.h"

#include <string>
#include <vector>

namespace farfield {

struct FieldTree;

enum class Tier { live, specialised };

struct GeneratedScene {
    /// Shape functions used, the code of custom nodes, functions of definitions, then `float scene_distance(vec3 p)`,
    /// `float scene_surface(vec3 p, out uint material)` (world frame, metres; material code as blend_materials makes
    /// it) and what rays ask for: `float scene_cast(vec3 p, vec3 v)` (see cast_writer.h) and, of what that leaves out,
    /// `vec2 scene_march(vec3 p, vec3 v)` (see march_writer.h), one of them or both. With parameters it also needs
    /// `float parameter(int)`.
    std::string text;
    /// Where in `text` the functions begin that are for scene_surface alone, and those for rays alone: a program
    /// with one of the two needs no more of the rest than what stands before the first.
    std::size_t surface_at = 0, march_at = 0;
    /// Where in `text` and in `key` ends what does not depend on the nodes' numbers but for those that the code of
    /// custom nodes holds: library and custom code.
    std::size_t own_at = 0, own_key_at = 0;
    /// The code without comments. Equal keys mean equal programs: renaming a node changes the text alone, and in the
    /// live tier no parameter edit changes the key.
    std::string key;
    /// What `parameter(i)` returns; empty when no node is live.
    std::vector<float> parameters;
    /// For each line of `text`, from the first, the node it belongs to; 0 where it belongs to none.
    std::vector<Id> line_nodes;
    bool casts = false, marches = false;  ///< which of the two functions are there
    /// Whether the field, and that of what is marched, can be much flatter than the distance: bounds of stretched
    /// space, some primitives.
    bool flat = false, marches_flat = false;
    /// Turns of loops in an evaluation by scene_march, at most; 0: it has none.
    std::uint64_t loop_turns = 0;
    /// Of a family (sdf/families.h): so many vec4 of numbers each of its members has. The program needs them as
    /// `member0`, `member1`, ...; 0 for a scene that is no family.
    std::size_t member_vectors = 0;
    /// Boxes around all surfaces and around those that are marched, world frame; a ray outside meets nothing.
    Box bounds, marched_bounds;
};

/// `tuned`: a node whose own values, transform and material come from the parameter block in the specialised tier too.
GeneratedScene generate(const Scene& scene, Tier tier, Id tuned = 0);

/// Larger scenes, instances counted with what they show, are marched by their distance alone: the code is half as long,
/// and 1,000 nodes compile in half the time.
bool marches_by_distance(const Scene& scene);
/// The same, said for a part of a scene.
GeneratedScene generate(const Scene& part, Tier tier, Id tuned, bool by_distance);
GeneratedScene generate(const FieldTree& part, Tier tier, Id tuned, bool by_distance);

}  // namespace farfield
