// Adds short rays to the ambient occlusion: the share of cosine-distributed rays that meet nothing within the AO radius,
// and the sum of the near weights of those that do.
layout(local_size_x = 64) in;

uniform uint ray_count;
uniform uint first_pixel;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= ray_count || rays[i].reach <= 0.0) return;
    float t = hits[i].distance;
    float near = t < 0.0 ? 0.0 : near_weight(t, rays[i].reach);
    occlusion_sum[first_pixel + i].xyz += vec3(t < 0.0 ? 1.0 : 0.0, 1.0, near);
}
