// How much smaller the noise of evenly spread samples is than the same number's by chance, at every fourth pixel: the energy of the
// finest detail around over the noise expected of it. Most places of a picture show no detail as fine, so that the median
// tells (after Donoho and Johnstone 1994, "Ideal spatial adaptation by wavelet shrinkage"). By each place's own variance, not one
// that is averaged: where single paths bring most of the light, most places have neither. See METHOD.md.
layout(local_size_x = 64) in;

layout(binding = 0) uniform samplerBuffer far_light;  // of all pixels, not yet filtered
layout(binding = 1) uniform samplerBuffer near_light;
layout(binding = 2) uniform samplerBuffer wider_far;  // of the next level, which has all pixels, too
layout(binding = 3) uniform samplerBuffer wider_near;
layout(binding = 4) uniform samplerBuffer guide;
layout(std430, binding = 0) writeonly buffer Evenness { float evenness[]; };  // 0 where there is nothing

uniform ivec2 grid_size;  // of every fourth pixel

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, grid_size))) return;
    ivec2 pixel = min(4 * at + 1, image_size - 1);
    float energy = 0.0, noise = 0.0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            ivec2 tap = clamp(pixel + ivec2(x, y), ivec2(0), image_size - 1);
            int place = int(index_in(image_size, tap));
            if (texelFetch(guide, place).w == 0.0) continue;
            vec4 near = texelFetch(near_light, place);
            vec3 detail = near.rgb + texelFetch(far_light, place).rgb - texelFetch(wider_near, place).rgb - texelFetch(wider_far, place).rgb;
            energy += dot(detail, detail) / 3.0;
            noise += noise_of_detail(near.w, 1.0, 0.0, 0);
        }
    // The factor and what few samples add are measured.
    float samples = load(far_texels, index_in(image_size, pixel)).w;
    evenness[index_in(grid_size, at)] = noise > 0.0 && samples > 0.0 ? 2.0 * energy / noise + 2.0 / samples : 0.0;
}
