// Adds short rays to the ambient occlusion: the share of cosine-distributed rays that meet nothing within the AO radius,
// and the sum of the near weights of those that do.
layout(local_size_x = 64) in;

uniform uint ray_count;
uniform uint first_pixel;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= ray_count) return;
    float reach = load_ray(i).reach, t = load_hit(i).distance;
    if (reach <= 0.0) return;
    float near = t < 0.0 ? 0.0 : near_weight(t, reach);
    uint pixel = first_pixel + i;
    occlusion_sum[pixel].xyz = load(occlusion_texels, pixel).xyz + vec3(t < 0.0 ? 1.0 : 0.0, 1.0, near);
}
