// One level of the estimate, after wavelet_coarsest.glsl, down to the accumulated light: adds the level's detail to the coarser
// estimate as far as it is more than noise. James-Stein shrinkage by b² / (b² + v), where b² = max(0, <detail²> - k <v>) and < >
// are means over the surface around. Then it leaves the detail of the next finer level: its irradiance / pi less this estimate.
layout(binding = 0) uniform sampler2D detail;   // w: variance of the level's noise
layout(binding = 1) uniform sampler2D coarser;
layout(binding = 2) uniform sampler2D guide;
layout(binding = 3) uniform sampler2D finer_far;
layout(binding = 4) uniform sampler2D finer_near;
layout(binding = 5) uniform sampler2D finer_gain;
layout(binding = 6) uniform sampler2D coarsest_near;  // w: variance of a single pixel, averaged as widely as anything
layout(binding = 7) uniform sampler2D narrow_far;     // w: openness A, see narrow_level
layout(location = 0) out vec4 estimate;
layout(location = 1) out vec4 finer_detail;

uniform int level;
uniform int narrow_level;  // whose openness is the one in front

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
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
    vec3 result = so_far + alpha * texelFetch(detail, at, 0).rgb;
    estimate = vec4(result, 1.0);
    float openness = texelFetch(narrow_far, at, 0).w;
    float most_noise = texelFetch(coarsest_near, at, 0).w;
    finer_detail = wavelet_detail(texelFetch(finer_far, at, 0), texelFetch(finer_near, at, 0), texelFetch(finer_gain, at, 0).r,
                                  most_noise, level - 1, narrow_level, openness, result);
}
