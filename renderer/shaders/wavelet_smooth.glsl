// Half a level of the edge-avoiding à-trous wavelet (Dammertz et al. 2010): the B3 spline along rows or columns, on one surface
// only. Dammertz et al. take its 25 taps at once; two passes of 5 cost half as much and lose 1 %. Far light, openness, near
// light and the variance of a single pixel get the same weights; noise_gain is how much of that variance is left.
//
// The wavelet's steps double with each level, and so do the distances of the places where a level is known from the second on: the
// taps are neighbours in its grid.
layout(local_size_x = 64) in;

layout(binding = 0) uniform samplerBuffer far_source;
layout(binding = 1) uniform samplerBuffer near_source;
layout(binding = 2) uniform samplerBuffer guide;
layout(binding = 3) uniform samplerBuffer gain_source;
layout(binding = 4) uniform samplerBuffer links;  // from a tap to the next in this direction, see wavelet_links.glsl
layout(std430, binding = 0) writeonly buffer Far { vec4 far_target[]; };
layout(std430, binding = 1) writeonly buffer Near { vec4 near_target[]; };
layout(std430, binding = 2) writeonly buffer Gain { float gain_target[]; };

uniform ivec2 grid_size;
uniform int spacing;      // pixels from one place of the grid to the next
uniform int along_columns;
uniform int first;        // 1: nothing has been filtered before

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, grid_size))) return;
    uint cell = index_in(grid_size, at);
    int stride = along_columns == 1 ? grid_size.x : 1;
    int place = along_columns == 1 ? at.y : at.x, last = (along_columns == 1 ? grid_size.y : grid_size.x) - 1;
    vec4 here = texelFetch(guide, int(cell));
    // The distance of taps from the tangent plane, tangent_distance of common.glsl, is linear in their place but for the depth.
    ivec2 one = spacing * (along_columns == 1 ? ivec2(0, 1) : ivec2(1, 0));
    float slope = dot(here.xyz, ray_at(spacing * at)), change = dot(here.xyz, ray_at(spacing * at + one)) - slope;
    float sharpness = surface_sharpness(here);
    float back = texelFetch(links, int(cell) - (place >= 1 ? stride : 0)).r, ahead = texelFetch(links, int(cell)).r;
    float farther_back = texelFetch(links, int(cell) - (place >= 2 ? 2 * stride : 0)).r;
    float farther_ahead = texelFetch(links, int(cell) + (place < last ? stride : 0)).r;
    float way[5] = float[](min(back, farther_back), back, 1.0, ahead, min(ahead, farther_ahead));
    const float spline[5] = float[](1.0 / 16.0, 4.0 / 16.0, 6.0 / 16.0, 4.0 / 16.0, 1.0 / 16.0);
    vec4 far = vec4(0.0), near = vec4(0.0);
    float total = 0.0, squares = 0.0;
    for (int k = -2; k <= 2; ++k) {
        bool inside = place + k >= 0 && place + k <= last;
        int tap = inside ? k : 0;
        vec4 there = texelFetch(guide, int(cell) + tap * stride);
        float distance = there.w * (slope + float(k) * change) - here.w * slope;
        float weight = inside ? way[k + 2] * spline[k + 2] * same_surface(here, there, distance, sharpness) : 0.0;
        far += weight * texelFetch(far_source, int(cell) + tap * stride);
        near += weight * texelFetch(near_source, int(cell) + tap * stride);
        total += weight;
        squares += weight * weight;
    }
    float scale = total > 0.0 ? 1.0 / total : 0.0;
    far_target[cell] = far * scale;
    near_target[cell] = near * scale;
    gain_target[cell] = (first == 1 ? 1.0 : texelFetch(gain_source, int(cell)).r) * squares * scale * scale;
}
