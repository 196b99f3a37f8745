// How rays find what they meet: what the kernels share that trace rays. It stands between the generated functions and the
// kernel's own. What `casts` are for is met in closed form (sdf/cast_writer.h), everything else is marched.
//
// Auto-relaxed sphere tracing (Bán and Valasek, "Automatic Step Size Relaxation in Sphere Tracing", 2023): the step is
// stretched by the slope of the distance seen so far and taken back where the spheres of two steps do not overlap.
// beta = 0.5 saves 23 to 29 % of the evaluations of diffuse rays.
//
// Where lanes run in step, as in llvmpipe's eight, all wait for the longest of their rays: shadow rays of the Cornell room
// took 84 evaluations' time for 25. So they have several rays each (`rays_each`), and those whose ray has ended take the next
// of all these after every `pause` evaluations (after Aila and Laine, "Understanding the Efficiency of Ray Traversal on
// GPUs", 2009). llvmpipe ends all loops of an invocation after 65,535 turns, and with them the rays that are left. Where evaluations
// take loops, lanes therefore claim rays one by one (`claims_rays`), as long as the turns that are left suffice for each of them. Elsewhere
// that would cost 5 %, and 25 % in a family. One call site: Mesa inlines every call, and each further copy of the scene costs compile time, not speed. Loops
// end with their conditions: llvmpipe runs a loop that begins with its condition once more, with nothing to do.
layout(local_size_x = 64) in;

uniform uint ray_count;
#if claims_rays
layout(std430, binding = 4) buffer Queue { uint claimed_rays; };  // by all invocations
uniform uint turns_each;      // of loops for one evaluation, at most
uniform uint turns_of_ray;    // for one ray, at most
#elif shares_rays
uniform uint rays_each;
#endif
uniform int pause;
uniform uint part;           // which part of the scene this is; 0 is the first
uniform int any_hit;         // 1: a ray that met an earlier part looks for nothing more

// A field that is flatter than the distance (GeneratedScene::flat) falls below the tolerance long before the surface, so that
// shapes would grow fat: there the tolerance shrinks with the field's slope along the ray. That costs 4 to 7 % and is left
// out elsewhere; it needs more steps, too. Where a ray has left such a surface its field stays below the tolerance for long:
// what grows along the ray is no hit (a sphere twisted by 10,000 degrees per metre was black).
const float least_slope = flat_field ? 0.1 : 1.0;
const float beta = 0.5;
const float near_enough = 2e-3;  // radians: one to three pixels of a camera ray

// Of the rays that its lanes share, the next one and the end.
uint next_ray, end;
#if claims_rays
uint turns = 0u;  // of loops so far, at most
#endif

// The ray of the lane.
uint i;
Ray ray;
float footprint;
float spacing;
vec3 inverse_direction;
float limit;   // how far it looks
float t;       // where it is
float reach;   // where its march ends
float radius;  // distance at t
float free;    // how far it may go on from there
float stride;  // step being tried
float slope;   // of the distance along the ray, smoothed
int steps;
bool found;
bool marching = false;

void share_out_rays() {
#if claims_rays
    next_ray = 0u;
    end = ray_count;
#elif shares_rays
    // Lanes that run in step take the next of their common rays.
    next_ray = (gl_GlobalInvocationID.x - gl_SubGroupInvocationARB) * rays_each;
    end = min(ray_count, next_ray + gl_SubGroupSizeARB * rays_each);
#else
    next_ray = gl_GlobalInvocationID.x;
    end = min(ray_count, next_ray + 1u);
#endif
}

// Whether it holds for some lane of those that run in step.
bool some(bool here) {
#if shares_rays
    return unpackUint2x32(ballotARB(here)).x != 0u;
#else
    return here;
#endif
}

