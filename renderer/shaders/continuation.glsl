// What the last shadow rays of a bounce have brought, and the rays from the vertices where paths go on. In the end Russian
// roulette (Arvo and Kirk, "Particle Transport and Image Synthesis", 1990): a path goes on with the probability of its
// largest throughput, and then counts as much more, so the mean stays. `guided`, a constant: see guided_ray.
layout(local_size_x = 64) in;

uniform uint pixel_count;
uniform uint first_pixel;
uniform uvec2 points[16];   // of the samples, see independent_sample
uniform uint sample_index;  // of the first
uniform uint stream;
uniform uint roulette_stream;
uniform int roulette;  // 1: paths may end

// A number of 0..1 for each sample.
float chance(uint pixel, uint index) {
    return unit_square(hash(uvec3(pixel ^ (seed * 0x9e3779b9u), index, roulette_stream)).xy).x;
}

void main() {
    uint k = gl_GlobalInvocationID.x;
    if (k >= pixel_count) return;
    uint i = gl_WorkGroupID.y * pixel_count + k;
    uint pixel = first_pixel + k;
    Surface s = load_surface(i);
    Path path = load_path(i);
    float survival = roulette == 1 ? min(max(path.throughput.r, max(path.throughput.g, path.throughput.b)), 1.0) : 1.0;
    bool goes_on = s.material != no_surface && (survival == 1.0 || chance(pixel, sample_index + gl_WorkGroupID.y) < survival);
    paths[i].radiance = settled(path, load_hit(i));
    float weight = 1.0, reach = goes_on ? far_reach : 0.0;
    vec2 u = independent_sample(pixel, points[gl_WorkGroupID.y], stream);
#if guided
    rays[i] = guided_ray(s, u, reach, weight);
#else
    rays[i] = hemisphere_ray(s, u, reach);
#endif
    paths[i].throughput = path.throughput * weight / max(survival, 1e-20);
}
