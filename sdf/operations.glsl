// Operations on shapes: combinations, domain, distance, material. The rules of shapes.glsl hold here.

// ---- combinations: quadratic polynomial blends, 1-Lipschitz; radius is the width of |a - b| that is blended ----------

float smooth_union(float a, float b, float radius) {
    float h = max(radius - abs(a - b), 0.0f) / max(radius, 1e-9f);
    return min(a, b) - h * h * radius * 0.25f;
}

float smooth_intersect(float a, float b, float radius) {
    float h = max(radius - abs(a - b), 0.0f) / max(radius, 1e-9f);
    return max(a, b) + h * h * radius * 0.25f;
}

float smooth_subtract(float a, float b, float radius) {
    return smooth_intersect(a, -b, radius);
}

// The fraction of b's material, from 0 to 1 across the blend.
float union_weight(float a, float b, float radius) {
    return clamp(0.5f + 0.5f * (a - b) / max(radius, 1e-9f), 0.0f, 1.0f);
}

float intersect_weight(float a, float b, float radius) {
    return union_weight(b, a, radius);
}

float subtract_weight(float a, float b, float radius) {
    return union_weight(-b, a, radius);
}

// ---- combinations with a profiled edge -------------------------------------------------------------------------------
// The shapes are those of hg_sdf (Mercury, 2011-2016): where the surfaces a = 0 and b = 0 meet, a profile in the plane of
// the two distances (a, b) fills or cuts the edge; it begins at `radius` from either surface. hg_sdf measures the
// Euclidean distance in that plane, sqrt(2) times too far where the surfaces run side by side: one step of length s then
// changes a and b by s both. Here the Chebyshev distance is taken, the largest that is safe; the zero sets are the same.
// Where a profile is a graph over a - b without a slope above 45 degrees, that is min(a, b) minus a term of |a - b| alone.
// All of these are 1-Lipschitz and bounds. intersect(a, b) = -union(-a, -b), subtract(a, b) = intersect(a, -b).

// A straight bevel from a = radius to b = radius.
float chamfer_fill(float difference, float radius) {
    return 0.5f * max(radius - abs(difference), 0.0f);
}

float chamfer_union(float a, float b, float radius) {
    return min(a, b) - chamfer_fill(a - b, radius);
}

float chamfer_intersect(float a, float b, float radius) {
    return max(a, b) + chamfer_fill(a - b, radius);
}

float chamfer_subtract(float a, float b, float radius) {
    return max(a, -b) + chamfer_fill(a + b, radius);
}

// max(|x|, |y|) - circle_reach(|x| - |y|, radius) is the signed Chebyshev distance of (x, y) to a circle around 0: half the
// side of the square around (x, y) that just touches it.
float circle_reach(float difference, float radius) {
    float w = min(abs(difference), radius);
    return 0.5f * (w + sqrt(max(2.0f * radius * radius - w * w, 0.0f)));
}

// A quarter circle that touches both surfaces.
float round_union(float a, float b, float radius) {
    return min(a, b) - (radius - circle_reach(a - b, radius));
}

float round_intersect(float a, float b, float radius) {
    return max(a, b) + (radius - circle_reach(a - b, radius));
}

float round_subtract(float a, float b, float radius) {
    return round_intersect(a, -b, radius);
}

// A flight of this many steps: the bevel with a triangle wave taken off.
float stairs_fill(float difference, float radius, float steps) {
    float tread = max(radius, 1e-9f) / (max(steps, 0.0f) + 1.0f);
    float rest = radius - abs(difference);
    return 0.5f * max(rest - abs(mod(rest + tread, 2.0f * tread) - tread), 0.0f);
}

float stairs_union(float a, float b, float radius, float steps) {
    return min(a, b) - stairs_fill(a - b, radius, steps);
}

float stairs_intersect(float a, float b, float radius, float steps) {
    return max(a, b) + stairs_fill(a - b, radius, steps);
}

float stairs_subtract(float a, float b, float radius, float steps) {
    return max(a, -b) + stairs_fill(a + b, radius, steps);
}

