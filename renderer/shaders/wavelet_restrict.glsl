// A level of the wavelet at the places of the next grid: each takes its share of the places around it, and each of those gives
// all it has to the places of the next grid beside it. Taking every second place alone would be cheaper, but where a surface is
// few places wide the mean would depend on which of them are taken: see METHOD.md.
layout(local_size_x = 64) in;

layout(binding = 0) uniform samplerBuffer far_source;
layout(binding = 1) uniform samplerBuffer near_source;
layout(binding = 2) uniform samplerBuffer gain_source;
layout(binding = 3) uniform samplerBuffer right;  // links of the source's grid, see wavelet_links.glsl
layout(binding = 4) uniform samplerBuffer below;
layout(std430, binding = 0) writeonly buffer Far { vec4 far_target[]; };
layout(std430, binding = 1) writeonly buffer Near { vec4 near_target[]; };
layout(std430, binding = 2) writeonly buffer Gain { float gain_target[]; };

uniform ivec2 grid_size;
uniform ivec2 source_size;

// What the place `side` (-1, 0 or 1) of `at` along an axis gives to `at`, by its links to it and to the place beyond: as strict as
// the link times same_surface, whose fourth root a link is.
float share_of(samplerBuffer links, ivec2 at, ivec2 axis, int side, int place, int last) {
    if (side == 0) return 1.0;
    if (place + side < 0 || place + side > last) return 0.0;
    float link = texelFetch(links, int(index_in(source_size, at + min(side, 0) * axis))).r, other = 0.0;
    if (place + 2 * side >= 0 && place + 2 * side <= last)
        other = texelFetch(links, int(index_in(source_size, at + (side < 0 ? -2 : 1) * axis))).r;
    float strict = link * link * link * link * link, other_strict = other * other * other * other * other;
    return strict / (strict + other_strict + 0.01);
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, grid_size))) return;
    ivec2 place = 2 * at, last = source_size - 1;
    vec4 far = vec4(0.0), near = vec4(0.0);
    float gain = 0.0, total = 0.0;
    for (int y = -1; y <= 1; ++y) {
        float row = share_of(below, place, ivec2(0, 1), y, place.y, last.y);
        if (row == 0.0) continue;
        for (int x = -1; x <= 1; ++x) {
            float weight = row * share_of(right, place + ivec2(0, y), ivec2(1, 0), x, place.x, last.x);
            if (weight == 0.0) continue;
            int tap = int(index_in(source_size, place + ivec2(x, y)));
            far += weight * texelFetch(far_source, tap);
            near += weight * texelFetch(near_source, tap);
            gain += weight * texelFetch(gain_source, tap).r;
            total += weight;
        }
    }
    uint cell = index_in(grid_size, at);
    far_target[cell] = far / total;
    near_target[cell] = near / total;
    gain_target[cell] = gain / total;
}
