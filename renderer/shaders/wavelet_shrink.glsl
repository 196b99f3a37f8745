// Adds a level's detail to the coarser estimate as far as it is more than noise: James-Stein shrinkage by b² / (b² + v), where
// b² = max(0, <detail²> - <v>) and < > are means over the surface around.
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D detail;
layout(binding = 2) uniform sampler2D guide;
layout(binding = 3) uniform sampler2D coarser;
layout(binding = 0, rgba32f) writeonly uniform image2D estimate;

uniform int level;
uniform int coarsest;  // 1: taken as it is

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, image_size))) return;
    vec4 own = texelFetch(detail, at, 0);
    if (coarsest == 1) {
        imageStore(estimate, at, vec4(own.rgb, 1.0));
        return;
    }
    // Noise of a detail for that of its level; of the B3 wavelet (Starck and Murtagh 1994): .79 / 1, .040 / .075, ...
    float share = level == 0 ? 0.79 : 0.5;
    vec4 here = texelFetch(guide, at, 0);
    vec3 position = position_at(at, here.w);
    float energy = 0.0, noise = 0.0;
    int stride = 1 << level;
    for (int y = -2; y <= 2; ++y)
        for (int x = -2 + (y & 1); x <= 2; x += 2) {
            ivec2 tap = at + stride * ivec2(x, y);
            if (any(lessThan(tap, ivec2(0))) || any(greaterThanEqual(tap, image_size))) continue;
            vec4 there = texelFetch(guide, tap, 0);
            float weight = same_surface(here, position, there, position_at(tap, there.w));
            vec4 d = texelFetch(detail, tap, 0);
            energy += weight * dot(d.rgb, d.rgb) / 3.0;
            noise += weight * share * d.w;
        }
    float bias = max(energy - 1.25 * noise, 0.0);  // k: measured, see METHOD.md
    float alpha = bias > 0.0 ? bias / (bias + noise) : 0.0;
    imageStore(estimate, at, vec4(texelFetch(coarser, at, 0).rgb + alpha * own.rgb, 1.0));
}
