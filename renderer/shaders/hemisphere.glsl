// Cosine-distributed rays from the surfaces of a run of pixels, `sample_count` from each, which lie apart by `pixel_count`:
// where paths of far light begin, or short rays of ambient occlusion. `guided`, a constant: see guided_ray.
layout(local_size_x = 64) in;

uniform uint pixel_count;
uniform uint first_pixel;
uniform uint spread;        // not 0: the surfaces are taken evenly from so many
uniform uvec2 points[16];   // of the samples, see stratified_sample
uniform uint stream;
uniform int stratified;     // 1: between pixels, too
uniform float reach;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= pixel_count) return;
    uint even, unused;
    umulExtended(i * 2654435769u, spread, even, unused);  // multiples of the golden ratio, modulo 1
    uint pixel = first_pixel + i;
    Surface s = load_surface(spread > 0u ? even : pixel);
    uvec2 point = points[gl_WorkGroupID.y];
    vec2 u = stratified == 1 ? stratified_sample(place_of(pixel), point, stream) : independent_sample(pixel, point, stream);
    uint place = gl_WorkGroupID.y * pixel_count + i;
    float ray_reach = s.material != no_surface ? reach : 0.0;
#if guided
    float weight;
    rays[place] = guided_ray(s, u, ray_reach, weight);
    paths[place].weight = weight;
#else
    rays[place] = hemisphere_ray(s, u, ray_reach);
#endif
}
