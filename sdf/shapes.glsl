// The one truth for distance, blend and domain functions, with operations.glsl. Compiled as GLSL (the functions a scene
// uses are copied into its program) and, through GLM, as C++ (kind_table.h), so that CPU and GPU cannot drift apart.
// Both languages accept this: literals with f, vec2(p.x, p.z) for swizzles, no out parameters, no overloads. A function
// calls only those before it; operations.glsl follows this file.
//
// Distances are signed, in metres, negative inside; p is in the shape's own frame, y up; angles in radians.
// A function not marked as a bound returns the exact Euclidean distance. Most forms are those that Inigo Quilez
// collected ("Distance functions", 2008-2024); deviations are explained where they are. Solids of revolution are described
// in the half plane q = (distance from the y axis, y).
//
// After convex shapes stands what the tracer asks of them: the distance and, outside, its slope along the unit vector v. The
// gradient is the unit vector from the nearest point to p; at creases of the distance any gradient between will do. And of
// some, how far a ray from p along v stays inside, more than `depth` below the surface: 0 where p is not. And of those that a
// line crosses in closed form, from where to where on the line p + t v it is inside: the first number is larger than the second
// if it nowhere is. Quadratics are solved around the point of the line that is nearest to the shape's middle, because
// their rounding grows with the square of the distance from there (Haines, Günther and Akenine-Möller 2019).

// ---- primitives ----------------------------------------------------------------------------------------------------

float sphere(vec3 p, float radius) {
    return length(p) - radius;
}

vec2 sphere_along(vec3 p, vec3 v, float radius) {
    float l = length(p);
    return vec2(l - radius, dot(p, v) / max(l, 1e-20f));
}

float sphere_within(vec3 p, vec3 v, float depth, float radius) {
    float along = dot(p, v);
    float outside = dot(p, p) - (radius - depth) * (radius - depth);
    return outside < 0.0f && depth < radius ? sqrt(along * along - outside) - along : 0.0f;
}

vec2 sphere_span(vec3 p, vec3 v, float radius) {
    float nearest = -dot(p, v);
    vec3 q = p + nearest * v;
    float square = radius * radius - dot(q, q);
    float half_span = square < 0.0f ? -1e20f : sqrt(square);
    return vec2(nearest - half_span, nearest + half_span);
}

float box(vec3 p, vec3 half_size) {
    vec3 q = abs(p) - half_size;
    return length(max(q, vec3(0.0f))) + min(max(q.x, max(q.y, q.z)), 0.0f);
}

vec2 box_along(vec3 p, vec3 v, vec3 half_size) {
    vec3 q = abs(p) - half_size;
    vec3 from_box = max(q, vec3(0.0f));
    float d = length(from_box);
    return vec2(d + min(max(q.x, max(q.y, q.z)), 0.0f), dot(from_box * sign(p), v) / max(d, 1e-20f));
}

float box_within(vec3 p, vec3 v, float depth, vec3 half_size) {
    vec3 inner = half_size - vec3(depth);
    vec3 q = abs(p) - inner;
    vec3 ways = (inner - p * sign(v)) / max(abs(v), vec3(1e-20f));
    return max(q.x, max(q.y, q.z)) < 0.0f ? min(ways.x, min(ways.y, ways.z)) : 0.0f;
}

vec2 box_span(vec3 p, vec3 v, vec3 half_size) {
    vec3 inverse = 1.0f / (v + vec3(1e-20f));
    vec3 middle = -p * inverse;
    vec3 half_span = half_size * abs(inverse);
    vec3 first = middle - half_span;
    vec3 last = middle + half_span;
    return vec2(max(first.x, max(first.y, first.z)), min(last.x, min(last.y, last.z)));
}

// A box whose edges are rounded within its size; the radius is limited to the smallest half size.
float rounded_box(vec3 p, vec3 half_size, float radius) {
    float r = min(radius, min(half_size.x, min(half_size.y, half_size.z)));
    return box(p, half_size - vec3(r)) - r;
}

vec2 rounded_box_along(vec3 p, vec3 v, vec3 half_size, float radius) {
    float r = min(radius, min(half_size.x, min(half_size.y, half_size.z)));
    return box_along(p, v, half_size - vec3(r)) - vec2(r, 0.0f);
}

