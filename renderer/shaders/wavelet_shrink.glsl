// One level of the estimate, from the coarsest, taken as it is, to the accumulated light: adds the level's detail to the coarser
// estimate as far as it is more than noise. James-Stein shrinkage by b² / (b² + v), where b² = max(0, <detail²> - k <v>) and < >
// are means over the surface around. Then it leaves the detail of the next finer level: its irradiance / pi less this estimate.
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D detail;   // w: variance of the level's noise
layout(binding = 1) uniform sampler2D coarser;
layout(binding = 2) uniform sampler2D guide;
layout(binding = 3) uniform sampler2D finer_far;
layout(binding = 4) uniform sampler2D finer_near;
layout(binding = 5) uniform sampler2D finer_gain;
layout(binding = 6) uniform sampler2D coarsest_far;
layout(binding = 7) uniform sampler2D coarsest_near;  // w: variance of a single pixel, averaged as widely as anything
layout(binding = 8) uniform sampler2D narrow_far;     // w: openness A, see narrow_level
layout(binding = 0, rgba32f) writeonly uniform image2D estimate;
layout(binding = 1, rgba32f) writeonly uniform image2D finer_detail;

uniform int level;
uniform int coarsest;      // its number
uniform int narrow_level;  // whose openness is the one in front

// A B[F] / B[A] + B[N]: mean far radiance, which is smooth, times the openness of a narrow filter, plus near light.
vec3 light(vec4 far, vec3 near, float openness, int at_level) {
    float ratio = at_level > narrow_level && far.w > 0.0 ? openness / far.w : 1.0;
    return near + ratio * far.rgb;
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, image_size))) return;
    vec4 here = texelFetch(guide, at, 0);
    // tangent_distance of the taps: linear in their place but for the depth.
    vec3 ray = ray_at(at);
    float slope = dot(here.xyz, ray);
    int stride = 1 << level;
    float across = dot(here.xyz, ray_at(at + ivec2(stride, 0)) - ray), down = dot(here.xyz, ray_at(at + ivec2(0, stride)) - ray);
    float energy = 0.0, noise = 0.0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            ivec2 tap = at + stride * ivec2(x, y);
            bool inside = all(greaterThanEqual(tap, ivec2(0))) && all(lessThan(tap, image_size));
            tap = clamp(tap, ivec2(0), image_size - 1);
            vec4 there = texelFetch(guide, tap, 0);
            float distance = there.w * (slope + float(x) * across + float(y) * down) - here.w * slope;
            float weight = inside ? same_surface(here, there, distance) : 0.0;
            vec4 d = texelFetch(detail, tap, 0);
            energy += weight * dot(d.rgb, d.rgb) / 3.0;
            noise += weight * d.w;
        }
    // Where few paths have brought what light there is, a detail's noise is as uncertain as the light itself: the bright paths
    // pass for detail, the dark between them does not, and light would be gained. See METHOD.md.
    vec3 so_far = texelFetch(coarser, at, 0).rgb;
    float uncertain = noise / (noise + 0.1 * dot(so_far, so_far) / 3.0 + 1e-30);
    float bias = max(energy - (1.25 + 2.5 * uncertain) * noise, 0.0);  // k: measured, see METHOD.md
    float alpha = bias > 0.0 ? bias / (bias + noise) : 0.0;
    float openness = texelFetch(narrow_far, at, 0).w;
    vec4 widest = texelFetch(coarsest_near, at, 0);
    vec3 result = level == coarsest ? light(texelFetch(coarsest_far, at, 0), widest.rgb, openness, level)
                                    : so_far + alpha * texelFetch(detail, at, 0).rgb;
    imageStore(estimate, at, vec4(result, 1.0));
    if (level == 0) return;
    vec4 near = texelFetch(finer_near, at, 0);
    vec3 finer = light(texelFetch(finer_far, at, 0), near.rgb, openness, level - 1);
    // Noise of a detail for that of its level; of the B3 wavelet (Starck and Murtagh 1994): .79 / 1, .040 / .075, ...
    float share = level == 1 ? 0.79 : 0.5 * texelFetch(finer_gain, at, 0).r;
    imageStore(finer_detail, at, vec4(finer - result, share * max(near.w, widest.w)));
}
