// Scene tree to GLSL. The text is shown to users, so it reads like hand-written code: one line for each node, its name
// as comment, nothing but what the scene uses. Two tiers of the same program exist (DESIGN, measured on llvmpipe):
// `specialised` has every number as a literal, folds identity transforms and hard blends away and marches 4-5 times
// faster; `live` reads every number from a parameter block, so that no parameter edit needs a new program.
#pragma once

#include "sdf/scene.h"

#include <string>
#include <vector>

namespace farfield {

enum class Tier { live, specialised };

struct GeneratedScene {
    /// Shape functions used, then `float scene_distance(vec3 p)` and `uint scene_material(vec3 p)` (world frame,
    /// metres; material code as blend_materials makes it). The live tier also needs `float parameter(int)`.
    std::string text;
    /// The code without comments. Equal keys mean equal programs: renaming a node changes the text alone, and in the
    /// live tier no parameter edit changes the key.
    std::string key;
    /// What `parameter(i)` returns; filled for the live tier only.
    std::vector<float> parameters;
    /// For each line of `text`, from the first, the node it belongs to; 0 where it belongs to none.
    std::vector<Id> line_nodes;
};

GeneratedScene generate(const Scene& scene, Tier tier);

}  // namespace farfield
