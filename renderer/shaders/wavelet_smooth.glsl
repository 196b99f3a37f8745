// Half a level of the edge-avoiding à-trous wavelet (Dammertz et al. 2010): the B3 spline along rows or columns, on one surface
// only. Dammertz et al. take its 25 taps at once; two passes of 5 cost half as much and lose 1 %. Far light, openness, near
// light and the variance of a single pixel get the same weights; noise_gain is how much of that variance is left.
layout(binding = 0) uniform sampler2D far_source;
layout(binding = 1) uniform sampler2D near_source;
layout(binding = 2) uniform sampler2D guide;
layout(binding = 3) uniform sampler2D gain_source;
layout(binding = 4) uniform sampler2D links;  // from a tap to the next in this direction, see wavelet_links.glsl
layout(location = 0) out vec4 far_target;
layout(location = 1) out vec4 near_target;
layout(location = 2) out float gain_target;
layout(location = 3) out float next_links;  // for twice the step

uniform int step_x;  // from tap to tap, pixels
uniform int step_y;
uniform int first;   // 1: nothing has been filtered before

float link(ivec2 tap) {
    return texelFetch(links, clamp(tap, ivec2(0), image_size - 1), 0).r;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    ivec2 one = ivec2(step_x, step_y);
    vec4 here = texelFetch(guide, at, 0);
    // The distance of taps from the tangent plane, tangent_distance of common.glsl, is linear in their place but for the depth.
    float slope = dot(here.xyz, ray_at(at)), change = dot(here.xyz, ray_at(at + one)) - slope;
    float back = link(at - one), ahead = link(at);
    float way[5] = float[](min(back, link(at - 2 * one)), back, 1.0, ahead, min(ahead, link(at + one)));
    const float spline[5] = float[](1.0 / 16.0, 4.0 / 16.0, 6.0 / 16.0, 4.0 / 16.0, 1.0 / 16.0);
    vec4 far = vec4(0.0), near = vec4(0.0);
    float total = 0.0, squares = 0.0;
    for (int k = -2; k <= 2; ++k) {
        ivec2 tap = at + k * one;
        bool inside = all(greaterThanEqual(tap, ivec2(0))) && all(lessThan(tap, image_size));
        tap = clamp(tap, ivec2(0), image_size - 1);
        vec4 there = texelFetch(guide, tap, 0);
        float weight = way[k + 2] * spline[k + 2] *
                       same_surface(here, there, there.w * (slope + float(k) * change) - here.w * slope);
        weight = inside ? weight : 0.0;
        far += weight * texelFetch(far_source, tap, 0);
        near += weight * texelFetch(near_source, tap, 0);
        total += weight;
        squares += weight * weight;
    }
    float scale = total > 0.0 ? 1.0 / total : 0.0;
    far_target = far * scale;
    near_target = near * scale;
    gain_target = (first == 1 ? 1.0 : texelFetch(gain_source, at, 0).r) * squares * scale * scale;
    next_links = way[4];
}