// Around the y axis: a tube of minor_radius along a circle of major_radius in the xz plane.
float torus(vec3 p, float major_radius, float minor_radius) {
    return length(vec2(length(vec2(p.x, p.z)) - major_radius, p.y)) - minor_radius;
}

// All points within radius of the segment from -half_height to half_height on the y axis.
float capsule(vec3 p, float radius, float half_height) {
    return length(vec3(p.x, p.y - clamp(p.y, -half_height, half_height), p.z)) - radius;
}

vec2 capsule_along(vec3 p, vec3 v, float radius, float half_height) {
    return sphere_along(vec3(p.x, p.y - clamp(p.y, -half_height, half_height), p.z), v, radius);
}

float capped_cylinder(vec3 p, float radius, float half_height) {
    vec2 q = vec2(length(vec2(p.x, p.z)) - radius, abs(p.y) - half_height);
    return length(max(q, vec2(0.0f))) + min(max(q.x, q.y), 0.0f);
}

// Of a solid of revolution, from q in the half plane and the vector to q from the nearest point there.
vec2 turned_along(float d, vec2 from_nearest, vec3 p, vec3 v) {
    float away = (p.x * v.x + p.z * v.z) / max(length(vec2(p.x, p.z)), 1e-20f);
    return vec2(d, (from_nearest.x * away + from_nearest.y * v.y) / max(length(from_nearest), 1e-20f));
}

vec2 capped_cylinder_along(vec3 p, vec3 v, float radius, float half_height) {
    vec2 q = vec2(length(vec2(p.x, p.z)) - radius, abs(p.y) - half_height);
    vec2 from_nearest = max(q, vec2(0.0f));
    return turned_along(length(from_nearest) + min(max(q.x, q.y), 0.0f),
                        vec2(from_nearest.x, from_nearest.y * sign(p.y)), p, v);
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
    bool inside = from_tip.x * side.y > from_tip.y * side.x && to_base.y > 0.0f;
    float d = sqrt(min(dot(to_base, to_base), dot(to_side, to_side)));
    return inside ? -d : d;
}

vec2 cone_along(vec3 p, vec3 v, float radius, float half_height) {
    vec2 q = vec2(length(vec2(p.x, p.z)), p.y);
    vec2 to_base = vec2(max(q.x - radius, 0.0f), q.y + half_height);
    vec2 side = vec2(radius, -2.0f * half_height);
    vec2 from_tip = q - vec2(0.0f, half_height);
    vec2 to_side = from_tip - side * clamp(dot(from_tip, side) / max(dot(side, side), 1e-12f), 0.0f, 1.0f);
    return turned_along(cone(p, radius, half_height), dot(to_base, to_base) < dot(to_side, to_side) ? to_base : to_side, p, v);
}

// The half space y <= 0.
float plane(vec3 p) {
    return p.y;
}

vec2 plane_along(vec3 p, vec3 v) {
    return vec2(p.y, v.y);
}

float plane_within(vec3 p, vec3 v, float depth) {
    return max(-p.y - depth, 0.0f) / max(v.y, 1e-20f);
}

vec2 plane_span(vec3 p, vec3 v) {
    float meets = -p.y / (v.y + 1e-20f);
    return v.y < 0.0f ? vec2(meets, 1e20f) : vec2(-1e20f, meets);
}

// A bound: that of the ball of the same relative size, or the distance to the box around it, whichever is larger. The exact
// distance, by Newton's method in a loop, took 2.2 times as long for 1 % fewer evaluations per ray: the tracer learns slopes.
// The usual bound k0 (k0 - 1) / |p / radii²| grows faster than 1 beside the rim of thin bodies, without limit.
float ellipsoid(vec3 p, vec3 radii) {
    float shortest = min(radii.x, min(radii.y, radii.z));
    return max((length(p / radii) - 1.0f) * shortest, box(p, radii));
}

// The larger one of two convex functions, and so convex.
vec2 ellipsoid_along(vec3 p, vec3 v, vec3 radii) {
    float shortest = min(radii.x, min(radii.y, radii.z));
    vec2 in_ball = sphere_along(p / radii, v / radii, 1.0f) * shortest;
    vec2 in_box = box_along(p, v, radii);
    return in_ball.x > in_box.x ? in_ball : in_box;
}

