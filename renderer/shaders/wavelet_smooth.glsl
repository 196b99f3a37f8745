// One level of the edge-avoiding à-trous wavelet (Dammertz et al. 2010): the B3 spline with taps `stride` pixels apart, on
// one surface only. Far light, openness and near light get the same weights and so
// does the variance of a single pixel; noise_gain is how much of it is left at this level.
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D far_source;
layout(binding = 1) uniform sampler2D near_source;
layout(binding = 2) uniform sampler2D guide;
layout(binding = 3) uniform sampler2D gain_source;
layout(binding = 4) uniform sampler2D links;  // of this stride, see wavelet_links.glsl
layout(binding = 0, rgba32f) writeonly uniform image2D far_target;
layout(binding = 1, rgba32f) writeonly uniform image2D near_target;
layout(binding = 2, r32f) writeonly uniform image2D gain_target;

uniform int stride;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, image_size))) return;
    const float spline[3] = float[](6.0 / 16.0, 4.0 / 16.0, 1.0 / 16.0);
    vec4 here = texelFetch(guide, at, 0);
    vec3 position = position_at(at, here.w);
    // The weakest link on the way to each tap: along a row and a column, the better of both orders.
    float row[25], column[25];
    for (int k = 0; k < 5; ++k) row[5 * k + 2] = column[10 + k] = 1.0;
    for (int j = 0; j < 2; ++j)
        for (int k = 0; k < 5; ++k) {
            ivec2 last = image_size - 1;
            ivec2 r = at + stride * ivec2(j, k - 2), l = at + stride * ivec2(-1 - j, k - 2);
            ivec2 d = at + stride * ivec2(k - 2, j), u = at + stride * ivec2(k - 2, -1 - j);
            row[5 * k + 3 + j] = min(row[5 * k + 2 + j], texelFetch(links, clamp(r, ivec2(0), last), 0).r);
            row[5 * k + 1 - j] = min(row[5 * k + 2 - j], texelFetch(links, clamp(l, ivec2(0), last), 0).r);
            column[5 * (3 + j) + k] = min(column[5 * (2 + j) + k], texelFetch(links, clamp(d, ivec2(0), last), 0).g);
            column[5 * (1 - j) + k] = min(column[5 * (2 - j) + k], texelFetch(links, clamp(u, ivec2(0), last), 0).g);
        }
    vec4 far = vec4(0.0), near = vec4(0.0);
    float total = 0.0, squares = 0.0;
    for (int y = -2; y <= 2; ++y)
        for (int x = -2; x <= 2; ++x) {
            ivec2 tap = at + stride * ivec2(x, y);
            if (any(lessThan(tap, ivec2(0))) || any(greaterThanEqual(tap, image_size))) continue;
            int k = 5 * (y + 2) + x + 2;
            float way = max(min(row[10 + x + 2], column[k]), min(column[5 * (y + 2) + 2], row[k]));
            vec4 there = texelFetch(guide, tap, 0);
            float weight = way * spline[abs(x)] * spline[abs(y)] *
                           same_surface(here, position, there, position_at(tap, there.w));
            far += weight * texelFetch(far_source, tap, 0);
            near += weight * texelFetch(near_source, tap, 0);
            total += weight;
            squares += weight * weight;
        }
    float scale = total > 0.0 ? 1.0 / total : 0.0;
    imageStore(far_target, at, far * scale);
    imageStore(near_target, at, near * scale);
    imageStore(gain_target, at, texelFetch(gain_source, at, 0) * (squares * scale * scale));
}