// A bevel with half-round columns side by side on it, within radius: from a corner of the bevel to the rim of the column on
// it is (1 - sqrt(1/2)) of the column's radius, bevel / (sqrt(2) columns). The nearest column is that of the nearest a - b.
float columns_union(float a, float b, float radius, float columns) {
    float n = max(columns, 1.0f);
    float bevel = radius / (1.0f + 0.20710678f / n);
    float column = clamp(floor((a - b + bevel) * 0.5f * n / max(bevel, 1e-9f)), 0.0f, n - 1.0f);
    float difference = bevel * ((2.0f * column + 1.0f) / n - 1.0f);
    float x = a - 0.5f * (bevel + difference);
    float y = b - 0.5f * (bevel - difference);
    float to_column = max(abs(x), abs(y)) - circle_reach(abs(x) - abs(y), 0.70710678f * bevel / n);
    return min(min(min(a, b), 0.5f * (a + b - bevel)), to_column);
}

float columns_intersect(float a, float b, float radius, float columns) {
    return -columns_union(-a, -b, radius, columns);
}

float columns_subtract(float a, float b, float radius, float columns) {
    return -columns_union(-a, b, radius, columns);
}

// As the weights above, for profiles with a number of steps or columns, which does not matter here.
float stepped_union_weight(float a, float b, float radius, float number) {
    return union_weight(a, b, radius);
}

float stepped_intersect_weight(float a, float b, float radius, float number) {
    return intersect_weight(a, b, radius);
}

float stepped_subtract_weight(float a, float b, float radius, float number) {
    return subtract_weight(a, b, radius);
}

// ---- combinations that mark where two surfaces meet; 1-Lipschitz bounds, after hg_sdf -----------------------------------

// What belongs to exactly one of the two.
float exclusive_or(float a, float b) {
    return max(min(a, b), -max(a, b));
}

float exclusive_or_weight(float a, float b) {
    return (a + b >= 0.0f) == (b < a) ? 1.0f : 0.0f;
}

// A tube along the curve in which the surfaces meet, and nothing else.
float pipe(float a, float b, float radius) {
    return max(abs(a), abs(b)) - circle_reach(abs(a) - abs(b), radius);
}

float pipe_weight(float a, float b, float radius) {
    return union_weight(abs(a), abs(b), radius);
}

// A V-shaped notch in a along the surface of b, as wide on either side as it is deep.
float engrave(float a, float b, float depth) {
    return max(a, 0.5f * (a + depth - abs(b)));
}

float engrave_weight(float a, float b, float depth) {
    return depth - abs(b) > a ? 1.0f : 0.0f;
}

// A channel in a along the surface of b.
float groove(float a, float b, float depth, float width) {
    return max(a, min(a + depth, 0.5f * width - abs(b)));
}

float groove_weight(float a, float b, float depth, float width) {
    return min(a + depth, 0.5f * width - abs(b)) > a ? 1.0f : 0.0f;
}

// A ridge on a along the surface of b.
float tongue(float a, float b, float height, float width) {
    return min(a, max(a - height, abs(b) - 0.5f * width));
}

float tongue_weight(float a, float b, float height, float width) {
    return max(a - height, abs(b) - 0.5f * width) < a ? 1.0f : 0.0f;
}

// ---- domain ----------------------------------------------------------------------------------------------------------

// Each axis whose flag is 1 shows the positive side's content on both sides.
vec3 mirror(vec3 p, vec3 axes) {
    return mix(p, abs(p), axes);
}

// One axis of repeat: the coordinate in the frame of the nearest copy, or of the next one on p's side when next is 1.
// Copies stand at multiples of spacing; a positive count limits them and centres the row. No spacing or one copy: as is.
float repeat_axis(float p, float spacing, float count, float next) {
    if (spacing <= 0.0f || count == 1.0f) return p;
    float last = 0.5f * (count - 1.0f);
    float offset = count > 0.0f ? last - floor(last) : 0.0f;
    float cell = floor(p / spacing - offset + 0.5f) + offset;
    cell += next * (p >= cell * spacing ? 1.0f : -1.0f);
    if (count > 0.0f) cell = clamp(cell, -last, last);
    return p - cell * spacing;
}