vec2 ellipsoid_span(vec3 p, vec3 v, vec3 radii) {
    vec3 w = v / radii;
    float square_of_w = dot(w, w);
    float nearest = -dot(p / radii, w) / square_of_w;
    vec3 q = (p + nearest * v) / radii;
    float square = (1.0f - dot(q, q)) / square_of_w;
    float half_span = square < 0.0f ? -1e20f : sqrt(square);
    return vec2(nearest - half_span, nearest + half_span);
}

// Everything within radius of the y axis.
float infinite_cylinder(vec3 p, float radius) {
    return length(vec2(p.x, p.z)) - radius;
}

vec2 infinite_cylinder_along(vec3 p, vec3 v, float radius) {
    return sphere_along(vec3(p.x, 0.0f, p.z), v, radius);
}

float infinite_cylinder_within(vec3 p, vec3 v, float depth, float radius) {
    float across = max(v.x * v.x + v.z * v.z, 1e-12f);
    float along = p.x * v.x + p.z * v.z;
    float outside = p.x * p.x + p.z * p.z - (radius - depth) * (radius - depth);
    return outside < 0.0f && depth < radius ? (sqrt(along * along - across * outside) - along) / across : 0.0f;
}

vec2 infinite_cylinder_span(vec3 p, vec3 v, float radius) {
    float across = max(v.x * v.x + v.z * v.z, 1e-20f);
    float nearest = -(p.x * v.x + p.z * v.z) / across;
    vec2 q = vec2(p.x + nearest * v.x, p.z + nearest * v.z);
    float square = (radius * radius - dot(q, q)) / across;
    float half_span = square < 0.0f ? -1e20f : sqrt(square);
    return vec2(nearest - half_span, nearest + half_span);
}

float capped_cylinder_within(vec3 p, vec3 v, float depth, float radius, float half_height) {
    float h = half_height - depth;
    float to_end = abs(p.y) < h ? (h - p.y * sign(v.y)) / max(abs(v.y), 1e-20f) : 0.0f;
    return min(infinite_cylinder_within(p, v, depth, radius), to_end);
}

// Where |p + t v| <= half_size.
vec2 slab_span(float p, float v, float half_size) {
    float inverse = 1.0f / (v + 1e-20f);
    float half_span = half_size * abs(inverse);
    return vec2(-p * inverse - half_span, -p * inverse + half_span);
}

vec2 capped_cylinder_span(vec3 p, vec3 v, float radius, float half_height) {
    vec2 side = infinite_cylinder_span(p, v, radius);
    vec2 ends = slab_span(p.y, v.y, half_height);
    return vec2(max(side.x, ends.x), min(side.y, ends.y));
}

// It begins and ends with one of the balls that it is made of: that at the same height as where the line crosses the infinite
// cylinder, or the last one.
vec2 capsule_span(vec3 p, vec3 v, float radius, float half_height) {
    vec2 side = infinite_cylinder_span(p, v, radius);
    float first = clamp(p.y + side.x * v.y, -half_height, half_height);
    float last = clamp(p.y + side.y * v.y, -half_height, half_height);
    return vec2(sphere_span(vec3(p.x, p.y - first, p.z), v, radius).x, sphere_span(vec3(p.x, p.y - last, p.z), v, radius).y);
}

// The twelve edges of a box, as bars of this thickness within its size; the thickness is limited to the smallest half size.
// Outside, the nearest of the three bars that meet in p's octant; inside, the nearer of the box's faces and the openings.
float box_frame(vec3 p, vec3 half_size, float thickness) {
    float t = min(thickness, min(half_size.x, min(half_size.y, half_size.z)));
    vec3 beyond = abs(p) - half_size;
    vec3 depth = abs(p) - (half_size - vec3(t));  // from the planes of the bars' inner faces
    vec3 o = max(beyond, vec3(0.0f));
    vec3 e = max(o, -depth);
    float outside = sqrt(min(o.x * o.x + e.y * e.y + e.z * e.z,
                             min(e.x * e.x + o.y * o.y + e.z * e.z, e.x * e.x + e.y * e.y + o.z * o.z)));
    vec3 v = max(depth, vec3(0.0f));
    float to_opening = sqrt(min(v.x * v.x + v.y * v.y, min(v.y * v.y + v.z * v.z, v.z * v.z + v.x * v.x)));
    float to_face = -max(beyond.x, max(beyond.y, beyond.z));
    return outside > 0.0f ? outside : -min(to_face, to_opening);
}

