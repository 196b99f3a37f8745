// A large scene in parts that are traced one after the other. What a hard union unites can be traced apart: of the hits
// the nearest counts. So an edit of a large scene compiles the part that it touches alone, and a ray marches only in
// those parts whose bounds it meets. Smooth unions and all other operations stay whole.
#pragma once

#include "sdf/scene.h"

#include <vector>

namespace farfield {

/// Scenes of so many nodes or fewer, instances counted with what they show, stay whole.
inline constexpr std::uint64_t largest_whole_scene = 48;

/// Scenes whose hard union is `scene`, at least one; each has the nodes above its own with their transforms and
/// materials, and everything that is not a node. Where one part ends and the next begins follows from the order of the
/// nodes and their ids, never from their numbers (but for a blend that turns a hard union into a smooth one), and an
/// edit changes the parts where it takes place and no others.
std::vector<Scene> scene_parts(const Scene& scene);

}  // namespace farfield
