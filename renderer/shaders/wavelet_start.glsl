// Level 0 of the wavelet: far and near light as accumulated, divided by pi, with the openness A and the variance of the mean,
// and the guide that tells surfaces apart.
layout(local_size_x = 64) in;

layout(std430, binding = 0) writeonly buffer Far { vec4 far_light[]; };    // w: openness of the same rays
layout(std430, binding = 1) writeonly buffer Near { vec4 near_light[]; };  // w: variance of the mean of near + far
layout(std430, binding = 2) writeonly buffer Guide { vec4 guide[]; };      // normal; w: depth, 0 for no surface

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, image_size))) return;
    uint pixel = index_in(image_size, at);
    vec4 geometry = load(geometry_texels, pixel);
    vec4 whole = load(far_texels, pixel);
    vec4 far = load(split_far_texels, pixel);
    vec4 near = load(split_near_texels, pixel);
    bool any_surface = geometry.w > 0.0 && whole.w > 0.0;
    vec3 mean = whole.rgb / max(whole.w, 1.0);
    // Right after the AO radius changed all light counts as far. The near light is the rest, so that their sum is the mean
    // of all samples, also of those from before the change.
    far = near.w > 0.0 ? far / near.w : vec4(mean, any_surface ? 1.0 : 0.0);
    near.rgb = mean - far.rgb;
    // One sample does not tell its mean from chance: its square bounds the variance.
    float known = whole.w > 1.0 ? dot(mean, mean) / 3.0 : 0.0;
    float spread = max(load(square_texels, pixel).x / max(whole.w, 1.0) - known, 0.0);
    vec3 normal = normalize(geometry.xyz + vec3(0.0, 1e-9, 0.0));
    far_light[pixel] = far;
    // Few samples seldom hold the bright one.
    float count = max(whole.w, 1.0);
    near_light[pixel] = vec4(near.rgb, spread / max(count - 1.0, 1.0) * (1.0 + 4.0 / count));
    guide[pixel] = any_surface ? vec4(normal, load(direct_texels, pixel).w / geometry.w / length(ray_at(at))) : vec4(0.0);
}
