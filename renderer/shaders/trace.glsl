// Ray buffer to hit buffer: the only kernel that knows the scene. The generated distance function stands before this.
//
// Auto-relaxed sphere tracing (Bán and Valasek, "Automatic Step Size Relaxation in Sphere Tracing", 2023): the step is
// stretched by the slope of the distance seen so far and taken back where the spheres of two steps do not overlap.
// beta = 0.5 saves 23 to 29 % of the evaluations of diffuse rays. One loop with one call site: Mesa inlines every call, and
// each further copy of the scene costs compile time, not speed.
layout(local_size_x = 64) in;

layout(std430, binding = 12) buffer Counters { uint counted_rays; uint counted_steps; uint exhausted_rays; };

uniform uint ray_count;
uniform int surface_wanted;  // 1: also normal and material; 0: the distance is enough (shadow, occlusion)
uniform int counting;        // 1: add to the counters
uniform vec3 scene_low;      // all surfaces lie within this box
uniform vec3 scene_high;

// A field that is flatter than the distance (GeneratedScene::flat) falls below the tolerance long before the surface, so that
// shapes would grow fat: there the tolerance shrinks with the field's slope along the ray. That costs 4 to 7 % and is left
// out elsewhere; it needs more steps, too.
const float least_slope = flat_field ? 0.1 : 1.0;
const int step_limit = flat_field ? 512 : 256;
const float beta = 0.5;
const float near_enough = 2e-3;  // radians: one to three pixels of a camera ray
const float smallest_epsilon = 1e-5;

void main() {
    load_parameters();
    uint i = gl_GlobalInvocationID.x;
    if (i >= ray_count) return;
    Ray ray = rays[i];

    float footprint = ray.footprint * exp2(minimum_step);
    float spacing = 2.5e-7 * max(abs(ray.origin.x), max(abs(ray.origin.y), abs(ray.origin.z)));
    // Where the ray is within the scene's bounds.
    vec3 inverse_direction = 1.0 / mix(ray.direction, vec3(1e-20), lessThan(abs(ray.direction), vec3(1e-20)));
    vec3 to_low = (scene_low - ray.origin) * inverse_direction;
    vec3 to_high = (scene_high - ray.origin) * inverse_direction;
    vec3 enter = min(to_low, to_high);
    vec3 leave = max(to_low, to_high);
    float reach = min(ray.reach, min(leave.x, min(leave.y, leave.z)));

    float t = max(0.0, max(enter.x, max(enter.y, enter.z)));  // nothing lies before this
    float radius = 0.0;    // distance there
    float stride = 0.0;    // step being tried
    float slope = -1.0;    // of the distance along the ray, smoothed
    float epsilon = 0.0;
    bool found = false;
    int steps = 0;
    while (t < reach && !found && steps < step_limit) {
        float next = t + stride;
        float d = scene_distance(ray.origin + next * ray.direction);
        ++steps;
        // A stretched step that ends inside something is taken back too, or the hit would lie that deep in it.
        if (stride <= radius + max(d, 0.0)) {
            slope = stride > 0.0 ? mix(clamp((d - radius) / stride, -1.0, 0.9), slope, beta) : -1.0;
            t = next;
            radius = d;
            epsilon = max(smallest_epsilon, max(footprint * t, spacing + 2.5e-7 * t));
            found = d < epsilon * clamp(-slope, least_slope, 1.0);
        } else {
            slope = -1.0;
        }
        stride = 2.0 * max(radius, 0.0) / (1.0 - slope);
    }
    bool exhausted = steps >= step_limit && !found && t < reach;
    // Out of steps: a ray that grazes a surface has met it, any other has met nothing. Where it stands now decides; the
    // nearest miss of the whole way would draw fringes around what a ray to the horizon passes.
    found = found || (exhausted && radius < near_enough * t);
    if (found) t += max(radius, 0.0);
    found = found && t < ray.reach;

    vec3 p = ray.origin + t * ray.direction;
    vec3 gradient = vec3(0.0);
    uint material = 0u;
    // A loop, not an if: llvmpipe skips only loops. The corners' evaluations bring the material along, so that the scene stands
    // in the program twice, not three times.
    int corners = found ? surface_wanted * 4 : 0;
    for (int k = 0; k < corners; ++k) {
        // Corners of a tetrahedron: (1,1,1), (1,-1,-1), (-1,1,-1), (-1,-1,1).
        vec3 e = vec3(k < 2 ? 1.0 : -1.0, (k & 1) == 0 ? 1.0 : -1.0, k == 0 || k == 3 ? 1.0 : -1.0);
        gradient += e * scene_surface(p + e * max(epsilon, 4.0 * spacing + 1e-4), material);
    }

    float steepness = dot(gradient, gradient);
    vec3 normal = steepness > 0.0 ? gradient * inversesqrt(steepness) : -ray.direction;
    hits[i] = Hit(found ? t : -1.0, pack_normal(normal), material, uint(steps) | (exhausted ? 0x80000000u : 0u));

    int counted = ray.reach > 0.0 ? counting : 0;
    for (int k = 0; k < counted; ++k) {
        atomicAdd(counted_rays, 1u);
        atomicAdd(counted_steps, uint(steps));
        if (exhausted) atomicAdd(exhausted_rays, 1u);
    }
}