// The part of a torus within half the angle on either side of the x axis, with round ends.
float capped_torus(vec3 p, float major_radius, float minor_radius, float angle) {
    vec2 q = vec2(p.x, abs(p.z));
    vec2 end = vec2(cos(0.5f * angle), max(sin(0.5f * angle), 0.0f));
    bool beside = end.y * q.x >= end.x * q.y;  // the nearest point of the circle belongs to the arc
    vec2 to_end = q - major_radius * end;
    return length(vec2(beside ? length(q) - major_radius : length(to_end), p.y)) - minor_radius;
}

// A link of a chain: a torus around the z axis whose halves stand half_height above and below the middle.
float link(vec3 p, float major_radius, float minor_radius, float half_height) {
    float from_bend = length(vec2(p.x, max(abs(p.y) - half_height, 0.0f))) - major_radius;
    return length(vec2(from_bend, p.z)) - minor_radius;
}

// A cylinder whose rims are rounded within its size.
float rounded_cylinder(vec3 p, float radius, float half_height, float edge_radius) {
    float r = min(edge_radius, min(radius, half_height));
    return capped_cylinder(p, radius - r, half_height - r) - r;
}

vec2 rounded_cylinder_along(vec3 p, vec3 v, float radius, float half_height, float edge_radius) {
    float r = min(edge_radius, min(radius, half_height));
    return capped_cylinder_along(p, v, radius - r, half_height - r) - vec2(r, 0.0f);
}

// A cone without its tip. The distance is the lesser one to the nearer disc and to the slanted side.
float capped_cone(vec3 p, float lower_radius, float upper_radius, float half_height) {
    vec2 q = vec2(length(vec2(p.x, p.z)), p.y);
    vec2 to_disc = vec2(max(q.x - (q.y < 0.0f ? lower_radius : upper_radius), 0.0f), abs(q.y) - half_height);
    vec2 side = vec2(upper_radius - lower_radius, 2.0f * half_height);
    vec2 from_rim = q - vec2(lower_radius, -half_height);
    float along = clamp(dot(from_rim, side) / max(dot(side, side), 1e-12f), 0.0f, 1.0f);
    vec2 to_side = from_rim - along * side;
    bool inside = from_rim.x * side.y < from_rim.y * side.x && to_disc.y < 0.0f;
    float d = sqrt(min(dot(to_disc, to_disc), dot(to_side, to_side)));
    return inside ? -d : d;
}

vec2 capped_cone_along(vec3 p, vec3 v, float lower_radius, float upper_radius, float half_height) {
    vec2 q = vec2(length(vec2(p.x, p.z)), p.y);
    vec2 to_disc = vec2(max(q.x - (q.y < 0.0f ? lower_radius : upper_radius), 0.0f), abs(q.y) - half_height);
    vec2 side = vec2(upper_radius - lower_radius, 2.0f * half_height);
    vec2 from_rim = q - vec2(lower_radius, -half_height);
    vec2 to_side = from_rim - side * clamp(dot(from_rim, side) / max(dot(side, side), 1e-12f), 0.0f, 1.0f);
    bool disc = dot(to_disc, to_disc) < dot(to_side, to_side);
    return turned_along(capped_cone(p, lower_radius, upper_radius, half_height),
                        disc ? vec2(to_disc.x, to_disc.y * sign(q.y)) : to_side, p, v);
}

// Between its ends it is what x² + z² <= r(y)² holds, with a second cone upside down on its tip that lies beyond them. A
// line that is steeper than the cone is in either of these but for its way between two crossings.
vec2 capped_cone_span(vec3 p, vec3 v, float lower_radius, float upper_radius, float half_height) {
    vec2 ends = slab_span(p.y, v.y, half_height);
    float nearest = -dot(p, v);
    vec3 q = p + nearest * v;
    float widening = (upper_radius - lower_radius) / max(2.0f * half_height, 1e-9f);
    float r = 0.5f * (lower_radius + upper_radius) + widening * q.y;
    float a = v.x * v.x + v.z * v.z - widening * widening * v.y * v.y;
    a = abs(a) < 1e-12f ? 1e-12f : a;
    float b = q.x * v.x + q.z * v.z - widening * v.y * r;
    float c = q.x * q.x + q.z * q.z - r * r;
    float square = b * b - a * c;
    float root = -b - (b < 0.0f ? -1.0f : 1.0f) * sqrt(max(square, 0.0f));
    float one = root / a;
    float other = abs(root) < 1e-20f ? one : c / root;
    vec2 side = vec2(min(one, other), max(one, other));
    if (square < 0.0f) side = a > 0.0f ? vec2(1e20f, -1e20f) : vec2(-1e20f, 1e20f);
    else if (a < 0.0f) side = widening * v.y > 0.0f ? vec2(side.y, 1e20f) : vec2(-1e20f, side.x);
    return vec2(max(side.x + nearest, ends.x), min(side.y + nearest, ends.y));
}

