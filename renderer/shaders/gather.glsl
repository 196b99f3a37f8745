// Adds finished paths to the accumulators of far light, whole and split into near and far by where the first ray met something. Cosine-distributed rays make the mean radiance the irradiance / pi.
layout(local_size_x = 64) in;

uniform uint ray_count;
uniform uint first_pixel;
uniform float near_radius;  // metres

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= ray_count) return;
    uint pixel = first_pixel + i;
    Surface s = surfaces[pixel];
    if (s.material == no_surface) {
        indirect_sum[pixel].w += 1.0;
        return;
    }
    vec3 radiance = paths[i].radiance;
    far_sum[pixel] += vec4(radiance, 1.0);
    float near = near_weight(paths[i].first_hit, near_radius);
    split_far_sum[pixel] += (1.0 - near) * vec4(radiance, 1.0);
    split_near_sum[pixel] += vec4(near * radiance, 1.0);
    square_sum[pixel] += dot(radiance, radiance) / 3.0;
    indirect_sum[pixel] += vec4(material_of(s.material).albedo * radiance, 1.0);
}
