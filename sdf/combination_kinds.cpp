// Combinations of the table; their functions are in operations.glsl.
#include "sdf/kind_table.h"

namespace farfield {
namespace {

/// Parameters of the profiled combinations.
const Parameter blend = length("radius", "Width of the smooth blend; 0 gives a hard edge", 0.0f);
const Parameter profile = length("radius", "How far from the edge the profile begins", 0.1f);
const Parameter steps = whole("steps", "Number of steps", 3.0f);
const Parameter columns = whole("columns", "Number of columns", 3.0f);

/// GLSL of a combination of the distances {0} and {1} when all of its parameters are 0; see KindInfo.
struct Hard {
    const char* when_zero;
    const char* second_shows;
    Gather gather;
};
constexpr Hard hard_union{"min({0}, {1})", "{1} < {0}", Gather::any};
constexpr Hard hard_intersect{"max({0}, {1})", "{1} > {0}", Gather::all};
constexpr Hard hard_subtract{"max({0}, -{1})", "-{1} > {0}", Gather::first};
constexpr Hard never_hard(Gather gather) { return {nullptr, nullptr, gather}; }

// How far combinations reach beyond their children: the most that a profile fills.
float quarter_radius(Values v) { return 0.25f * v[0].x; }

KindInfo make_combination(NodeKind kind, const char* key, const char* label, const char* tip, bool exact,
                          std::vector<Parameter> parameters, const char* function,
                          float (*evaluate)(float, float, Values), const char* weight,
                          float (*evaluate_weight)(float, float, Values), Hard hard, float (*reach)(Values) = nullptr) {
    KindInfo k{};
    k.kind = kind, k.key = key, k.label = label, k.tip = tip, k.role = Role::combine, k.exact = exact;
    k.parameters = std::move(parameters), k.function = function, k.combine = evaluate, k.secondary = weight;
    k.weight = evaluate_weight, k.when_zero = hard.when_zero, k.second_shows = hard.second_shows;
    k.gather = hard.gather, k.reach = reach;
    return k;
}

}  // namespace

void add_combinations(std::vector<KindInfo>& t) {
    using K = NodeKind;
    t.push_back(make_combination(K::union_, "union", "Union", "All of the children together, smooth with a radius",
                                 true, {blend}, FUNCTION(combine, smooth_union), FUNCTION(combine, union_weight),
                                 hard_union, quarter_radius));
    t.push_back(make_combination(
        K::intersect, "intersect", "Intersect", "What all children have in common, smooth with a radius", false,
        {blend}, FUNCTION(combine, smooth_intersect), FUNCTION(combine, intersect_weight), hard_intersect));
    t.push_back(make_combination(
        K::subtract, "subtract", "Subtract", "The first child without the others, smooth with a radius", false, {blend},
        FUNCTION(combine, smooth_subtract), FUNCTION(combine, subtract_weight), hard_subtract));
    t.push_back(make_combination(K::xor_, "xor", "Exclusive or", "What belongs to an odd number of children", false, {},
                                 FUNCTION(combine, exclusive_or), FUNCTION(combine, exclusive_or_weight),
                                 never_hard(Gather::any)));
    t.push_back(make_combination(K::chamfer_union, "chamfer_union", "Chamfer union",
                                 "All of the children together, bevelled where they meet", false, {profile},
                                 FUNCTION(combine, chamfer_union), FUNCTION(combine, union_weight), hard_union,
                                 first_parameter));
    t.push_back(make_combination(K::chamfer_intersect, "chamfer_intersect", "Chamfer intersect",
                                 "What all children have in common, bevelled where they meet", false, {profile},
                                 FUNCTION(combine, chamfer_intersect), FUNCTION(combine, intersect_weight),
                                 hard_intersect));
    t.push_back(make_combination(K::chamfer_subtract, "chamfer_subtract", "Chamfer subtract",
                                 "The first child without the others, bevelled where they meet", false, {profile},
                                 FUNCTION(combine, chamfer_subtract), FUNCTION(combine, subtract_weight),
                                 hard_subtract));
    t.push_back(make_combination(K::round_union, "round_union", "Round union",
                                 "All of the children together, rounded by a circle where they meet", false, {profile},
                                 FUNCTION(combine, round_union), FUNCTION(combine, union_weight), hard_union,
                                 first_parameter));
    t.push_back(make_combination(K::round_intersect, "round_intersect", "Round intersect",
                                 "What all children have in common, rounded by a circle where they meet", false,
                                 {profile}, FUNCTION(combine, round_intersect), FUNCTION(combine, intersect_weight),
                                 hard_intersect));
    t.push_back(make_combination(K::round_subtract, "round_subtract", "Round subtract",
                                 "The first child without the others, rounded by a circle where they meet", false,
                                 {profile}, FUNCTION(combine, round_subtract), FUNCTION(combine, subtract_weight),
                                 hard_subtract));
    t.push_back(make_combination(K::stairs_union, "stairs_union", "Stairs union",
                                 "All of the children together, with steps where they meet", false, {profile, steps},
                                 FUNCTION(combine, stairs_union), FUNCTION(combine, stepped_union_weight), hard_union,
                                 first_parameter));
    t.push_back(make_combination(K::stairs_intersect, "stairs_intersect", "Stairs intersect",
                                 "What all children have in common, with steps where they meet", false,
                                 {profile, steps}, FUNCTION(combine, stairs_intersect),
                                 FUNCTION(combine, stepped_intersect_weight), hard_intersect));
    t.push_back(make_combination(K::stairs_subtract, "stairs_subtract", "Stairs subtract",
                                 "The first child without the others, with steps where they meet", false,
                                 {profile, steps}, FUNCTION(combine, stairs_subtract),
                                 FUNCTION(combine, stepped_subtract_weight), hard_subtract));
    t.push_back(make_combination(K::columns_union, "columns_union", "Columns union",
                                 "All of the children together, with columns where they meet", false,
                                 {profile, columns}, FUNCTION(combine, columns_union),
                                 FUNCTION(combine, stepped_union_weight), hard_union, first_parameter));
    t.push_back(make_combination(K::columns_intersect, "columns_intersect", "Columns intersect",
                                 "What all children have in common, with columns where they meet", false,
                                 {profile, columns}, FUNCTION(combine, columns_intersect),
                                 FUNCTION(combine, stepped_intersect_weight), hard_intersect));
    t.push_back(make_combination(K::columns_subtract, "columns_subtract", "Columns subtract",
                                 "The first child without the others, with columns where they meet", false,
                                 {profile, columns}, FUNCTION(combine, columns_subtract),
                                 FUNCTION(combine, stepped_subtract_weight), hard_subtract));
    t.push_back(make_combination(K::pipe, "pipe", "Pipe", "A tube along the curve in which the surfaces meet", false,
                                 {length("radius", "Radius of the tube", 0.05f)}, FUNCTION(combine, pipe),
                                 FUNCTION(combine, pipe_weight), never_hard(Gather::all), first_parameter));
    t.push_back(make_combination(
        K::engrave, "engrave", "Engrave", "The first child with a V-shaped notch where the others' surfaces meet it",
        false, {length("depth", "Depth of the notch, and half its width", 0.05f)}, FUNCTION(combine, engrave),
        FUNCTION(combine, engrave_weight), never_hard(Gather::first)));
    t.push_back(make_combination(
        K::groove, "groove", "Groove", "The first child with a channel where the others' surfaces meet it", false,
        {length("depth", "Depth", 0.05f), length("width", "Width", 0.1f)}, FUNCTION(combine, groove),
        FUNCTION(combine, groove_weight), never_hard(Gather::first)));
    t.push_back(make_combination(
        K::tongue, "tongue", "Tongue", "The first child with a ridge where the others' surfaces meet it", false,
        {length("height", "Height", 0.05f), length("width", "Width", 0.1f)}, FUNCTION(combine, tongue),
        FUNCTION(combine, tongue_weight), never_hard(Gather::first), first_parameter));

    t.push_back(make_combination(
        K::morph, "morph", "Morph", "Something between the children", false,
        {{"amount", "0 shows the first child, 1 the second", number, Unit::none, 0.0f, 1.0f, {0.5f, 0.0f, 0.0f}}},
        FUNCTION(combine, morph), FUNCTION(combine, morph_weight), never_hard(Gather::any)));
    t.back().warnings = [](const Extent&, std::size_t shapes, Values) {
        if (shapes == 2) return Warnings{};
        return Warnings{
            fmt::format("a morph is between two shapes, and there {} {} in it", shapes == 1 ? "is" : "are", shapes)};
    };
}

}  // namespace farfield