vec2 cone_span(vec3 p, vec3 v, float radius, float half_height) {
    return capped_cone_span(p, v, radius, 0.0f, half_height);
}

// The convex hull of two balls at y = -half_height and y = half_height: a ball whose centre moves up the axis while its
// radius shrinks by `taper` for each metre. The nearest such ball is found in closed form; where one end holds the other,
// taper is 1 and only the larger ball is left.
float round_cone(vec3 p, float lower_radius, float upper_radius, float half_height) {
    float larger = max(lower_radius, upper_radius);
    float taper = min(abs(lower_radius - upper_radius) / max(2.0f * half_height, 1e-9f), 1.0f);
    vec2 q = vec2(length(vec2(p.x, p.z)), (lower_radius >= upper_radius ? p.y : -p.y) + half_height);
    float s = clamp(q.y - q.x * taper / sqrt(max(1.0f - taper * taper, 1e-12f)), 0.0f, 2.0f * half_height);
    return length(vec2(q.x, q.y - s)) - (larger - taper * s);
}

vec2 round_cone_along(vec3 p, vec3 v, float lower_radius, float upper_radius, float half_height) {
    float larger = max(lower_radius, upper_radius);
    float taper = min(abs(lower_radius - upper_radius) / max(2.0f * half_height, 1e-9f), 1.0f);
    float up = lower_radius >= upper_radius ? 1.0f : -1.0f;
    vec2 q = vec2(length(vec2(p.x, p.z)), up * p.y + half_height);
    float s = clamp(q.y - q.x * taper / sqrt(max(1.0f - taper * taper, 1e-12f)), 0.0f, 2.0f * half_height);
    vec2 from_centre = vec2(q.x, q.y - s);
    return turned_along(length(from_centre) - (larger - taper * s), vec2(from_centre.x, up * from_centre.y), p, v);
}

// From the distance in the plane and the distance along the normal, |along| - half_height, to that of the prism.
float prism(float d, float along, float half_height) {
    vec2 q = vec2(d, abs(along) - half_height);
    return length(max(q, vec2(0.0f))) + min(max(q.x, q.y), 0.0f);
}

// Signed distance in the plane to a side that lies at q.y = 0 between q.x = -half_width and half_width.
float polygon_side(vec2 q, float half_width) {
    float d = length(vec2(max(abs(q.x) - half_width, 0.0f), q.y));
    return q.y < 0.0f ? -d : d;
}

// A regular hexagon in the xz plane, two sides across z, along y. The mirror brings q to the side across z.
float hexagonal_prism(vec3 p, float inradius, float half_height) {
    vec2 q = vec2(abs(p.x), abs(p.z));
    q -= 2.0f * max(0.8660254f * q.x - 0.5f * q.y, 0.0f) * vec2(0.8660254f, -0.5f);
    return prism(polygon_side(vec2(q.x, q.y - inradius), 0.57735027f * inradius), p.y, half_height);
}

// An equilateral triangle in the xz plane, one corner towards -z, along y. Exact, unlike the usual bound.
float triangular_prism(vec3 p, float inradius, float half_height) {
    vec2 q = vec2(abs(p.x), p.z);
    q -= 2.0f * max(0.5f * q.x - 0.8660254f * q.y, 0.0f) * vec2(0.5f, -0.8660254f);
    return prism(polygon_side(vec2(q.x, q.y - inradius), 1.7320508f * inradius), p.y, half_height);
}

// The part of a ball within half the angle of the +y axis.
float solid_angle(vec3 p, float radius, float angle) {
    vec2 q = vec2(length(vec2(p.x, p.z)), p.y);
    vec2 side = vec2(max(sin(0.5f * angle), 0.0f), cos(0.5f * angle));
    float to_ball = length(q) - radius;
    float to_side = length(q - side * clamp(dot(q, side), 0.0f, radius));
    return max(to_ball, side.y * q.x < side.x * q.y ? -to_side : to_side);
}

