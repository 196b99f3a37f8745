// Primitives and profiles of the table; their functions are in shapes.glsl.
#include "sdf/kind_table.h"

namespace farfield {
namespace {

// What primitives fill, centred on the origin unless they say otherwise; their mirror symmetries.
using Symmetry = std::array<bool, 3>;
constexpr Symmetry xyz{true, true, true}, xz{true, false, true}, yz{false, true, true}, xy{true, true, false};
Extent within(glm::vec3 half_size, Symmetry symmetric = xyz) { return {{-half_size, half_size}, symmetric}; }
Extent turned(float radius, float low, float high) { return {{{-radius, low, -radius}, {radius, high, radius}}, xz}; }

bool is_even(float n) { return std::fmod(n, 2.0f) == 0.0f; }

/// A ring or an arc of it around the z axis, open downwards.
Extent ring_extent(float radius, float thickness, float angle) {
    const float outer = radius + glm::min(0.5f * thickness, radius), inner = glm::max(radius - 0.5f * thickness, 0.0f);
    const float half = 0.5f * angle, cosine = std::cos(half);
    const float x = cosine > 0.0f ? outer * std::sin(half) : outer;
    return {{{-x, (cosine < 0.0f ? outer : inner) * cosine, -unbounded}, {x, outer, unbounded}}, xz};
}

Extent cut_ball(float radius, float cut_height, bool above) {
    const float h = glm::clamp(cut_height, -radius, radius);
    const float widest = (h > 0.0f) == above ? std::sqrt(radius * radius - h * h) : radius;
    return above ? turned(widest, h, radius) : turned(widest, -radius, h);
}

KindInfo make_primitive(NodeKind kind, const char* key, const char* label, const char* tip, bool exact,
                        std::vector<Parameter> parameters, Extent (*extent)(Values), const char* function,
                        float (*evaluate)(glm::vec3, Values)) {
    KindInfo k{};
    k.kind = kind, k.key = key, k.label = label, k.tip = tip, k.role = Role::primitive, k.exact = exact;
    k.parameters = std::move(parameters), k.extent = extent, k.function = function, k.primitive = evaluate;
    return k;
}

/// A primitive whose field is convex: `along` tells its slope too, `within` how far rays stay inside.
void make_convex(KindInfo& k, const char* along, glm::vec2 (*slope)(glm::vec3, glm::vec3, Values),
                 const char* within = nullptr, float (*stay)(glm::vec3, glm::vec3, float, Values) = nullptr) {
    k.along = along, k.slope = slope, k.within = within, k.stay = stay;
}

/// One that lines cross in closed form.
void make_crossed(KindInfo& k, const char* span, glm::vec2 (*crossed)(glm::vec3, glm::vec3, Values)) {
    k.span = span, k.crossed = crossed;
}

KindInfo make_profile(NodeKind kind, const char* key, const char* label, const char* tip,
                      std::vector<Parameter> parameters, Extent (*extent)(Values), const char* function,
                      float (*evaluate)(glm::vec3, Values)) {
    KindInfo k = make_primitive(kind, key, label, tip, true, std::move(parameters), extent, function, evaluate);
    k.flat = true;
    return k;
}

}  // namespace

void add_primitives(std::vector<KindInfo>& t) {
    using K = NodeKind;
    t.push_back(make_primitive(
        K::sphere, "sphere", "Sphere", "All points within a radius", true, {length("radius", "Radius", 0.5f)},
        [](Values v) { return within(glm::vec3(v[0].x)); }, FUNCTION(primitive, sphere)));
    make_convex(t.back(), FUNCTION(slope, sphere_along), FUNCTION(stay, sphere_within));
    make_crossed(t.back(), FUNCTION(slope, sphere_span));
    t.push_back(make_primitive(
        K::box, "box", "Box", "A box with sharp edges", true, {lengths("half_size", "Half the edge lengths", 0.5f)},
        [](Values v) { return within(v[0]); }, FUNCTION(primitive, box)));
    make_convex(t.back(), FUNCTION(slope, box_along), FUNCTION(stay, box_within));
    make_crossed(t.back(), FUNCTION(slope, box_span));
    t.push_back(make_primitive(
        K::rounded_box, "rounded_box", "Rounded box", "A box with rounded edges", true,
        {lengths("half_size", "Half the edge lengths, rounding included", 0.5f),
         length("radius", "Radius of the edges, at most the smallest half size", 0.1f)},
        [](Values v) { return within(v[0]); }, FUNCTION(primitive, rounded_box)));
    make_convex(t.back(), FUNCTION(slope, rounded_box_along));
    t.push_back(make_primitive(
        K::torus, "torus", "Torus", "A ring around the y axis", true,
        {length("major_radius", "From the axis to the middle of the tube", 0.5f),
         length("minor_radius", "Radius of the tube", 0.15f)},
        [](Values v) { return turned(v[0].x + v[1].x, -v[1].x, v[1].x); }, FUNCTION(primitive, torus)));
    t.push_back(make_primitive(
        K::capsule, "capsule", "Capsule", "A cylinder along y with round ends", true,
        {length("radius", "Radius", 0.25f), length("half_height", "Half the length of the straight part", 0.25f)},
        [](Values v) { return turned(v[0].x, -v[0].x - v[1].x, v[0].x + v[1].x); }, FUNCTION(primitive, capsule)));
    make_convex(t.back(), FUNCTION(slope, capsule_along));
    make_crossed(t.back(), FUNCTION(slope, capsule_span));
    t.push_back(make_primitive(
        K::capped_cylinder, "capped_cylinder", "Cylinder", "A cylinder along y with flat ends", true,
        {length("radius", "Radius", 0.4f), length("half_height", "Half the height", 0.5f)},
        [](Values v) {
            return within({v[0].x, v[1].x, v[0].x});
        },
        FUNCTION(primitive, capped_cylinder)));
    make_convex(t.back(), FUNCTION(slope, capped_cylinder_along), FUNCTION(stay, capped_cylinder_within));
    make_crossed(t.back(), FUNCTION(slope, capped_cylinder_span));
    t.push_back(make_primitive(
        K::cone, "cone", "Cone", "A cone along y, tip up, with a flat base", true,
        {length("radius", "Radius of the base", 0.5f), length("half_height", "Half the height", 0.5f)},
        [](Values v) { return turned(v[0].x, -v[1].x, v[1].x); }, FUNCTION(primitive, cone)));
    make_convex(t.back(), FUNCTION(slope, cone_along));
    make_crossed(t.back(), FUNCTION(slope, cone_span));
    t.push_back(make_primitive(
        K::plane, "plane", "Plane", "Everything at and below y = 0", true, {},
        [](Values) {
            return Extent{{glm::vec3(-unbounded), {unbounded, 0.0f, unbounded}}, xz};
        },
        FUNCTION(primitive, plane)));
    make_convex(t.back(), FUNCTION(slope, plane_along), FUNCTION(stay, plane_within));
    make_crossed(t.back(), FUNCTION(slope, plane_span));
    t.push_back(make_primitive(
        K::infinite_cylinder, "infinite_cylinder", "Infinite cylinder", "A cylinder along y without ends", true,
        {length("radius", "Radius", 0.25f)},
        [](Values v) {
            return within({v[0].x, unbounded, v[0].x});
        },
        FUNCTION(primitive, infinite_cylinder)));
    make_convex(t.back(), FUNCTION(slope, infinite_cylinder_along), FUNCTION(stay, infinite_cylinder_within));
    make_crossed(t.back(), FUNCTION(slope, infinite_cylinder_span));
    t.push_back(make_primitive(
        K::box_frame, "box_frame", "Box frame", "The twelve edges of a box, as bars", true,
        {lengths("half_size", "Half the edge lengths", 0.5f),
         length("thickness", "Width of the bars, at most the smallest half size", 0.1f)},
        [](Values v) { return within(v[0]); }, FUNCTION(primitive, box_frame)));
    t.push_back(make_primitive(
        K::capped_torus, "capped_torus", "Capped torus", "A part of a ring around the y axis, with round ends", true,
        {length("major_radius", "From the axis to the middle of the tube", 0.5f),
         length("minor_radius", "Radius of the tube", 0.15f),
         angle("angle", "How much of the ring is there, half on either side of the x axis", 220.0f)},
        [](Values v) {
            return within({v[0].x + v[1].x, v[1].x, v[0].x + v[1].x}, yz);
        },
        FUNCTION(primitive, capped_torus)));
    t.push_back(make_primitive(
        K::link, "link", "Link", "A link of a chain, standing along y", true,
        {length("major_radius", "From the middle of the bend to the middle of the tube", 0.25f),
         length("minor_radius", "Radius of the tube", 0.1f),
         length("half_height", "Half the length of the straight parts", 0.2f)},
        [](Values v) {
            return within({v[0].x + v[1].x, v[0].x + v[1].x + v[2].x, v[1].x});
        },
        FUNCTION(primitive, link)));
    t.push_back(make_primitive(
        K::rounded_cylinder, "rounded_cylinder", "Rounded cylinder", "A cylinder along y with rounded rims", true,
        {length("radius", "Radius", 0.4f), length("half_height", "Half the height", 0.5f),
         length("edge_radius", "Radius of the rims, at most radius and half height", 0.1f)},
        [](Values v) {
            return within({v[0].x, v[1].x, v[0].x});
        },
        FUNCTION(primitive, rounded_cylinder)));
    make_convex(t.back(), FUNCTION(slope, rounded_cylinder_along));
    t.push_back(make_primitive(
        K::capped_cone, "capped_cone", "Capped cone", "A cone along y without its tip", true,
        {length("lower_radius", "Radius of the lower end", 0.5f),
         length("upper_radius", "Radius of the upper end", 0.25f), length("half_height", "Half the height", 0.5f)},
        [](Values v) { return turned(glm::max(v[0].x, v[1].x), -v[2].x, v[2].x); }, FUNCTION(primitive, capped_cone)));
    make_convex(t.back(), FUNCTION(slope, capped_cone_along));
    make_crossed(t.back(), FUNCTION(slope, capped_cone_span));
    t.push_back(make_primitive(
        K::round_cone, "round_cone", "Round cone", "Two balls and all between them, along y", true,
        {length("lower_radius", "Radius of the lower ball", 0.35f),
         length("upper_radius", "Radius of the upper ball", 0.2f),
         length("half_height", "Half the distance of the balls' centres", 0.25f)},
        [](Values v) {
            return turned(glm::max(v[0].x, v[1].x), glm::min(-v[2].x - v[0].x, v[2].x - v[1].x),
                          glm::max(v[2].x + v[1].x, v[0].x - v[2].x));
        },
        FUNCTION(primitive, round_cone)));
    make_convex(t.back(), FUNCTION(slope, round_cone_along));
    t.push_back(make_primitive(
        K::hexagonal_prism, "hexagonal_prism", "Hexagonal prism", "A regular hexagon in the xz plane, with height",
        true,
        {length("inradius", "From the axis to the middle of a side", 0.45f),
         length("half_height", "Half the height", 0.4f)},
        [](Values v) {
            return within({1.1547006f * v[0].x, v[1].x, v[0].x});
        },
        FUNCTION(primitive, hexagonal_prism)));
    t.push_back(make_primitive(
        K::triangular_prism, "triangular_prism", "Triangular prism",
        "An equilateral triangle in the xz plane, with height", true,
        {length("inradius", "From the axis to the middle of a side", 0.3f),
         length("half_height", "Half the height", 0.4f)},
        [](Values v) {
            return within({1.7320509f * v[0].x, v[1].x, 2.0f * v[0].x}, xy);
        },
        FUNCTION(primitive, triangular_prism)));
    t.push_back(make_primitive(
        K::solid_angle, "solid_angle", "Solid angle", "The part of a ball within a cone, tip down", true,
        {length("radius", "Radius of the ball", 0.7f), angle("angle", "Opening angle of the cone", 80.0f)},
        [](Values v) { return turned(v[0].x, glm::min(v[0].x * std::cos(0.5f * v[1].x), 0.0f), v[0].x); },
        FUNCTION(primitive, solid_angle)));
    t.push_back(make_primitive(
        K::cut_sphere, "cut_sphere", "Cut sphere", "The part of a ball above a plane", true,
        {length("radius", "Radius of the ball", 0.5f),
         length("cut_height", "Height of the cut above the centre", -0.1f, -largest_value)},
        [](Values v) { return cut_ball(v[0].x, v[1].x, true); }, FUNCTION(primitive, cut_sphere)));
    t.push_back(make_primitive(
        K::cut_hollow_sphere, "cut_hollow_sphere", "Cut hollow sphere",
        "A hollow ball, open above a plane, with a round rim", true,
        {length("radius", "Radius at the middle of the wall", 0.5f),
         length("cut_height", "Height of the cut above the centre", 0.1f, -largest_value),
         length("thickness", "Thickness of the wall", 0.08f)},
        [](Values v) {
            return Extent{cut_ball(v[0].x, v[1].x, false).box.grown(0.5f * v[2].x), xz};
        },
        FUNCTION(primitive, cut_hollow_sphere)));
    t.push_back(make_primitive(
        K::death_star, "death_star", "Death star", "A ball with a round hollow on top", true,
        {length("radius", "Radius of the ball", 0.5f),
         length("carving_radius", "Radius of the ball that is carved away", 0.35f),
         length("offset", "Height of the carved ball's centre", 0.6f)},
        [](Values v) { return turned(v[0].x, -v[0].x, v[0].x); }, FUNCTION(primitive, death_star)));
    t.push_back(make_primitive(
        K::vesica, "vesica", "Vesica", "A lens-shaped spindle along y with pointed ends", true,
        {length("radius", "Radius in the middle, at most half height", 0.25f),
         length("half_height", "From the middle to a tip", 0.5f)},
        [](Values v) {
            return within({glm::min(v[0].x, v[1].x), v[1].x, glm::min(v[0].x, v[1].x)});
        },
        FUNCTION(primitive, vesica)));
    t.push_back(make_primitive(
        K::rhombus, "rhombus", "Rhombus", "A rhombus in the xz plane, with height", true,
        {length("half_length", "Half the diagonal along x", 0.5f),
         length("half_width", "Half the diagonal along z", 0.3f), length("half_height", "Half the height", 0.15f)},
        [](Values v) {
            return within({v[0].x, v[2].x, v[1].x});
        },
        FUNCTION(primitive, rhombus)));
    t.push_back(make_primitive(
        K::octahedron, "octahedron", "Octahedron", "A regular octahedron, corners on the axes", true,
        {length("radius", "From the centre to a corner", 0.6f)}, [](Values v) { return within(glm::vec3(v[0].x)); },
        FUNCTION(primitive, octahedron)));
    t.push_back(make_primitive(
        K::pyramid, "pyramid", "Pyramid", "A square base and a tip above it", true,
        {length("half_width", "Half the edge length of the base", 0.5f),
         length("half_height", "Half the height", 0.4f)},
        [](Values v) { return turned(v[0].x, -v[1].x, v[1].x); }, FUNCTION(primitive, pyramid)));
    t.push_back(make_primitive(
        K::ellipsoid, "ellipsoid", "Ellipsoid", "A sphere stretched along the axes", false,
        {lengths("radii", "Half the lengths along x, y and z", 0.5f, 1e-3f)}, [](Values v) { return within(v[0]); },
        FUNCTION(primitive, ellipsoid)));
    make_convex(t.back(), FUNCTION(slope, ellipsoid_along));
    make_crossed(t.back(), FUNCTION(slope, ellipsoid_span));
    t.push_back(make_profile(
        K::circle, "circle", "Circle", "A profile: all points within a radius of the z axis",
        {length("radius", "Radius", 0.5f)},
        [](Values v) {
            return within({v[0].x, v[0].x, unbounded});
        },
        FUNCTION(primitive, circle)));
    t.push_back(make_profile(
        K::rectangle, "rectangle", "Rectangle", "A profile: a rectangle, without end along z",
        {length("half_width", "Half the length along x", 0.5f), length("half_height", "Half the length along y", 0.3f)},
        [](Values v) {
            return within({v[0].x, v[1].x, unbounded});
        },
        FUNCTION(primitive, rectangle)));
    t.push_back(make_profile(
        K::rounded_rectangle, "rounded_rectangle", "Rounded rectangle",
        "A profile: a rectangle with rounded corners, without end along z",
        {length("half_width", "Half the length along x, rounding included", 0.5f),
         length("half_height", "Half the length along y, rounding included", 0.3f),
         length("radius", "Radius of the corners, at most the smaller half size", 0.1f)},
        [](Values v) {
            return within({v[0].x, v[1].x, unbounded});
        },
        FUNCTION(primitive, rounded_rectangle)));
    t.push_back(make_profile(
        K::polygon, "polygon", "Polygon", "A profile: a regular polygon with a corner on +y, without end along z",
        {whole("sides", "Number of sides", 5.0f, 3.0f), length("radius", "From the centre to a corner", 0.5f)},
        [](Values v) {
            return within({v[1].x, v[1].x, unbounded}, {true, is_even(v[0].x), true});
        },
        FUNCTION(primitive, polygon)));
    t.push_back(make_profile(
        K::star, "star", "Star", "A profile: a star with a point on +y, without end along z",
        {whole("points", "Number of points", 5.0f, 2.0f), length("outer_radius", "From the centre to a point", 0.5f),
         length("inner_radius", "From the centre to a corner between two points", 0.22f)},
        [](Values v) {
            return within({glm::max(v[1].x, v[2].x), glm::max(v[1].x, v[2].x), unbounded},
                          {true, is_even(v[0].x), true});
        },
        FUNCTION(primitive, star)));
    t.push_back(make_profile(
        K::ring, "ring", "Ring", "A profile: a ring or an arc of it, without end along z",
        {length("radius", "From the centre to the middle of the band", 0.4f),
         length("thickness", "Width of the band, at most twice the radius", 0.2f),
         angle("angle", "How much of the ring is there, half on either side of the y axis", 360.0f)},
        [](Values v) { return ring_extent(v[0].x, v[1].x, v[2].x); }, FUNCTION(primitive, ring)));
    t.push_back(make_primitive(
        K::menger_sponge, "menger_sponge", "Menger sponge",
        "A cube with square holes through it, and through what is left", false,
        {length("half_size", "Half the edge length", 0.5f),
         {"iterations",
          "How often holes are made",
          ParameterType::integer,
          Unit::none,
          0.0f,
          6.0f,
          {3.0f, 0.0f, 0.0f}}},
        [](Values v) { return within(glm::vec3(v[0].x)); }, FUNCTION(primitive, menger_sponge)));
    t.back().turns = [](Values v) { return v[1].x; };
    t.push_back(make_primitive(
        K::mandelbulb, "mandelbulb", "Mandelbulb",
        "What stays bounded when points are raised to a power again and again", false,
        {length("radius", "Radius of the ball that holds it", 0.6f),
         {"power", "Power", ParameterType::integer, Unit::none, 2.0f, 16.0f, {8.0f, 0.0f, 0.0f}},
         {"iterations",
          "How often; more show finer detail",
          ParameterType::integer,
          Unit::none,
          1.0f,
          16.0f,
          {6.0f, 0.0f, 0.0f}}},
        [](Values v) {
            return within(glm::vec3(v[0].x), {true, !is_even(v[1].x), !is_even(v[1].x)});
        },
        FUNCTION(primitive, mandelbulb)));
    t.back().turns = [](Values v) { return v[2].x; };
    t.push_back(make_primitive(
        K::custom, "custom", "Custom code", "A distance function of your own, in GLSL; its uniforms become sliders",
        false, {lengths("bounds", "Half size of the box that holds it; 0 has no end along that axis", 1.0f)},
        [](Values v) {
            const glm::vec3 half = shapes::custom_reach(v[0]);
            return Extent{{-half, half}, {}};
        },
        nullptr, nullptr));
}

}  // namespace farfield
