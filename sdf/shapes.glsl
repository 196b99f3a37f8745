// The one truth for distance, blend and domain functions. Compiled as GLSL (the functions a scene uses are copied into
// its program) and, through GLM, as C++ (node_kinds.cpp), so that CPU and GPU cannot drift apart.
// Both languages accept this: literals with f, vec2(p.x, p.z) for swizzles, no out parameters, no overloads.
//
// Distances are signed, in metres, negative inside; p is in the shape's own frame, y up; angles in radians.
// A function not marked as a bound returns the exact Euclidean distance. Most forms are those that Inigo Quilez
// collected ("Distance functions", 2008-2024); deviations are explained where they are.

// ---- primitives ----------------------------------------------------------------------------------------------------

float sphere(vec3 p, float radius) {
    return length(p) - radius;
}

float box(vec3 p, vec3 half_size) {
    vec3 q = abs(p) - half_size;
    return length(max(q, vec3(0.0f))) + min(max(q.x, max(q.y, q.z)), 0.0f);
}

// A box whose edges are rounded within its size; the radius is limited to the smallest half size.
float rounded_box(vec3 p, vec3 half_size, float radius) {
    float r = min(radius, min(half_size.x, min(half_size.y, half_size.z)));
    return box(p, half_size - vec3(r)) - r;
}

// Around the y axis: a tube of minor_radius along a circle of major_radius in the xz plane.
float torus(vec3 p, float major_radius, float minor_radius) {
    return length(vec2(length(vec2(p.x, p.z)) - major_radius, p.y)) - minor_radius;
}

// All points within radius of the segment from -half_height to half_height on the y axis.
float capsule(vec3 p, float radius, float half_height) {
    return length(vec3(p.x, p.y - clamp(p.y, -half_height, half_height), p.z)) - radius;
}

float capped_cylinder(vec3 p, float radius, float half_height) {
    vec2 q = vec2(length(vec2(p.x, p.z)) - radius, abs(p.y) - half_height);
    return length(max(q, vec2(0.0f))) + min(max(q.x, q.y), 0.0f);
}

// Base disc at y = -half_height, tip at y = half_height. In the half plane (radius, y) the solid is a triangle: the
// distance is the lesser one to its base and its slanted side.
float cone(vec3 p, float radius, float half_height) {
    vec2 q = vec2(length(vec2(p.x, p.z)), p.y);
    vec2 to_base = vec2(max(q.x - radius, 0.0f), q.y + half_height);
    vec2 side = vec2(radius, -2.0f * half_height);  // from the tip to the rim
    vec2 from_tip = q - vec2(0.0f, half_height);
    float along = clamp(dot(from_tip, side) / max(dot(side, side), 1e-12f), 0.0f, 1.0f);
    vec2 to_side = from_tip - along * side;
    bool inside = to_side.x < 0.0f && to_base.y > 0.0f;
    float d = sqrt(min(dot(to_base, to_base), dot(to_side, to_side)));
    return inside ? -d : d;
}

// The half space y <= 0.
float plane(vec3 p) {
    return p.y;
}

// A bound. k0 = |p / radii| is convex and 1 on the surface, so (k0 - 1) / |grad k0| never exceeds the distance outside;
// inside, where that form overestimates up to the longest radius, 1 / min(radii) bounds the gradient instead.
float ellipsoid(vec3 p, vec3 radii) {
    vec3 q = p / radii;
    float k0 = length(q);
    float k1 = length(q / radii);
    float shortest = min(radii.x, min(radii.y, radii.z));
    return k0 < 1.0f ? (k0 - 1.0f) * shortest : k0 * (k0 - 1.0f) / max(k1, 1e-12f);
}

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