// A ball without what lies below cut_height. Beyond the rim only the rim counts; elsewhere ball or plane do.
float cut_sphere(vec3 p, float radius, float cut_height) {
    float h = clamp(cut_height, -radius, radius);
    float w = sqrt(max(radius * radius - h * h, 0.0f));
    vec2 q = vec2(length(vec2(p.x, p.z)), p.y);
    float l = length(q);
    bool beyond_rim = q.y * radius < h * l && q.x > w;
    return beyond_rim ? length(q - vec2(w, h)) : max(l - radius, h - q.y);
}

// A hollow ball, half the thickness on either side of the radius, without what lies above cut_height; the rim is round.
float cut_hollow_sphere(vec3 p, float radius, float cut_height, float thickness) {
    float h = clamp(cut_height, -radius, radius);
    float w = sqrt(max(radius * radius - h * h, 0.0f));
    vec2 q = vec2(length(vec2(p.x, p.z)), p.y);
    float l = length(q);
    return (q.y * radius > h * l ? length(q - vec2(w, h)) : abs(l - radius)) - 0.5f * thickness;
}

// A ball from which another one, its centre at y = offset, is carved. Their surfaces meet in a rim (w, h); it is nearest
// where neither the ball's surface nor the hollow's holds the point radially nearest to p.
float death_star(vec3 p, float radius, float carving_radius, float offset) {
    float h = (radius * radius - carving_radius * carving_radius + offset * offset) / max(2.0f * offset, 1e-9f);
    h = clamp(h, -radius, radius);
    float w = sqrt(max(radius * radius - h * h, 0.0f));
    vec2 q = vec2(length(vec2(p.x, p.z)), p.y);
    vec2 c = vec2(q.x, q.y - offset);
    float d = max(length(q) - radius, carving_radius - length(c));
    bool on_ball = q.y * radius <= h * length(q);
    bool in_hollow = c.y * carving_radius <= (h - offset) * length(c);
    return d > 0.0f && !on_ball && !in_hollow ? length(q - vec2(w, h)) : d;
}

// The circular arc from tip to tip through (radius, 0), turned about the y axis; the radius is limited to half_height, where
// it is a ball. The arc's centre is (-c, 0); the quotient avoids subtracting two large radii when it is flat.
float vesica(vec3 p, float radius, float half_height) {
    float r = max(min(radius, half_height), 1e-6f * half_height + 1e-9f);
    float c = max((half_height * half_height - r * r) / (2.0f * r), 0.0f);
    vec2 q = vec2(length(vec2(p.x, p.z)), abs(p.y));
    vec2 from_centre = vec2(q.x + c, q.y);
    float to_arc = (dot(q, q) + 2.0f * c * q.x - r * (2.0f * c + r)) / (length(from_centre) + c + r);
    return q.y * c > half_height * from_centre.x ? length(vec2(q.x, q.y - half_height)) : to_arc;
}

// A rhombus in the xz plane with these half diagonals, along y.
float rhombus(vec3 p, float half_length, float half_width, float half_height) {
    vec2 q = vec2(abs(p.x) - half_length, abs(p.z));  // from the corner on the x axis
    vec2 side = vec2(-half_length, half_width);
    float along = clamp(dot(q, side) / max(dot(side, side), 1e-12f), 0.0f, 1.0f);
    float d = length(q - along * side);
    return prism(q.x * half_width + q.y * half_length < 0.0f ? -d : d, p.y, half_height);
}

// All points with |x| + |y| + |z| <= radius. Nearest to p is a face or, where p's least coordinate leaves the face, the
// edge on which that coordinate is 0.
float octahedron(vec3 p, float radius) {
    vec3 q = abs(p);
    float largest = max(q.x, max(q.y, q.z));
    float middle = max(min(q.x, q.y), min(max(q.x, q.y), q.z));
    float least = min(q.x, min(q.y, q.z));
    float to_face = (largest + middle + least - radius) / 3.0f;
    float t = clamp(0.5f * (largest - middle + radius), 0.0f, radius);
    return least >= to_face ? 1.7320508f * to_face : length(vec3(largest - t, middle - (radius - t), least));
}

