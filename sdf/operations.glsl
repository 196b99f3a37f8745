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

// Between the two shapes: a where amount is 0, b where it is 1.
float morph(float a, float b, float amount) {
    return mix(a, b, amount);
}

float morph_weight(float a, float b, float amount) {
    return amount;
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

// The absolute value with its crease rounded within radius: a parabola that touches both arms. Never steeper than 1.
float smooth_abs(float x, float radius) {
    return abs(x) >= radius ? abs(x) : 0.5f * (x * x / max(radius, 1e-9f) + radius);
}

// Each axis whose flag is 1 shows the positive side's content on both sides; the seam rounds where the sides meet.
vec3 mirror(vec3 p, vec3 axes, float seam) {
    return mix(p, vec3(smooth_abs(p.x, seam), smooth_abs(p.y, seam), smooth_abs(p.z, seam)), axes);
}

// The direction, after that, of a ray from p along v, and how far it keeps it: until it meets a mirror. Without seam.
vec3 mirrored_direction(vec3 p, vec3 v, vec3 axes, float seam) {
    vec3 side = vec3(p.x != 0.0f ? sign(p.x) : sign(v.x), p.y != 0.0f ? sign(p.y) : sign(v.y), p.z != 0.0f ? sign(p.z) : sign(v.z));
    return mix(v, v * side, axes);
}

float mirrored_way(vec3 p, vec3 v, vec3 axes, float seam) {
    vec3 way = vec3(p.x * v.x < 0.0f ? -p.x / v.x : 1e20f, p.y * v.y < 0.0f ? -p.y / v.y : 1e20f,
                    p.z * v.z < 0.0f ? -p.z / v.z : 1e20f);
    way = mix(vec3(1e20f), way, axes);
    return min(way.x, min(way.y, way.z));
}

// Pulls the content apart at the origin and fills the gap, half_size to either side, with its middle cross-section.
vec3 elongate(vec3 p, vec3 half_size) {
    return p - clamp(p, -half_size, half_size);
}

// Along one axis of repeat the index of the first of `cells` neighbours, those with their middles nearest to p. Copies stand
// at multiples of spacing; a positive count limits them and centres the row.
float first_copy(float p, float spacing, float count, float cells, float centre) {
    float last = 0.5f * (count - 1.0f);
    float offset = count > 0.0f ? last - floor(last) : 0.0f;
    float along = (p - centre) / spacing;
    float first = floor(along - offset + 0.5f) + offset;
    first -= floor(0.5f * (along >= first ? cells - 1.0f : cells));
    return count > 0.0f ? clamp(first, -last, last - (cells - 1.0f)) : first;
}

// The coordinate in the frame of one of those copies. No spacing or one copy: as is.
float repeat_axis(float p, float spacing, float count, float cells, float centre, float cell) {
    if (spacing <= 0.0f || count == 1.0f) return p;
    return p - (first_copy(p, spacing, count, cells, centre) + cell) * spacing;
}

// How many copies can hold the nearest point; cells of them along each axis.
int repeat_cells(vec3 spacing, vec3 count, vec3 cells, vec3 centre) {
    return int(cells.x * cells.y * cells.z);
}

// p in the frame of one of those copies.
vec3 repeat(vec3 p, vec3 spacing, vec3 count, vec3 cells, vec3 centre, int cell) {
    int x = int(cells.x);
    int y = int(cells.y);
    return vec3(repeat_axis(p.x, spacing.x, count.x, cells.x, centre.x, float(cell % x)),
                repeat_axis(p.y, spacing.y, count.y, cells.y, centre.y, float((cell / x) % y)),
                repeat_axis(p.z, spacing.z, count.z, cells.z, centre.z, float(cell / (x * y))));
}

// How far a ray from p along v goes until others are the nearest neighbours: along one axis they change at equal distances, in
// their middles where `cells` is even, between them where it is odd, and not beyond the ends of the row.
float way_to_next(float p, float v, float spacing, float count, float cells, float centre) {
    if (spacing <= 0.0f || count == 1.0f || cells == count || v == 0.0f) return 1e20f;
    float last = 0.5f * (count - 1.0f);
    float offset = count > 0.0f ? last - floor(last) : 0.0f;
    float odd = cells - 2.0f * floor(0.5f * cells);
    float along = (p - centre) / spacing - offset + 0.5f * odd;
    float change = v > 0.0f ? floor(along) + 1.0f : floor(along);
    if (count > 0.0f) {
        float before = 0.5f * (cells - 2.0f + odd);
        float first = 1.0f - last - offset + before;
        float final = last - (cells - 1.0f) - offset + before;
        if (v > 0.0f ? change > final : change < first) return 1e20f;
        change = clamp(change, first, final);
    }
    return (change - along) * spacing / v;
}

float repeated_way(vec3 p, vec3 v, vec3 spacing, vec3 count, vec3 cells, vec3 centre) {
    return min(way_to_next(p.x, v.x, spacing.x, count.x, cells.x, centre.x),
               min(way_to_next(p.y, v.y, spacing.y, count.y, cells.y, centre.y),
                   way_to_next(p.z, v.z, spacing.z, count.z, cells.z, centre.z)));
}

// Which copies are nearest is certain of exact distances alone. Otherwise the distance d at p of one copy is raised to that of
// a box around it, as wide as those cells see; what reaches further is cut off. And the copies that are not looked at count as
// the nearest of their boxes. So the values on both sides of where others become the nearest are the same. low and high: what
// all copies fill.
float outside_copy(float p, float spacing, float count, float cells, float low, float high) {
    if (spacing <= 0.0f || count == 1.0f) return max(low - p, p - high);
    return cells > 1.0f && cells != count ? abs(p) - 0.5f * (cells - 1.0f) * spacing : -1e9f;
}

float repeat_copy(float d, vec3 p, vec3 spacing, vec3 count, vec3 cells, vec3 centre, vec3 low, vec3 high) {
    vec3 q = vec3(spacing.x > 0.0f && count.x != 1.0f ? p.x - centre.x : p.x,
                  spacing.y > 0.0f && count.y != 1.0f ? p.y - centre.y : p.y,
                  spacing.z > 0.0f && count.z != 1.0f ? p.z - centre.z : p.z);
    vec3 away = vec3(outside_copy(q.x, spacing.x, count.x, cells.x, low.x, high.x),
                     outside_copy(q.y, spacing.y, count.y, cells.y, low.y, high.y),
                     outside_copy(q.z, spacing.z, count.z, cells.z, low.z, high.z));
    return max(d, length(max(away, 0.0f)) + min(max(away.x, max(away.y, away.z)), 0.0f));
}

// Along one axis how far the box of the nearest copy is that is not looked at.
float next_copy(float p, float spacing, float count, float cells, float centre) {
    if (spacing <= 0.0f || cells <= 1.0f || cells == count) return 1e9f;
    float last = 0.5f * (count - 1.0f);
    float first = first_copy(p, spacing, count, cells, centre);
    float in_copy = p - centre - first * spacing;
    float half_width = 0.5f * (cells - 1.0f) * spacing;
    float before = count > 0.0f && first < 0.5f - last ? 1e9f : in_copy + spacing - half_width;
    float after = count > 0.0f && first + cells > last + 0.5f ? 1e9f : cells * spacing - in_copy - half_width;
    return min(before, after);
}

float repeat_distance(float d, vec3 p, vec3 spacing, vec3 count, vec3 cells, vec3 centre, vec3 low, vec3 high) {
    vec3 beside = vec3(spacing.x <= 0.0f || count.x == 1.0f ? max(max(low.x - p.x, p.x - high.x), 0.0f) : 0.0f,
                       spacing.y <= 0.0f || count.y == 1.0f ? max(max(low.y - p.y, p.y - high.y), 0.0f) : 0.0f,
                       spacing.z <= 0.0f || count.z == 1.0f ? max(max(low.z - p.z, p.z - high.z), 0.0f) : 0.0f);
    float next = min(next_copy(p.x, spacing.x, count.x, cells.x, centre.x),
                     min(next_copy(p.y, spacing.y, count.y, cells.y, centre.y),
                         next_copy(p.z, spacing.z, count.z, cells.z, centre.z)));
    return min(d, length(vec2(next, length(beside))));
}

// Copies turned about the y axis, `count` in a full turn; the first of `cells` of them, those with their middles (at the angle
// centre from x towards z) nearest to p, in sectors from there.
float first_turn(vec3 p, float count, float cells, float centre) {
    float along = (atan(p.z, abs(p.x) + abs(p.z) > 0.0f ? p.x : 1.0f) - centre) * max(count, 1.0f) / 6.2831853f;
    float first = floor(along + 0.5f);
    return first - floor(0.5f * (along >= first ? cells - 1.0f : cells));
}

vec3 polar_repeat(vec3 p, float count, float cells, float centre, float inner, int cell) {
    float angle = (first_turn(p, count, cells, centre) + float(cell)) * 6.2831853f / max(count, 1.0f);
    float c = cos(angle);
    float s = sin(angle);
    return vec3(c * p.x + s * p.z, p.y, c * p.z - s * p.x);
}

int polar_repeat_cells(float count, float cells, float centre, float inner) {
    return int(cells);
}

// As repeat_copy and repeat_distance, with sectors of a ring in place of boxes: as wide as those cells see, from the radius
// inner on.
float polar_repeat_copy(float d, vec3 p, float count, float cells, float centre, float inner, vec3 low, vec3 high) {
    if (cells == count) return d;
    float angle = 3.1415927f * (cells - 1.0f) / count;
    vec2 edge = vec2(cos(angle), sin(angle));
    vec2 q = vec2(cos(centre) * p.x + sin(centre) * p.z, abs(cos(centre) * p.z - sin(centre) * p.x));
    float wedge = length(q - max(dot(q, edge), 0.0f) * edge);
    wedge = q.y * edge.x > q.x * edge.y ? wedge : -wedge;
    vec2 away = vec2(max(wedge, inner - length(q)), max(low.y - p.y, p.y - high.y));
    return max(d, length(max(away, 0.0f)) + min(max(away.x, away.y), 0.0f));
}

float polar_repeat_distance(float d, vec3 p, float count, float cells, float centre, float inner, vec3 low, vec3 high) {
    if (cells == count) return d;
    float sector = 6.2831853f / count;
    float along = (atan(p.z, abs(p.x) + abs(p.z) > 0.0f ? p.x : 1.0f) - centre) / sector;
    float off = abs(along - first_turn(p, count, cells, centre) - 0.5f * (cells - 1.0f));
    float r = length(vec2(p.x, p.z));
    float next = max(r * sin(min(sector * (1.0f - off), 1.5707963f)), inner - r);
    return min(d, length(vec2(next, max(max(low.y - p.y, p.y - high.y), 0.0f))));
}

// The distance at p of content that was evaluated at the point of its bounds nearest to p; away leads from there to p.
float beyond(float d, vec3 away) {
    float outside = dot(away, away);
    return outside > 0.0f ? sqrt(outside + max(d, 0.0f) * max(d, 0.0f)) : d;
}

// ---- custom code ------------------------------------------------------------------------------------------------------
// The code counts within a box around the origin, and what it shows is cut off there: so its bounds are true whatever it
// does. Outside, the value at the nearest point of the box counts as with `beyond`.

// The box's half size; 0 has no end along that axis.
vec3 custom_reach(vec3 bounds) {
    return bounds + 1e9f * (1.0f - step(1e-9f, bounds));
}

vec3 nearest_custom(vec3 p, vec3 bounds) {
    return clamp(p, -custom_reach(bounds), custom_reach(bounds));
}

// From the value of the code at the point nearest_custom of p. What is no number counts as no shape.
float custom_distance(float value, float lipschitz, vec3 p, vec3 nearest, vec3 bounds) {
    float safe = value / lipschitz;
    safe = safe < 1e9f ? max(safe, -1e9f) : 1e9f;
    vec3 inside = abs(nearest) - custom_reach(bounds);
    return beyond(max(safe, max(inside.x, max(inside.y, inside.z))), p - nearest);
}

// Turns the content about the y axis, rate radians for each metre of height.
vec3 twist(vec3 p, float rate) {
    float c = cos(rate * p.y);
    float s = sin(rate * p.y);
    return vec3(c * p.x + s * p.z, p.y, c * p.z - s * p.x);
}

// The distance to content that is turned by an angle that grows with place, at distance s from the axis of turning. Within
// radius s that stretches by at most 1 + k s, on the way to the content nowhere by more than `stretch`. A path of length r
// from p stays within s + r of the axis; so r is safe where (1 + k (s + r)) r <= |d|, and the largest such r is
// 2 |d| / (b + sqrt(b² + 4 k |d|)) with b = 1 + k s. Both bounds are 1-Lipschitz.
float turned_distance(float d, float s, float k, float stretch) {
    float b = 1.0f + k * s;
    return d * max(2.0f / (b + sqrt(b * b + 4.0f * k * abs(d))), 1.0f / stretch);
}

// A twist is a shear; k s is its slope at distance s from the axis.
float twist_stretch(float rate, float s) {
    float k = abs(rate) * s;
    return 0.5f * (k + sqrt(k * k + 4.0f));
}

// `reach`: how far the content reaches from the y axis.
float twist_distance(float d, vec3 p, float rate, float reach) {
    return turned_distance(d, length(vec2(p.x, p.z)), abs(rate), twist_stretch(rate, reach));
}

// Turns the content about the z axis, rate radians for each metre along x: what lies along x bends up, or down where the
// rate is negative ("cheap bend").
vec3 bend(vec3 p, float rate) {
    float c = cos(rate * p.x);
    float s = sin(rate * p.x);
    return vec3(c * p.x + s * p.y, c * p.y - s * p.x, p.z);
}

float bend_stretch(float rate, float s) {
    return 1.0f + abs(rate) * s;
}

// `reach`: how far the content reaches from the z axis.
float bend_distance(float d, vec3 p, float rate, float reach) {
    return turned_distance(d, length(vec2(p.x, p.y)), abs(rate), bend_stretch(rate, reach));
}

// Width of tapered content at height y, relative to the width at 0.
float taper_width(float y, float rate) {
    return clamp(1.0f + rate * y, 0.05f, 20.0f);
}

// Makes the content wider or narrower as it goes up. What lies further from the axis than the content reaches is evaluated at
// its edge: out there the map stretches more and more.
vec3 taper(vec3 p, float rate, float narrowest, float reach) {
    float width = taper_width(p.y, rate);
    float inwards = 1.0f / max(width, length(vec2(p.x, p.z)) / max(reach, 1e-9f));
    return vec3(p.x * inwards, p.y, p.z * inwards);
}

// The norm of (a, b; 0, 1): how much the taper stretches where the width is 1 / a and changes across by b for each metre up.
float taper_norm(float a, float b) {
    float sum = a * a + b * b + 1.0f;
    return sqrt(0.5f * (sum + sqrt(max(sum * sum - 4.0f * a * a, 0.0f))));
}

float taper_stretch(float rate, float narrowest, float reach) {
    return taper_norm(1.0f / narrowest, reach * abs(rate) / narrowest);
}

// Where the width is w the stretch is at most n / min(w, 1), n = taper_norm(1, slope) with slope = reach |rate|, and on a
// path of length r the width shrinks by at most |rate| r: so r = d w / (n + |rate| d) is safe, up to d / n; and everywhere
// the stretch at the narrowest place is. All of these are 1-Lipschitz. The content keeps within a frustum of that slope; how
// far p is out of it, measured across, grows by up to sqrt(1 + slope²). Out there the content's distance does not change
// with how far, so the same stretch holds.
float taper_distance(float d, vec3 p, float rate, float narrowest, float reach) {
    float slope = reach * abs(rate);
    float n = taper_norm(1.0f, slope);
    float width = taper_width(p.y, rate);
    float share = max(min(1.0f / n, width / (n + abs(rate * d))), 1.0f / taper_stretch(rate, narrowest, reach));
    return max(d * share, (length(vec2(p.x, p.z)) - reach * width) / sqrt(1.0f + slope * slope));
}

// Scales each axis by a factor of its own. Along the axis of the smallest one distances shrink by that much.
vec3 stretch(vec3 p, vec3 factors) {
    return p / factors;
}

float stretch_distance(float d, vec3 p, vec3 factors) {
    return d * min(factors.x, min(factors.y, factors.z));
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

// Adds to a distance, safely: what is added never exceeds `height` and nowhere changes faster than `slope`.
float displaced(float d, float added, float height, float slope) {
    return clamp((d + added) / (1.0f + slope), d - height, d + height);
}

// Waves in all three directions; the gradient of sin x sin y sin z is at most 1.
float displace_sine(float d, vec3 p, float amplitude, float wavelength) {
    float k = 6.2831853f / wavelength;
    return displaced(d, amplitude * sin(k * p.x) * sin(k * p.y) * sin(k * p.z), amplitude, amplitude * k);
}

// A number from -1 to 1 for each point with whole coordinates. After Jarzynski and Olano, "Hash Functions for GPU
// Rendering" (2020), pcg3d.
float lattice_value(ivec3 i) {
    uint x = uint(i.x) * 1664525u + 1013904223u;
    uint y = uint(i.y) * 1664525u + 1013904223u;
    uint z = uint(i.z) * 1664525u + 1013904223u;
    x += y * z;
    y += z * x;
    z += x * y;
    x ^= x >> 16u;
    y ^= y >> 16u;
    z ^= z >> 16u;
    x += y * z;
    return float(x >> 8u) / 8388607.5f - 1.0f;
}

// Values between the lattice's, from -1 to 1: trilinear in w = 6 t^5 - 15 t^4 + 10 t^3. The gradient is at most 3.75: with
// weights w the derivatives D of a multilinear function of that range fulfil sum w (1 - w) D² <= 1 (Efron and Stein, 1981),
// and w'(t)² / (w (1 - w)) is largest, 3.75², in the middle.
float value_noise(vec3 p) {
    vec3 cell = floor(p);
    vec3 t = p - cell;
    vec3 w = t * t * t * (t * (t * 6.0f - vec3(15.0f)) + vec3(10.0f));
    ivec3 i = ivec3(clamp(cell, vec3(-2e9f), vec3(2e9f)));
    float low = mix(mix(lattice_value(i), lattice_value(i + ivec3(1, 0, 0)), w.x),
                    mix(lattice_value(i + ivec3(0, 1, 0)), lattice_value(i + ivec3(1, 1, 0)), w.x), w.y);
    float high = mix(mix(lattice_value(i + ivec3(0, 0, 1)), lattice_value(i + ivec3(1, 0, 1)), w.x),
                     mix(lattice_value(i + ivec3(0, 1, 1)), lattice_value(i + ivec3(1, 1, 1)), w.x), w.y);
    return mix(low, high, w.z);
}

// Octaves of noise, each of half the size and half the height of the one before: of equal slope.
float displace_noise(float d, vec3 p, float amplitude, float size, float octaves) {
    float added = 0.0f;
    float height = 0.0f;
    float share = 1.0f;
    for (int i = 0; i < 8; ++i) {
        if (float(i) >= octaves) break;
        added += share * value_noise(p / (share * size));
        height += share;
        share *= 0.5f;
    }
    return displaced(d, amplitude * added, amplitude * height, amplitude * 3.75f * octaves / size);
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

// ---- how far a ray may go --------------------------------------------------------------------------------------------
// For the tracer a node has two numbers: its distance, and how far along the ray, at least, its distance stays above a level.

// From the distance of a convex shape and its slope along the ray: a convex function stays above its tangent, so that Newton's
// method never passes where it meets the level.
vec2 advance(vec2 along, float level) {
    return vec2(along.x, max(along.x - level, 0.0f) / max(-along.y, 1e-20f));
}

// The same of the smooth union of two convex shapes. Along the ray it is at least that of the tangents, a + t a' and b + t b',
// which is concave in t and so meets the level once: where the nearer one does, if the other is too far to blend, or else where
// the parabola of the blend does, (a + b) / 2 - (1/4) radius - (a - b)² / (4 radius), the second time.
vec2 smooth_union_advance(vec2 a, vec2 b, float radius, float level) {
    float d = smooth_union(a.x, b.x, radius);
    float hard = min(advance(a, level).y, advance(b, level).y);
    vec2 apart = a - b;
    vec2 middle = 0.5f * (a + b) - vec2(0.25f * radius + level, 0.0f);
    float q = apart.y * apart.y / (4.0f * radius);
    float l = middle.y - 0.5f * apart.x * apart.y / radius;
    float c = middle.x - apart.x * apart.x / (4.0f * radius);
    float root = sqrt(max(l * l + 4.0f * q * c, 0.0f));
    float blended = l < 0.0f ? 2.0f * c / (root - l) : (l + root) / max(2.0f * q, 1e-20f);
    return vec2(d, max(d - level, abs(apart.x + min(hard, 1e9f) * apart.y) >= radius ? hard : blended));
}

// How far a ray gets before a convex shape is as near as three levels, and a shape that a box holds.
vec3 ways_to(vec2 along, vec3 levels) {
    return max(vec3(along.x) - levels, vec3(0.0f)) / max(-along.y, 1e-20f);
}

vec3 ways_to_box(float d, vec3 levels, vec3 p, vec3 v, vec3 half_size) {
    return max(vec3(d) - levels, ways_to(box_along(p, v, half_size), levels));
}

// Of several shapes in a smooth union, from the ways of each to the level, to that and what the union adds, and to a radius
// more: the least of each, and the second least of the last.
vec4 nearer_ways(vec4 least, vec3 ways) {
    return vec4(min(least.x, ways.x), min(least.y, ways.y), min(least.z, ways.z), min(least.w, max(least.z, ways.z)));
}

// The union comes down to the level where one of its shapes does, or two are as near as to blend.
float way_to_blend(vec4 least) {
    return max(least.y, min(least.x, least.w));
}

// From the distance and the box that holds the shape, seen from its centre.
vec2 advance_in_box(float d, float level, vec3 p, vec3 v, vec3 half_size) {
    vec2 to_box = box_along(p, v, half_size);
    return vec2(d, max(d - level, max(to_box.x - level, 0.0f) / max(-to_box.y, 1e-20f)));
}

// How far a ray goes until it is where a span begins; 1e20 if it never is.
float way_into(vec2 span) {
    return span.x <= span.y && span.y >= 0.0f ? max(span.x, 0.0f) : 1e20f;
}

// What two spans have in common.
vec2 span_of_both(vec2 a, vec2 b) {
    return vec2(max(a.x, b.x), min(a.y, b.y));
}

// From t on, how far it goes until it is outside of what is taken away, which counts a little larger: of two surfaces at the
// same place nothing is left.
float way_out_of(vec2 span, float t) {
    float slack = 1e-6f * (1.0f + t);
    return t >= span.x - slack && t < span.y + slack ? span.y + slack : t;
}
