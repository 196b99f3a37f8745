// What one level of the wavelet says beyond the coarser estimate, and the variance of its noise. A level's irradiance / pi is
// A B[F] / B[A] + B[N]: mean far radiance, which is smooth, times the pixel's own openness, plus near light.
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D far_light;
layout(binding = 1) uniform sampler2D near_light;
layout(binding = 2) uniform sampler2D noise_gain;
layout(binding = 3) uniform sampler2D coarser;
layout(binding = 4) uniform sampler2D coarsest_near;  // w: variance of a single pixel, averaged as widely as anything
layout(binding = 0, rgba32f) writeonly uniform image2D detail;

uniform int level;
uniform int coarsest;  // 1: there is no coarser estimate

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, image_size))) return;
    int pixel = at.y * image_size.x + at.x;
    vec4 far = texelFetch(far_light, at, 0);
    vec4 near = texelFetch(near_light, at, 0);
    vec4 whole = far_sum[pixel];
    // The pixel's own openness, as far as it has as many samples as the light: not right after the AO radius changed.
    float openness = mix(far.w, openness_at(pixel), split_near_sum[pixel].w / max(whole.w, 1.0));
    vec3 light = level == 0 ? whole.rgb / max(whole.w, 1.0)
                            : near.rgb + (far.w > 0.0 ? openness / far.w * far.rgb : vec3(0.0));
    vec3 known = coarsest == 1 ? vec3(0.0) : texelFetch(coarser, at, 0).rgb;
    imageStore(detail, at, vec4(light - known, texelFetch(noise_gain, at, 0).r * max(near.w, texelFetch(coarsest_near, at, 0).w)));
}