// Square base at y = -half_height, apex at y = half_height. By symmetry one side counts, seen from the middle of its base
// edge: q.x outwards, q.y up, q.z along the edge; in the side's plane, q.z and `along`, it is a triangle.
float pyramid(vec3 p, float half_width, float half_height) {
    vec3 q = vec3(max(abs(p.x), abs(p.z)) - half_width, p.y + half_height, min(abs(p.x), abs(p.z)));
    float slant = max(length(vec2(half_width, 2.0f * half_height)), 1e-9f);
    vec2 up = vec2(-half_width, 2.0f * half_height) / slant;
    float off = q.x * up.y - q.y * up.x;
    float along = q.x * up.x + q.y * up.y;
    vec3 to_base = vec3(max(q.x, 0.0f), q.y, max(q.z - half_width, 0.0f));
    vec2 edge = vec2(-half_width, slant);
    vec2 from_corner = vec2(q.z - half_width, along);
    vec2 to_edge = from_corner - edge * clamp(dot(from_corner, edge) / dot(edge, edge), 0.0f, 1.0f);
    bool beyond_edge = from_corner.x * edge.y > from_corner.y * edge.x;
    vec2 in_side = beyond_edge ? to_edge : vec2(max(q.z - half_width, 0.0f), min(along, 0.0f));
    float d = sqrt(min(dot(to_base, to_base), off * off + dot(in_side, in_side)));
    return off < 0.0f && q.y > 0.0f ? max(off, -q.y) : d;
}

// ---- profiles: shapes in the xy plane, the same at every z, for extrude and revolve ------------------------------------

float circle(vec3 p, float radius) {
    return length(vec2(p.x, p.y)) - radius;
}

float rectangle(vec3 p, float half_width, float half_height) {
    return prism(abs(p.x) - half_width, p.y, half_height);
}

// A rectangle whose corners are rounded within its size; the radius is limited to the smaller half size.
float rounded_rectangle(vec3 p, float half_width, float half_height, float radius) {
    float r = min(radius, min(half_width, half_height));
    return rectangle(p, half_width - r, half_height - r) - r;
}

// What looks the same after a turn by 1/count, and in a mirror: p in the half of a sector between the y axis and half_sector
// clockwise of it. That half holds the point nearest to p, because no mirror image of a point there is nearer than itself.
vec2 fold_into_half_sector(vec3 p, float half_sector) {
    float x = abs(p.x);
    float turn = 2.0f * half_sector * floor(0.5f * atan(x + 1e-30f, p.y) / half_sector + 0.5f);
    return vec2(abs(cos(turn) * x - sin(turn) * p.y), sin(turn) * x + cos(turn) * p.y);
}

// A regular polygon, one corner at y = radius.
float polygon(vec3 p, float sides, float radius) {
    float half_sector = 3.14159265f / sides;
    vec2 out_of_side = vec2(sin(half_sector), cos(half_sector));
    vec2 q = fold_into_half_sector(p, half_sector);
    return polygon_side(vec2(q.x * out_of_side.y - q.y * out_of_side.x, dot(q, out_of_side) - radius * out_of_side.y),
                        radius * out_of_side.x);
}

// A star, one point at y = outer_radius, between two of them a corner at inner_radius. Quilez ("2D distance functions", 2020)
// gives the points' angle instead. The last condition is for points without width, where rounding decides about the side.
float star(vec3 p, float points, float outer_radius, float inner_radius) {
    float half_sector = 3.14159265f / points;
    vec2 q = fold_into_half_sector(p, half_sector);
    vec2 side = inner_radius * vec2(sin(half_sector), cos(half_sector)) - vec2(0.0f, outer_radius);
    vec2 from_point = q - vec2(0.0f, outer_radius);
    float along = clamp(dot(from_point, side) / max(dot(side, side), 1e-20f), 0.0f, 1.0f);
    float d = length(from_point - along * side);
    bool inside = side.x * from_point.y < side.y * from_point.x && length(q) < max(outer_radius, inner_radius);
    return inside ? -d : d;
}

// A band along a circle, half the thickness on either side of it, within half the angle on either side of the y axis; the
// thickness is limited to twice the radius. After Quilez ("2D distance functions", 2023), and whole rings have no seam.
float ring(vec3 p, float radius, float thickness, float angle) {
    float half_thickness = min(0.5f * thickness, radius);
    vec2 q = vec2(abs(p.x), p.y);
    vec2 end = vec2(sin(0.5f * angle), cos(0.5f * angle));
    float beyond = q.x * end.y - q.y * end.x;
    float to_end = length(vec2(beyond, max(abs(dot(q, end) - radius) - half_thickness, 0.0f)));
    float to_ring = abs(length(q) - radius) - half_thickness;
    return angle > 6.28318f ? to_ring : max(to_ring, beyond > 0.0f ? to_end : -to_end);
}

