// Adds short rays to the ambient occlusion: the share of cosine-distributed rays that meet nothing within the AO radius.
layout(local_size_x = 64) in;

uniform uint ray_count;
uniform uint first_pixel;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= ray_count || rays[i].reach <= 0.0) return;
    occlusion_sum[first_pixel + i].xy += vec2(hits[i].distance < 0.0 ? 1.0 : 0.0, 1.0);
}
