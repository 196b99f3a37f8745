// Operations on space and on the distance; their functions are in operations.glsl.
#include "sdf/audit.h"
#include "sdf/kind_table.h"

namespace farfield {
namespace {

glm::vec3 repeat(glm::vec3 p, Values v, int cell) { return shapes::repeat(p, v[0], v[1], v[2], v[3], cell); }
int repeat_cells(Values v) { return shapes::repeat_cells(v[0], v[1], v[2], v[3]); }

// What modifiers make of their content's bounds, and what they derive from them.
Extent mirror_image(const Extent& content, Values v) {
    Extent image = content;
    for (int axis = 0; axis < 3; ++axis)
        if (v[0][axis] > 0.5f) {
            image.box.high[axis] = std::max(content.box.high[axis], 0.0f);
            image.box.low[axis] = -image.box.high[axis];
            image.symmetric[axis] = true;
        }
    return image;
}

Extent repeat_image(const Extent& content, Values v) {
    Extent image = content;
    for (int axis = 0; axis < 3; ++axis) {
        if (v[0][axis] <= 0.0f || v[1][axis] == 1.0f) continue;
        const float to_last = v[1][axis] > 0.0f ? 0.5f * (v[1][axis] - 1.0f) * v[0][axis] : unbounded;
        image.box.low[axis] -= to_last;
        image.box.high[axis] += to_last;
    }
    image.box = image.box.valid();
    return image;
}

constexpr float most_cells = 16.0f;    // of content that wide; what copies beyond would show is cut off
constexpr float endless_cells = 3.0f;  // of content without end that is not the same all along: likewise

/// How many copies along one axis can hold the nearest point; see derive_repeat.
float wanted_copies(const Extent& content, Values v, int axis) {
    const float spacing = v[0][axis], count = v[1][axis], width = content.box.size()[axis];
    if (spacing <= 0.0f || count == 1.0f || content.constant[axis]) return 1.0f;
    if (content.symmetric[axis] && width <= spacing) return 1.0f;
    const float wanted = content.box.is_bounded(axis) ? 1.0f + std::ceil(width / spacing) : unbounded;
    return count > 0.0f ? std::min(wanted, count) : wanted;
}

// Of content that is `width` wide, each point has its nearest copy among the 1 + ceil(width / spacing) copies whose
// middles are nearest: a copy further off is at least its half width further than one between. Content that fits into
// its cell and is its own mirror image needs one: the planes between cells are mirrors, and what lies beyond is as far
// or further. Where that would be too many, the content is cut off to be as wide as those that are looked at allow.
void derive_repeat(const Extent& content, Values v, std::span<glm::vec3> derived) {
    for (int axis = 0; axis < 3; ++axis) {
        const float wanted = wanted_copies(content, v, axis), low = content.box.low[axis],
                    high = content.box.high[axis];
        const bool bounded = content.box.is_bounded(axis);
        derived[0][axis] = wanted <= most_cells ? wanted : bounded ? most_cells : endless_cells;
        derived[1][axis] = wanted == 1.0f        ? 0.0f
                           : bounded             ? content.box.centre()[axis]
                           : !is_unbounded(low)  ? low
                           : !is_unbounded(high) ? high
                                                 : 0.0f;
    }
}

/// How far a box reaches from the axis that is neither of these two.
float reach(const Box& box, int first, int second) {
    const glm::vec3 far = glm::max(glm::abs(box.low), glm::abs(box.high));
    return std::min(glm::length(glm::vec2(far[first], far[second])), unbounded);
}

/// All that content can fill when it turns about the y axis.
Extent around_y(const Extent& content) {
    const float r = reach(content.box, 0, 2);
    return {{{-r, content.box.low.y, -r}, {r, content.box.high.y, r}}, {}};
}

Extent without_symmetry(const Extent& content, Values) { return {content.box, {}}; }

/// Least and largest width of tapered content.
glm::vec2 widths(const Box& content, float rate) {
    const float a = shapes::taper_width(content.low.y, rate), b = shapes::taper_width(content.high.y, rate);
    return {std::min(a, b), std::max(a, b)};
}

glm::vec3 polar_repeat(glm::vec3 p, Values v, int cell) {
    return shapes::polar_repeat(p, v[0].x, v[1].x, v[2].x, v[3].x, cell);
}

constexpr float full_turn = 6.2831853f;

struct Sweep {
    float width, centre;  ///< angle, and its middle
    float inner;          ///< least distance from the axis
};

/// What a box takes up about the y axis.
Sweep sweep(const Box& box) {
    float width = full_turn, centre = 0.0f, inner = 0.0f;
    const bool holds_axis = box.low.x <= 0.0f && box.high.x >= 0.0f && box.low.z <= 0.0f && box.high.z >= 0.0f;
    if (!holds_axis && box.is_bounded(0) && box.is_bounded(2)) {
        const glm::vec3 middle = box.centre();
        centre = std::atan2(middle.z, middle.x);
        float most = 0.0f;  // the box is on one side of the axis: each corner is within half a turn of its middle
        for (const float x : {box.low.x, box.high.x})
            for (const float z : {box.low.z, box.high.z})
                most = std::max(most, std::abs(std::remainder(std::atan2(z, x) - centre, full_turn)));
        width = 2.0f * most;
        const float x = std::max({box.low.x, -box.high.x, 0.0f}), z = std::max({box.low.z, -box.high.z, 0.0f});
        inner = glm::length(glm::vec2(x, z));
    }
    return {width, centre, inner};
}

// As derive_repeat, with angles: the distance to a turned copy grows with the angle between it and p.
void derive_polar_repeat(const Extent& content, Values v, std::span<glm::vec3> derived) {
    const float count = v[0].x, sector = full_turn / count;
    const auto [width, centre, inner] = sweep(content.box);
    const bool one = content.symmetric[2] && centre == 0.0f && width <= sector;
    derived[0].x = one ? 1.0f : std::min({1.0f + std::ceil(width / sector), most_cells, count});
    derived[1].x = centre;
    derived[2].x = inner;
}

std::string overlap_warning(float copies) {
    return fmt::format(
        "its content is so wide that {:.0f} copies lie over one another; it is cut off where more than "
        "{:.0f} do",
        copies, most_cells);
}

/// There are some exactly where copies are cut off.
Warnings repeat_warnings(const Extent& content, std::size_t, Values v) {
    Warnings found;
    for (int axis = 0; axis < 3; ++axis) {
        const float wanted = wanted_copies(content, v, axis);
        if (wanted <= most_cells) continue;
        const std::string along = fmt::format("along {} ", "xyz"[axis]);
        if (content.box.is_bounded(axis))
            found.push_back(along + overlap_warning(wanted));
        else
            found.push_back(along + "its content has no end: copies are cut off one spacing from their middle");
    }
    return found;
}

Warnings polar_repeat_warnings(const Extent& content, std::size_t, Values v) {
    const float count = v[0].x,
                wanted = std::min(1.0f + std::ceil(sweep(content.box).width * count / full_turn), count);
    return wanted <= most_cells ? Warnings{} : Warnings{overlap_warning(wanted)};
}

Warnings mirror_warnings(const Extent& content, std::size_t, Values v) {
    Warnings found;
    for (int axis = 0; axis < 3; ++axis)  // a box has a margin of 1e-5 of its coordinates
        if (v[0][axis] > 0.5f && content.box.high[axis] <= -1e-4f * content.box.low[axis])
            found.push_back(
                fmt::format("its content lies on the negative side of {} alone and never shows: the "
                            "positive side is mirrored",
                            "xyz"[axis]));
    return found;
}

Warnings flat_warnings(const Extent& content, std::size_t, Values) {
    const float low = content.box.low.z, high = content.box.high.z;
    if (low <= 0.0f && high >= 0.0f) return {};
    return {
        fmt::format("its content lies between z = {:.3g} and {:.3g} m and has no cross-section at z = 0, which is "
                    "what shows",
                    low, high)};
}

Warnings shell_warnings(const Extent&, std::size_t, Values v) {
    if (v[0].x >= thinnest_skin) return {};
    return {fmt::format("a skin of {:.3g} m is thinner than rays can see; at least {:g} m", v[0].x, thinnest_skin)};
}

/// "twist: 110 °/m at up to 0.42 m from the axis".
std::string turned_text(const char* kind, float rate, float from_axis) {
    const std::string text = fmt::format("{}: {:.3g} °/m", kind, std::abs(glm::degrees(rate)));
    if (is_unbounded(from_axis)) return text + ", and its content has no end away from the axis";
    return text + fmt::format(" at up to {:.3g} m from the axis, from the bounds of its content", from_axis);
}

KindInfo make_modifier(NodeKind kind, const char* key, const char* label, const char* tip, Role role, bool exact,
                       std::vector<Parameter> parameters, const char* function) {
    KindInfo k{};
    k.kind = kind, k.key = key, k.label = label, k.tip = tip, k.role = role, k.exact = exact;
    k.parameters = std::move(parameters), k.function = function;
    return k;
}

}  // namespace

void add_modifiers(std::vector<KindInfo>& t) {
    using K = NodeKind;
    KindInfo mirror = make_modifier(
        K::mirror, "mirror", "Mirror", "Shows the content of the positive side on both sides", Role::domain, true,
        {{"axes", "Axes to mirror along", ParameterType::flags, Unit::none, 0.0f, 1.0f, {1.0f, 0.0f, 0.0f}},
         length("seam", "How far from the middle the crease is rounded; 0 keeps it sharp", 0.0f)},
        "mirror");
    mirror.domain = domain<shapes::mirror>;
    mirror.image = mirror_image;
    mirror.warnings = mirror_warnings;
    mirror.way = "mirrored_way";
    mirror.direction = "mirrored_direction";
    mirror.straight = [](Values v) { return v[1].x == 0.0f; };
    t.push_back(mirror);

    KindInfo elongate =
        make_modifier(K::elongate, "elongate", "Elongate", "Pulls the content apart at its origin", Role::domain, false,
                      {lengths("half_size", "How far to either side", 0.0f)}, "elongate");
    elongate.parameters[0].initial = {0.25f, 0.0f, 0.0f};
    elongate.domain = domain<shapes::elongate>;
    elongate.image = [](const Extent& content, Values v) {
        return Extent{Box{content.box.low - v[0], content.box.high + v[0]}.valid(), content.symmetric};
    };
    t.push_back(elongate);

    KindInfo repeat_kind =
        make_modifier(K::repeat, "repeat", "Repeat", "Copies of the content at even spacing; it must fit into its cell",
                      Role::repeat, true,
                      {{"spacing",
                        "Distance between copies; 0 does not repeat along that axis",
                        vector,
                        metres,
                        0.0f,
                        largest_value,
                        {1.0f, 0.0f, 0.0f}},
                       {"count",
                        "Number of copies, centred; 0 repeats without end",
                        ParameterType::count,
                        Unit::none,
                        0.0f,
                        1e5f,
                        {3.0f, 0.0f, 0.0f}}},
                      "repeat");
    repeat_kind.domain = repeat;
    repeat_kind.cells = repeat_cells;
    repeat_kind.image = repeat_image;
    repeat_kind.function_takes_derived = true;
    repeat_kind.derived = {{"cells", "Copies along each axis that can be nearest", ParameterType::count},
                           {"centre", "Middle of one copy", vector, metres}};
    repeat_kind.derive = derive_repeat;
    repeat_kind.warnings = repeat_warnings;
    repeat_kind.way = "repeated_way";
    repeat_kind.straight = [](Values) { return true; };
    repeat_kind.secondary = "repeat_cells";
    repeat_kind.guard_copy = "repeat_copy";
    repeat_kind.guarded_copy = [](float d, glm::vec3 p, Values v, const Box& region) {
        return shapes::repeat_copy(d, p, v[0], v[1], v[2], v[3], region.low, region.high);
    };
    repeat_kind.guard_nearest = "repeat_distance";
    repeat_kind.guarded_nearest = [](float d, glm::vec3 p, Values v, const Box& region) {
        return shapes::repeat_distance(d, p, v[0], v[1], v[2], v[3], region.low, region.high);
    };
    t.push_back(repeat_kind);

    KindInfo polar =
        make_modifier(K::polar_repeat, "polar_repeat", "Polar repeat", "Copies of the content turned about the y axis",
                      Role::repeat, true, {whole("count", "Number of copies in a full turn", 6.0f)}, "polar_repeat");
    polar.domain = polar_repeat;
    polar.cells = [](Values v) { return shapes::polar_repeat_cells(v[0].x, v[1].x, v[2].x, v[3].x); };
    polar.secondary = "polar_repeat_cells";
    polar.guard_copy = "polar_repeat_copy";
    polar.guarded_copy = [](float d, glm::vec3 p, Values v, const Box& region) {
        return shapes::polar_repeat_copy(d, p, v[0].x, v[1].x, v[2].x, v[3].x, region.low, region.high);
    };
    polar.guard_nearest = "polar_repeat_distance";
    polar.guarded_nearest = [](float d, glm::vec3 p, Values v, const Box& region) {
        return shapes::polar_repeat_distance(d, p, v[0].x, v[1].x, v[2].x, v[3].x, region.low, region.high);
    };
    polar.image = [](const Extent& content, Values) { return around_y(content); };
    polar.function_takes_derived = true;
    polar.derived = {{"cells", "Copies that can be nearest", number},
                     {"centre", "Angle at which one copy has its middle", number},
                     {"inner", "How far the content is from the axis", number, metres}};
    polar.derive = derive_polar_repeat;
    polar.warnings = polar_repeat_warnings;
    t.push_back(polar);

    KindInfo twist = make_modifier(K::twist, "twist", "Twist", "Turns the content about the y axis as it goes up",
                                   Role::domain, false, {rate("Turn for each metre of height", 90.0f)}, "twist");
    twist.domain = domain<shapes::twist>;
    twist.secondary = "twist_distance";
    twist.distance = safe_distance<shapes::twist_distance>;
    twist.image = [](const Extent& content, Values) { return around_y(content); };
    twist.derived = {{"reach", "How far the content reaches from the axis", number, metres}};
    twist.derive = [](const Extent& content, Values, std::span<glm::vec3> derived) {
        derived[0].x = reach(content.box, 0, 2);
    };
    twist.stretch = [](Values v) { return shapes::twist_stretch(v[0].x, v[1].x); };
    twist.explain = [](Values v) { return turned_text("twist", v[0].x, v[1].x); };
    twist.confined = true;
    t.push_back(twist);

    KindInfo bend =
        make_modifier(K::bend, "bend", "Bend", "Bends what lies along the x axis, up where the rate is positive",
                      Role::domain, false, {rate("Turn for each metre along x", 45.0f)}, "bend");
    bend.domain = domain<shapes::bend>;
    bend.secondary = "bend_distance";
    bend.distance = safe_distance<shapes::bend_distance>;
    bend.image = [](const Extent& content, Values) {
        const float r = reach(content.box, 0, 1);
        return Extent{{{-r, -r, content.box.low.z}, {r, r, content.box.high.z}}, {false, false, content.symmetric[2]}};
    };
    bend.derived = {{"reach", "How far the content reaches from the axis", number, metres}};
    bend.derive = [](const Extent& content, Values, std::span<glm::vec3> derived) {
        derived[0].x = reach(content.box, 0, 1);
    };
    bend.stretch = [](Values v) { return shapes::bend_stretch(v[0].x, v[1].x); };
    bend.explain = [](Values v) { return turned_text("bend", v[0].x, v[1].x); };
    bend.confined = true;
    t.push_back(bend);

    KindInfo taper = make_modifier(K::taper, "taper", "Taper", "Makes the content wider or narrower as it goes up",
                                   Role::domain, false,
                                   {{"rate",
                                     "Width gained for each metre of height; from 0.05 to 20 times the width at 0",
                                     number,
                                     Unit::per_metre,
                                     -1000.0f,
                                     1000.0f,
                                     {-0.5f, 0.0f, 0.0f}}},
                                   "taper");
    taper.domain = domain<shapes::taper>;
    taper.secondary = "taper_distance";
    taper.distance = safe_distance<shapes::taper_distance>;
    taper.image = [](const Extent& content, Values v) {
        const float widest = widths(content.box, v[0].x).y;
        Extent image{content.box, {content.symmetric[0], false, content.symmetric[2]}};
        for (const int axis : {0, 2}) {
            image.box.low[axis] *= content.box.low[axis] < 0.0f ? widest : 1.0f;
            image.box.high[axis] *= content.box.high[axis] > 0.0f ? widest : 1.0f;
        }
        image.box = image.box.valid();
        return image;
    };
    taper.function_takes_derived = true;
    taper.derived = {{"narrowest", "Least width along the content's height", number},
                     {"reach", "How far the content reaches from the axis", number, metres}};
    taper.derive = [](const Extent& content, Values v, std::span<glm::vec3> derived) {
        const glm::vec2 range = widths(content.box, v[0].x);
        derived[0].x = range.x;
        derived[1].x = reach(content.box, 0, 2);
    };
    taper.stretch = [](Values v) { return shapes::taper_stretch(v[0].x, v[1].x, v[2].x); };
    taper.explain = [](Values v) {
        const std::string text = fmt::format("taper: {:.3g} times the width where narrowest", v[1].x);
        if (is_unbounded(v[2].x)) return text + ", and its content has no end away from the axis";
        return text + fmt::format(", {:.3g} /m at up to {:.3g} m from the axis, from the bounds of its content", v[0].x,
                                  v[2].x);
    };
    taper.confined = true;
    t.push_back(taper);

    KindInfo stretch = make_modifier(
        K::stretch, "stretch", "Stretch", "Scales each axis by a factor of its own", Role::domain, false,
        {{"factors", "Factors along x, y and z", vector, Unit::none, 1e-3f, 1e3f, {1.0f, 1.5f, 1.0f}}}, "stretch");
    stretch.domain = domain<shapes::stretch>;
    stretch.secondary = "stretch_distance";
    stretch.distance = safe_distance<shapes::stretch_distance>;
    stretch.image = [](const Extent& content, Values v) {
        return Extent{Box{content.box.low * v[0], content.box.high * v[0]}.valid(), content.symmetric};
    };
    stretch.stretch = [](Values v) { return 1.0f / glm::min(v[0].x, glm::min(v[0].y, v[0].z)); };
    stretch.explain = [](Values v) {
        return fmt::format("stretch: 1 / the smallest factor {:.3g}", glm::min(v[0].x, glm::min(v[0].y, v[0].z)));
    };
    stretch.confined = true;
    t.push_back(stretch);

    KindInfo extrude = make_modifier(K::extrude, "extrude", "Extrude",
                                     "A body with the content's cross-section at z = 0, along z", Role::domain, true,
                                     {length("half_height", "Half the length along z", 0.25f),
                                      length("radius", "Radius of the edges at the ends, at most half height", 0.0f)},
                                     "extrude");
    extrude.domain = domain<shapes::extrude>;
    extrude.secondary = "extrude_distance";
    extrude.distance = safe_distance<shapes::extrude_distance>;
    extrude.flat = true;
    extrude.warnings = flat_warnings;
    extrude.image = [](const Extent& content, Values v) {
        Extent image{content.box, {content.symmetric[0], content.symmetric[1], true}};
        image.box.low.z = -v[0].x, image.box.high.z = v[0].x;
        return image;
    };
    t.push_back(extrude);

    KindInfo revolve = make_modifier(
        K::revolve, "revolve", "Revolve", "Turns the content's cross-section at z = 0 about the y axis", Role::domain,
        true, {length("offset", "How far the content is moved out along x before", 0.5f)}, "revolve");
    revolve.domain = domain<shapes::revolve>;
    revolve.flat = true;
    revolve.warnings = flat_warnings;
    revolve.image = [](const Extent& content, Values v) {
        const float r = glm::clamp(content.box.high.x + v[0].x, 0.0f, unbounded);
        return Extent{{{-r, content.box.low.y, -r}, {r, content.box.high.y, r}}, {true, content.symmetric[1], true}};
    };
    t.push_back(revolve);

    KindInfo shell = make_modifier(K::shell, "shell", "Shell", "Hollows the content to a skin", Role::distance, true,
                                   {length("thickness", "Thickness of the skin, half on either side", 0.05f)}, "shell");
    shell.distance = modify<shapes::shell>;
    shell.warnings = shell_warnings;
    shell.reach = [](Values v) { return 0.5f * v[0].x; };
    t.push_back(shell);

    KindInfo round = make_modifier(K::round, "round", "Round", "Grows the content and rounds its edges", Role::distance,
                                   true, {length("radius", "How far the surface moves out", 0.05f)}, "inflate");
    round.distance = modify<shapes::inflate>;
    round.reach = first_parameter;
    t.push_back(round);

    const Parameter amplitude = length("amplitude", "How far the surface moves at most", 0.05f);
    KindInfo sine = make_modifier(
        K::displace_sine, "displace_sine", "Sine waves", "Raises and lowers the surface in waves", Role::domain, false,
        {amplitude, length("wavelength", "From one crest to the next", 0.25f, 1e-4f)}, nullptr);
    sine.secondary = "displace_sine";
    sine.distance = safe_distance<shapes::displace_sine>;
    sine.reach = first_parameter;
    sine.image = without_symmetry;
    sine.stretch = [](Values v) { return 1.0f + 6.2831853f * v[0].x / v[1].x; };
    sine.explain = [](Values v) {
        return fmt::format("sine waves: 1 + 2 pi times the amplitude {:.3g} / the wavelength {:.3g}", v[0].x, v[1].x);
    };
    t.push_back(sine);

    KindInfo noise =
        make_modifier(K::displace_noise, "displace_noise", "Noise", "Roughens the surface", Role::domain, false,
                      {amplitude,
                       length("size", "Size of the largest bumps", 0.25f, 1e-4f),
                       {"octaves", "How often finer bumps are added", ParameterType::integer, Unit::none, 1.0f, 8.0f,
                        glm::vec3(3.0f, 0.0f, 0.0f)}},
                      nullptr);
    noise.secondary = "displace_noise";
    noise.distance = safe_distance<shapes::displace_noise>;
    noise.image = without_symmetry;
    noise.reach = [](Values v) { return 2.0f * v[0].x; };
    noise.stretch = [](Values v) { return 1.0f + 3.75f * v[2].x * v[0].x / v[1].x; };
    noise.turns = [](Values v) { return v[2].x; };
    noise.explain = [](Values v) {
        return fmt::format("noise: 1 + 3.75 times {:.0f} {} of the amplitude {:.3g} / the size {:.3g}", v[2].x,
                           v[2].x == 1.0f ? "octave" : "octaves", v[0].x, v[1].x);
    };
    t.push_back(noise);

    t.push_back(make_modifier(K::instance, "instance", "Instance",
                              "A definition, shown here as if it were copied; materials that it leaves open are the "
                              "instance's",
                              Role::instance, true, {}, ""));
}

}  // namespace farfield