// ---- fractals --------------------------------------------------------------------------------------------------------

// Menger's sponge (1926), a bound: a cube without the square bars through the middles of its faces, then the same for the 27
// cubes of a third of the size, and so on. The bars repeat without end, so the distance to the nearest is that within its
// cell, which is continuous; it is the median of three coordinates because a bar is where two of them are small.
float menger_sponge(vec3 p, float half_size, float iterations) {
    float d = box(p, vec3(half_size));
    float cell = max(half_size, 1e-9f);  // half the edge length of this iteration's cubes
    for (int i = 0; i < min(int(iterations), 6); ++i) {
        vec3 q = abs(p - 2.0f * cell * floor(0.5f * p / cell + vec3(0.5f)));
        cell /= 3.0f;
        d = max(d, cell - max(min(q.x, q.y), min(max(q.x, q.y), q.z)));
    }
    return d;
}

vec2 complex_product(vec2 a, vec2 b) {
    return vec2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x);
}

// z to a power from 1 to 31. Without a loop, so that a constant power costs the products that it takes and no more.
vec2 complex_power(vec2 z, float power) {
    int n = int(power);
    vec2 z2 = complex_product(z, z);
    vec2 z4 = complex_product(z2, z2);
    vec2 z8 = complex_product(z4, z4);
    vec2 result = vec2(1.0f, 0.0f);
    if (n % 2 == 1) result = z;
    if (n / 2 % 2 == 1) result = complex_product(result, z2);
    if (n / 4 % 2 == 1) result = complex_product(result, z4);
    if (n / 8 % 2 == 1) result = complex_product(result, z8);
    if (n / 16 % 2 == 1) result = complex_product(result, complex_product(z8, z8));
    return result;
}

// The mandelbulb (White and Nylander, 2009): all c from which z -> z^power + c stays within `limit`, from where it cannot come
// back; z^n has n times z's angles from and about the y axis. Scaled so that `limit`, which holds it, becomes radius.
// The distance after Hart, Sandin and Kauffman (1989) is log|z| |z| / |dz/dc|. Here |dz/dc| is more than the usual product of
// n |z|^(n-1), which is wrong without limit near the y axis, where turning about it stretches up to n times more: `turning`
// allows for that and fades beyond the limit. Each factor is at least 2, without which the inside is wild.
// A bound by experience: the largest slope found was 0.92 of what `steepest` says, see tests/fractal_test.cpp.
float mandelbulb(vec3 p, float radius, float power, float iterations) {
    float limit = exp2(1.0f / (power - 1.0f));
    float size = max(radius, 1e-9f) / limit;
    float beyond = exp(44.0f / power);  // from here further iterations do not change the distance
    int last = min(int(iterations), 16);
    float level = log(limit) * pow(power, -float(last));  // log|z| at the surface, for as many iterations as were made
    vec3 c = p / size;
    vec3 z = c;
    float r = length(z);
    float slope = 1.0f;
    if (r > 2.0f * limit) return length(p) - radius;  // from about here on the greater one of the two
    for (int i = 0; i < last; i += r < beyond ? 1 : last) {
        float across = length(vec2(z.x, z.z));
        float sine = across / max(r, 1e-20f);
        float turning = power / sqrt(1.0f + (power * power - 1.0f) * sine * sine) * min(limit / max(r, 1e-20f), 1.0f);
        vec2 up = complex_power(vec2(z.y, across), power);
        vec2 around = across > 0.0f ? complex_power(vec2(z.z, z.x) / across, power) : vec2(1.0f, 0.0f);
        slope = max(power * length(up) / max(r, 1e-20f) * max(turning, 1.0f), 2.0f) * slope + 1.0f;
        z = vec3(up.y * around.y, up.x, up.y * around.x) + c;
        level *= power;
        r = length(z);
    }
    r = max(r, 0.36787944f * exp(level));  // where r log r turns
    float steepest = max(4.2f, 1.3f * power);
    return max(size * r * (log(r) - level) / (slope * steepest), length(p) - radius);
}