// How many copies can hold the nearest point: two along each repeated axis, when the content stays in its cell.
int repeat_cells(vec3 spacing, vec3 count) {
    return (spacing.x > 0.0f && count.x != 1.0f ? 2 : 1) * (spacing.y > 0.0f && count.y != 1.0f ? 2 : 1) *
           (spacing.z > 0.0f && count.z != 1.0f ? 2 : 1);
}

// p in the frame of one of those copies, cell < repeat_cells(spacing, count).
vec3 repeat(vec3 p, vec3 spacing, vec3 count, int cell) {
    int x = spacing.x > 0.0f && count.x != 1.0f ? 2 : 1;
    int y = spacing.y > 0.0f && count.y != 1.0f ? 2 : 1;
    return vec3(repeat_axis(p.x, spacing.x, count.x, float(cell % x)),
                repeat_axis(p.y, spacing.y, count.y, float((cell / x) % y)),
                repeat_axis(p.z, spacing.z, count.z, float(cell / (x * y))));
}

// Turns the content about the y axis, rate radians for each metre of height.
vec3 twist(vec3 p, float rate) {
    float c = cos(rate * p.y);
    float s = sin(rate * p.y);
    return vec3(c * p.x + s * p.z, p.y, c * p.z - s * p.x);
}

// A bound of the distance to twisted content. Within radius s of the axis the twist stretches by at most
// (k s + sqrt(k² s² + 4)) / 2 <= 1 + k s with k = |rate|. A path of length r from p stays within radius s + r; so r is safe
// where (1 + k (s + r)) r <= |d|, and this is the largest such r.
float twist_distance(float d, vec3 p, float rate) {
    float k = abs(rate);
    float b = 1.0f + k * length(vec2(p.x, p.z));
    return 2.0f * d / (b + sqrt(b * b + 4.0f * k * abs(d)));
}

// The cross-section at z = 0, everywhere: with extrude_distance a body, as far as half_height on either side.
vec3 extrude(vec3 p, float half_height, float radius) {
    return vec3(p.x, p.y, 0.0f);
}

// d is the cross-section's distance; that of an exact profile gives an exact body, unless its edges are rounded. They are
// within its size, the radius is limited to half_height; where the section is less deep than the radius its ends are domes.
float extrude_distance(float d, vec3 p, float half_height, float radius) {
    float r = min(radius, half_height);
    return prism(d + r, p.z, half_height - r) - r;
}

// The cross-section at z = 0, moved out along x by offset and turned about the y axis. Exact for exact profiles that do not
// cross the axis, otherwise a bound.
vec3 revolve(vec3 p, float offset) {
    return vec3(length(vec2(p.x, p.z)) - offset, p.y, 0.0f);
}

// ---- distance --------------------------------------------------------------------------------------------------------

// A skin of this thickness, half of it on either side of the surface.
float shell(float d, float thickness) {
    return abs(d) - 0.5f * thickness;
}

// Everything within radius of the content: grows it and rounds its convex edges.
float inflate(float d, float radius) {
    return d - radius;
}

// ---- material --------------------------------------------------------------------------------------------------------

// A material code holds two material indices of 12 bits and, in the upper 8 bits, the second one's share in 1/255.
// Blends code b into a with the given share of b; where a or b is a blend itself its larger part stands for it.
uint blend_materials(uint a, uint b, float share_of_b) {
    uint share = uint(share_of_b * 255.0f + 0.5f);
    uint first = (a >> 24u) < 128u ? a & 0xfffu : (a >> 12u) & 0xfffu;
    uint second = (b >> 24u) < 128u ? b & 0xfffu : (b >> 12u) & 0xfffu;
    return share == 0u ? a : share == 255u ? b : first | (second << 12u) | (share << 24u);
}