// The number of the next ray for each lane without one. True if it is one: then it is there.
bool take_ray(bool without) {
#if claims_rays
    turns += 2u;
    if (turns > 2u && turns + turns_of_ray > most_turns) next_ray = end;
    without = without && next_ray < end;
#endif
#if shares_rays
    uint all = unpackUint2x32(ballotARB(without)).x;
    uint before = uint(bitCount(all & ((1u << gl_SubGroupInvocationARB) - 1u)));
#if claims_rays
    if (all != 0u) {
        uint first = 0u;
        if (without && before == 0u) first = atomicAdd(claimed_rays, uint(bitCount(all)));
        next_ray = readInvocationARB(first, uint(findLSB(all)));
    }
#endif
    i = without ? next_ray + before : i;
    next_ray += uint(bitCount(all));
#else
    i = without ? next_ray : i;
    ++next_ray;
#endif
    bool taken = without && i < end;
    if (taken) {
        ray = load_ray(i);
        footprint = ray.footprint * exp2(minimum_step);
        spacing = float_spacing(ray.origin);
        inverse_direction = 1.0 / mix(ray.direction, vec3(1e-20), lessThan(abs(ray.direction), vec3(1e-20)));
    }
    return taken;
}

// How far the new ray shall look: to what it met in earlier parts.
float distance_left() {
    float met = part > 0u ? load_hit(i).distance : -1.0;
    return met < 0.0 ? ray.reach : any_hit == 1 ? 0.0 : met;
}

// Of a ray that passes everything by.
void store_nothing() {
    if (part > 0u) return;
    hits[i].distance = -1.0;
    hits[i].steps = 0u;
}

// Starts to march where the ray is in the box, if it is there before it has gone as far as it looks.
bool enter(vec3 low, vec3 high) {
    vec3 to_low = (low - ray.origin) * inverse_direction;
    vec3 to_high = (high - ray.origin) * inverse_direction;
    vec3 first = min(to_low, to_high);
    vec3 last = max(to_low, to_high);
    reach = min(limit, min(last.x, min(last.y, last.z)));
    t = max(0.0, max(first.x, max(first.y, first.z)));  // nothing lies before this
    radius = 0.0;
    free = 0.0;
    stride = 0.0;
    slope = -1.0;
    steps = 0;
    found = false;
    return t < reach;
}

#if !marches
// Of a member of a family, for which nothing is to be marched.
void march() {
    t = scene_cast(ray.origin, ray.direction);
    found = marching && t < limit;
    steps = 1;
    marching = false;
}
#else
// As far as `pause` allows.
void march() {
    int most_steps = step_limit > 0 ? step_limit : usual_limit;
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
#if claims_rays
    turns += uint(pause) * turns_each + turns_of_march;
#endif
}
#endif

// Of a ray that marches no more: whether it has run out of steps. One that grazes a surface has met it, any other has met
// nothing. Where it stands now decides; the nearest miss of the whole way would draw fringes around what a ray to the horizon
// passes.
bool arrive() {
    int most_steps = step_limit > 0 ? step_limit : usual_limit;
    bool exhausted = steps >= most_steps && !found && t + free < reach;
    bool left_behind = flat_field && slope > 0.0;
    found = found || (exhausted && !left_behind && radius < near_enough * t);
    if (found) t += max(radius, 0.0);
    return exhausted;
}

// Adds what the ray has met in this part, if anything, at a distance, as `code` of what shows there, and what it took.
void store(bool met, float distance, uint code, uint taken, bool exhausted) {
    Hit earlier = load_hit(i);  // in another part
    float earlier_distance = part > 0u ? earlier.distance : -1.0;
    uint others = part > 0u ? earlier.steps : 0u;
    bool nearest = met && distance < (earlier_distance < 0.0 ? ray.reach : earlier_distance);
    hits[i].distance = nearest ? distance : earlier_distance;
    hits[i].steps = min((others & steps_mask) + taken, steps_mask) | (exhausted ? exhausted_flag : others & exhausted_flag) |
                    (nearest ? code : others >> part_shift) << part_shift;
}
