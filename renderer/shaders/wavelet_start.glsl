// Level 0 of the wavelet: far and near light as accumulated, divided by pi, with the openness A and the variance of the mean,
// and the guide that tells surfaces apart.
layout(location = 0) out vec4 far_light;   // w: openness of the same rays
layout(location = 1) out vec4 near_light;  // w: variance of the mean of near + far
layout(location = 2) out vec4 guide;       // normal; w: depth, 0 for no surface

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    int pixel = at.y * image_size.x + at.x;
    vec4 geometry = geometry_sum[pixel];
    vec4 whole = far_sum[pixel];
    vec4 far = split_far_sum[pixel];
    vec4 near = split_near_sum[pixel];
    bool any_surface = geometry.w > 0.0 && whole.w > 0.0;
    vec3 mean = whole.rgb / max(whole.w, 1.0);
    // Right after the AO radius changed all light counts as far. The near light is the rest, so that their sum is the mean
    // of all samples, also of those from before the change.
    far = near.w > 0.0 ? far / near.w : vec4(mean, any_surface ? 1.0 : 0.0);
    near.rgb = mean - far.rgb;
    // One sample does not tell its mean from chance: its square bounds the variance.
    float known = whole.w > 1.0 ? dot(mean, mean) / 3.0 : 0.0;
    float spread = max(square_sum[pixel] / max(whole.w, 1.0) - known, 0.0);
    vec3 normal = normalize(geometry.xyz + vec3(0.0, 1e-9, 0.0));
    far_light = far;
    near_light = vec4(near.rgb, spread / max(whole.w - 1.0, 1.0) * (1.0 + 4.0 / max(whole.w, 1.0)));
    guide = any_surface ? vec4(normal, direct_sum[pixel].w / geometry.w / length(ray_at(at))) : vec4(0.0);
}
