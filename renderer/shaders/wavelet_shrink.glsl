// One level of the estimate, after wavelet_coarsest.glsl, down to the accumulated light: adds the level's detail to the coarser
// estimate as far as it is more than noise. James-Stein shrinkage by b² / (b² + v), where b² = max(0, <detail²> - k <v>) and < >
// are means over the surface around. Above level 0, which has the same grid, it then leaves the detail of that. And adds up what
// squared error is to be expected, b² from the same means without k (Stein 1981, "Estimation of the mean of a multivariate normal
// distribution").
layout(local_size_x = 64) in;

layout(binding = 0) uniform samplerBuffer detail;   // w: variance of the level's noise
layout(binding = 1) uniform samplerBuffer coarser;  // w: variance of a single pixel, averaged as widely as anything
layout(binding = 2) uniform samplerBuffer guide;
layout(binding = 5) uniform samplerBuffer coarser_risk;
layout(std430, binding = 0) writeonly buffer Estimate { vec4 estimate[]; };
layout(std430, binding = 2) writeonly buffer Risk { float risk[]; };
#if leaves_detail
layout(binding = 3) uniform samplerBuffer finest_far;
layout(binding = 4) uniform samplerBuffer finest_near;
layout(std430, binding = 1) writeonly buffer Finest { vec4 finest_detail[]; };
#endif

uniform ivec2 grid_size;
uniform ivec2 coarser_size;  // of the grid of the coarser risk
uniform int coarser_step;    // places of this grid for one of that
uniform int spacing;  // pixels from one place of the grid to the next
uniform int stride;   // places of the grid for one of the wavelet's steps
uniform float evenness;  // what the noise is of what is expected, see wavelet_evenness.glsl

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, grid_size))) return;
    uint cell = index_in(grid_size, at);
    vec4 here = texelFetch(guide, int(cell));
    // tangent_distance of the taps: linear in their place but for the depth.
    vec3 ray = ray_at(spacing * at);
    float slope = dot(here.xyz, ray), sharpness = surface_sharpness(here);
    int step_width = spacing * stride;
    float across = dot(here.xyz, ray_at(spacing * at + ivec2(step_width, 0)) - ray);
    float down = dot(here.xyz, ray_at(spacing * at + ivec2(0, step_width)) - ray);
    float energy = 0.0, noise = 0.0, total = 0.0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            ivec2 tap = at + stride * ivec2(x, y);
            bool inside = all(greaterThanEqual(tap, ivec2(0))) && all(lessThan(tap, grid_size));
            int place = inside ? int(index_in(grid_size, tap)) : int(cell);
            vec4 there = texelFetch(guide, place);
            float distance = there.w * (slope + float(x) * across + float(y) * down) - here.w * slope;
            float weight = inside ? same_surface(here, there, distance, sharpness) : 0.0;
            vec4 d = texelFetch(detail, place);
            energy += weight * dot(d.rgb, d.rgb) / 3.0;
            noise += weight * d.w;
            total += weight;
        }
    noise *= evenness;
    // Where few paths have brought what light there is, a detail's noise is as uncertain as the light itself: the bright paths
    // pass for detail, the dark between them does not, and light would be gained. See METHOD.md.
    vec4 so_far = texelFetch(coarser, int(cell));
    float uncertain = noise / (noise + 0.1 * dot(so_far.rgb, so_far.rgb) / 3.0 + 1e-30);
    float bias = max(energy - (0.6 + 2.5 * uncertain) * noise, 0.0);  // k: measured, see METHOD.md
    float alpha = bias > 0.0 ? bias / (bias + noise) : 0.0;
    vec4 result = vec4(so_far.rgb + alpha * texelFetch(detail, int(cell)).rgb, so_far.w);
    estimate[cell] = result;
    float left = alpha * alpha * noise + (1.0 - alpha) * (1.0 - alpha) * (energy - noise);
    int coarser_cell = int(index_in(coarser_size, at / coarser_step));
    risk[cell] = texelFetch(coarser_risk, coarser_cell).r + max(left, 0.0) / max(total, 1e-6);
#if leaves_detail
    vec4 near = texelFetch(finest_near, int(cell));
    finest_detail[cell] = vec4(texelFetch(finest_far, int(cell)).rgb + near.rgb - result.rgb, noise_of_detail(near.w, 1.0, so_far.w, 0));
#endif
}
