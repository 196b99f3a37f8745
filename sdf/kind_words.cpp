#include "sdf/kind_words.h"

namespace farfield {
namespace {

struct Words {
    NodeKind kind;
    std::string_view words;
};

// After the articles of Inigo Quilez, hg_sdf, MagicaCSG, Womp, Curv and Blender.
constexpr Words table[] = {
    {NodeKind::sphere, "ball"},
    {NodeKind::box, "cube cuboid block"},
    {NodeKind::rounded_box, "cube cuboid block"},
    {NodeKind::torus, "donut doughnut ring"},
    {NodeKind::capsule, "pill line segment stick"},
    {NodeKind::capped_cylinder, "disc disk rod column"},
    {NodeKind::plane, "floor ground half-space"},
    {NodeKind::box_frame, "wireframe cage"},
    {NodeKind::capped_torus, "arc"},
    {NodeKind::capped_cone, "frustum truncated"},
    {NodeKind::hexagonal_prism, "hexagon"},
    {NodeKind::triangular_prism, "triangle wedge"},
    {NodeKind::cut_sphere, "dome hemisphere"},
    {NodeKind::cut_hollow_sphere, "bowl"},
    {NodeKind::ellipsoid, "egg spheroid"},
    {NodeKind::menger_sponge, "fractal"},
    {NodeKind::mandelbulb, "fractal"},
    {NodeKind::custom, "glsl shader formula"},
    {NodeKind::rectangle, "square"},
    {NodeKind::polygon, "triangle hexagon"},
    {NodeKind::union_, "smooth blend smin add join merge melt boolean group"},
    {NodeKind::intersect, "intersection smooth blend smax boolean"},
    {NodeKind::subtract, "subtraction difference smooth blend cut carve hole boolean"},
    {NodeKind::xor_, "difference boolean"},
    {NodeKind::chamfer_union, "bevel"},
    {NodeKind::chamfer_intersect, "bevel"},
    {NodeKind::chamfer_subtract, "bevel"},
    {NodeKind::round_union, "fillet"},
    {NodeKind::round_intersect, "fillet"},
    {NodeKind::round_subtract, "fillet"},
    {NodeKind::morph, "mix lerp interpolate blend"},
    {NodeKind::mirror, "symmetry symmetric reflect fold abs"},
    {NodeKind::repeat, "array tile grid clone mod"},
    {NodeKind::polar_repeat, "array radial circular modpolar"},
    {NodeKind::bend, "curve"},
    {NodeKind::stretch, "scale squash non-uniform"},
    {NodeKind::revolve, "lathe revolution spin"},
    {NodeKind::shell, "onion hollow thickness"},
    {NodeKind::round, "offset inflate dilate"},
    {NodeKind::displace_sine, "displace displacement ripple bump"},
    {NodeKind::displace_noise, "displace displacement perlin bump rock"},
};

}  // namespace

std::string_view other_words(NodeKind kind) {
    for (const Words& entry : table)
        if (entry.kind == kind) return entry.words;
    return {};
}

}  // namespace farfield
