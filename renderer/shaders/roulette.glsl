// Russian roulette (Arvo and Kirk, "Particle Transport and Image Synthesis", 1990): a path goes on with the probability of
// its largest throughput, and then counts as much more, so the mean stays. `surfaces` are the paths' vertices here.
layout(local_size_x = 64) in;

uniform uint ray_count;
uniform uint first_pixel;
uniform uint sample_index;
uniform uint stream;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= ray_count || surfaces[i].material == no_surface) return;
    vec3 throughput = paths[i].throughput;
    float survival = min(max(throughput.r, max(throughput.g, throughput.b)), 1.0);
    if (independent_sample(first_pixel + i, sample_index, stream).x < survival)
        paths[i].throughput = throughput / survival;
    else
        surfaces[i].material = no_surface;
}
