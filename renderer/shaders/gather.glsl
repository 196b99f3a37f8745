// Adds finished paths to the accumulators of far light, whole and split into near and far by where the first ray met
// something. Cosine-distributed rays make the mean radiance the irradiance / pi.
layout(local_size_x = 64) in;

uniform uint pixel_count;
uniform uint first_pixel;
uniform uint sample_count;  // of each pixel
uniform float near_radius;  // metres

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= pixel_count) return;
    uint pixel = first_pixel + i;
    Surface s = load_surface(pixel);
    bool any = s.material != no_surface;
    vec3 albedo = material_of(any ? s.material : 0u).albedo;
    vec4 whole = load(far_texels, pixel), far = load(split_far_texels, pixel), near = load(split_near_texels, pixel);
    vec4 indirect = load(indirect_texels, pixel);
    float squares = load(square_texels, pixel).x;
    uint path_index = i, end = i + sample_count * pixel_count;
    do {
        Path path = load_path(path_index);
        vec3 radiance = settled(path, load_hit(path_index));
        float weight = near_weight(path.first_hit, near_radius);
        whole += vec4(radiance, 1.0);
        far += (1.0 - weight) * vec4(radiance, path.weight);
        near += vec4(weight * radiance, 1.0);
        squares += dot(radiance, radiance) / 3.0;
        indirect += vec4(albedo * radiance, 1.0);
        path_index += pixel_count;
    } while (path_index < end);
    if (any) {
        far_sum[pixel] = whole;
        split_far_sum[pixel] = far;
        split_near_sum[pixel] = near;
        square_sum[pixel] = squares;
        indirect_sum[pixel] = indirect;
    } else {
        indirect_sum[pixel].w = indirect.w;
    }
}
