// The coarser estimate at the places of a finer grid, and what the level there has beyond it. Between two places of the coarse
// grid their mean, as far as they lie on the same surface and nothing cuts the way there. Where hardly any does, as on what is
// narrower than the coarse grid, the level itself, and what is around it at the wavelet's next step: the same surface there or,
// for want of that, one that is near and does not face away.
layout(local_size_x = 64) in;

layout(binding = 0) uniform samplerBuffer estimate;
layout(binding = 1) uniform samplerBuffer guide;
layout(binding = 2) uniform samplerBuffer right;  // links, see wavelet_links.glsl
layout(binding = 3) uniform samplerBuffer below;
layout(binding = 4) uniform samplerBuffer far_light;
layout(binding = 5) uniform samplerBuffer near_light;
layout(binding = 6) uniform samplerBuffer gain;
layout(binding = 7) uniform samplerBuffer narrow_far;  // w: openness A, see narrow_level
layout(std430, binding = 0) writeonly buffer Coarser { vec4 coarser[]; };
layout(std430, binding = 1) writeonly buffer Detail { vec4 detail[]; };  // w: variance of its noise

uniform ivec2 grid_size;
uniform int spacing;       // pixels from one place of the grid to the next
uniform ivec2 coarse_size;
uniform int level;
uniform int narrow_level;  // whose openness is the one in front
uniform ivec2 narrow_size;
uniform int narrow_step;   // places of its grid for one of this
uniform int of_far_light;  // 1: the estimate is the coarsest far light, and nothing else is wanted

// w: variance of a single pixel.
vec4 light_at(int place, float openness) {
    vec4 far = texelFetch(far_light, place), near = texelFetch(near_light, place);
    return of_far_light == 1 ? far : vec4(wavelet_light(far, near.rgb, level, narrow_level, openness), near.w);
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, grid_size))) return;
    int cell = int(index_in(grid_size, at));
    vec4 here = texelFetch(guide, cell);
    vec3 ray = ray_at(spacing * at);
    float slope = dot(here.xyz, ray), sharpness = surface_sharpness(here);
    float across = dot(here.xyz, ray_at(spacing * (at + ivec2(1, 0))) - ray), down = dot(here.xyz, ray_at(spacing * (at + ivec2(0, 1))) - ray);
    float openness = texelFetch(narrow_far, int(index_in(narrow_size, narrow_step * at))).w;
    vec4 own = light_at(cell, openness), sum = vec4(0.0);
    float total = 0.0;
    for (int i = 0; i < 4; ++i) {
        // To the left or right, above or below; the place itself where the coarse grid has it.
        ivec2 side = ivec2(2 * (i & 1) - 1, 2 * (i >> 1) - 1) * (at & 1);
        ivec2 tap = at + side;
        bool inside = all(lessThan(tap, grid_size)) && ((i & 1) == 0 || side.x != 0) && ((i & 2) == 0 || side.y != 0);
        tap = min(tap, grid_size - 1);
        float beside = texelFetch(right, cell - (side.x < 0 ? 1 : 0)).r;
        float over = texelFetch(below, int(index_in(grid_size, ivec2(tap.x, at.y - (side.y < 0 ? 1 : 0))))).r;
        float way = min(side.x == 0 ? 1.0 : beside, side.y == 0 ? 1.0 : over);
        vec4 there = texelFetch(guide, int(index_in(grid_size, tap)));
        float distance = there.w * (slope + float(side.x) * across + float(side.y) * down) - here.w * slope;
        float weight = inside ? way * same_surface(here, there, distance, sharpness) : 0.0;
        sum += weight * texelFetch(estimate, int(index_in(coarse_size, tap >> 1)));
        total += weight;
    }
    vec4 level_sum = own;
    float level_total = 1.0;
    int taps = total < 0.3 ? 9 : 0;
    for (int i = 0; i < taps; ++i) {
        ivec2 side = ivec2(i % 3 - 1, i / 3 - 1), tap = at + 2 * side;
        if (i == 4 || any(lessThan(tap, ivec2(0))) || any(greaterThanEqual(tap, grid_size))) continue;
        int place = int(index_in(grid_size, tap));
        vec4 there = texelFetch(guide, place);
        if (there.w == 0.0) continue;
        float distance = there.w * (slope + 2.0 * (float(side.x) * across + float(side.y) * down)) - here.w * slope;
        float close = max(dot(here.xyz, there.xyz), 0.0) * exp(-abs(distance) * sharpness);
        float weight = same_surface(here, there, distance, sharpness) + close;
        level_sum += weight * light_at(place, openness);
        level_total += weight;
    }
    vec4 found = (sum + 0.01 * level_sum) / (total + 0.01 * level_total);
    coarser[cell] = found;
    detail[cell] = vec4(own.rgb - found.rgb, noise_of_detail(own.w, texelFetch(gain, cell).r, found.w, level));
}
