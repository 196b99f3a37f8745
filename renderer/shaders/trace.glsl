// Ray buffer to hit buffer: how far each ray gets in the scene. The generated distance function stands before this.
//
// Auto-relaxed sphere tracing (Bán and Valasek, "Automatic Step Size Relaxation in Sphere Tracing", 2023): the step is
// stretched by the slope of the distance seen so far and taken back where the spheres of two steps do not overlap.
// beta = 0.5 saves 23 to 29 % of the evaluations of diffuse rays.
//
// Where lanes run in step, as in llvmpipe's eight, all wait for the longest of their rays: shadow rays of the Cornell room
// took 84 evaluations' time for 25. So they have several rays each (`rays_each`), and those whose ray has ended take the next
// of all these after every `pause` evaluations (after Aila and Laine, "Understanding the Efficiency of Ray Traversal on
// GPUs", 2009). One call site: Mesa inlines every call, and each further copy of the scene costs compile time, not speed. Loops
// end with their conditions: llvmpipe runs a loop that begins with its condition once more, with nothing to do.
layout(local_size_x = 64) in;

uniform uint ray_count;
#if shares_rays
uniform uint rays_each;
#endif
uniform int pause;
uniform uint part;           // which part of the scene this is; 0 is the first
uniform int any_hit;         // 1: a ray that met an earlier part looks for nothing more
uniform vec3 scene_low;      // all surfaces lie within this box
uniform vec3 scene_high;

// A field that is flatter than the distance (GeneratedScene::flat) falls below the tolerance long before the surface, so that
// shapes would grow fat: there the tolerance shrinks with the field's slope along the ray. That costs 4 to 7 % and is left
// out elsewhere; it needs more steps, too. Where a ray has left such a surface its field stays below the tolerance for long:
// what grows along the ray is no hit (a sphere twisted by 10,000 degrees per metre was black).
const float least_slope = flat_field ? 0.1 : 1.0;
const int usual_limit = flat_field ? 512 : 256;
const float beta = 0.5;
const float near_enough = 2e-3;  // radians: one to three pixels of a camera ray

void main() {
    load_parameters();
#if shares_rays
    // Lanes that run in step take the next of their common rays.
    uint lanes = gl_SubGroupSizeARB, lane = gl_SubGroupInvocationARB;
    uint next_ray = (gl_GlobalInvocationID.x - lane) * rays_each;
    uint end = min(ray_count, next_ray + lanes * rays_each);
#else
    uint next_ray = gl_GlobalInvocationID.x;
    uint end = min(ray_count, next_ray + 1u);
#endif
    int most_steps = step_limit > 0 ? step_limit : usual_limit;
    Ray ray;
    uint i;
    float footprint, spacing, reach, t, radius, free, stride, slope;
    int steps;
    bool found, marching = false;
    do {
        // The next ray that comes near this part.
        bool some_without;
        do {
            i = marching ? i : next_ray;
#if shares_rays
            uint without = unpackUint2x32(ballotARB(!marching)).x;
            if (!marching) i += uint(bitCount(without & ((1u << lane) - 1u)));
            next_ray += uint(bitCount(without));
#else
            ++next_ray;
#endif
            if (!marching && i < end) {
                ray = load_ray(i);
                float met = part > 0u ? load_hit(i).distance : -1.0;
                footprint = ray.footprint * exp2(minimum_step);
                spacing = float_spacing(ray.origin);
                // Where the ray is within the part's bounds.
                vec3 inverse_direction = 1.0 / mix(ray.direction, vec3(1e-20), lessThan(abs(ray.direction), vec3(1e-20)));
                vec3 to_low = (scene_low - ray.origin) * inverse_direction;
                vec3 to_high = (scene_high - ray.origin) * inverse_direction;
                vec3 enter = min(to_low, to_high);
                vec3 leave = max(to_low, to_high);
                reach = met < 0.0 ? ray.reach : any_hit == 1 ? 0.0 : met;
                reach = min(reach, min(leave.x, min(leave.y, leave.z)));
                t = max(0.0, max(enter.x, max(enter.y, enter.z)));  // nothing lies before this
                radius = 0.0;  // distance there
                free = 0.0;    // how far it may go on from there
                stride = 0.0;  // step being tried
                slope = -1.0;  // of the distance along the ray, smoothed
                steps = 0;
                found = false;
                marching = t < reach;
                if (part == 0u && !marching) {
                    hits[i].distance = -1.0;
                    hits[i].steps = 0u;
                }
            }
#if shares_rays
            some_without = unpackUint2x32(ballotARB(!marching)).x != 0u;
#else
            some_without = !marching;
#endif
        } while (some_without && next_ray < end);
        bool traced = marching;
        int left = pause;
        do {
            float next = t + stride;
            vec2 there = scene_march(ray.origin + next * ray.direction, ray.direction);
            float d = there.x;
            if (marching) {
                ++steps;
                // A stretched step that ends inside something is taken back too, or the hit would lie that deep in it.
                if (stride <= free + max(d, 0.0)) {
                    bool leaving = flat_field && (stride > 0.0 ? d >= radius : d > 0.0);
                    slope = stride > 0.0 ? mix(clamp((d - radius) / stride, -1.0, 0.9), slope, beta) : -1.0;
                    t = next;
                    radius = d;
                    free = max(there.y, max(d, 0.0));
                    found = !leaving && d < hit_tolerance(footprint, spacing, t) * clamp(-slope, least_slope, 1.0);
                } else {
                    slope = -1.0;
                }
                stride = max(free, 2.0 * max(radius, 0.0) / (1.0 - slope));
                marching = !found && t + free < reach && steps < most_steps;
            }
            --left;
        } while (marching && left > 0);
        if (traced && !marching) {
            // Out of steps: a ray that grazes a surface has met it, any other has met nothing. Where it stands now decides;
            // the nearest miss of the whole way would draw fringes around what a ray to the horizon passes.
            bool exhausted = steps >= most_steps && !found && t + free < reach;
            bool left_behind = flat_field && slope > 0.0;
            found = found || (exhausted && !left_behind && radius < near_enough * t);
            if (found) t += max(radius, 0.0);
            Hit earlier = load_hit(i);  // in another part
            float met = part > 0u ? earlier.distance : -1.0;
            uint others = part > 0u ? earlier.steps : 0u;
            bool nearest = found && t < (met < 0.0 ? ray.reach : met);
            hits[i].distance = nearest ? t : met;
            hits[i].steps = min((others & steps_mask) + uint(steps), steps_mask) | (exhausted ? exhausted_flag : others & exhausted_flag) |
                            (nearest ? part : others >> part_shift) << part_shift;
        }
    } while (marching || next_ray < end);
}
