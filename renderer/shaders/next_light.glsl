// What the shadow rays to one light have brought to the paths' vertices, and those to the next. Lambert only: the highlight
// is for the camera's surfaces.
layout(local_size_x = 64) in;

uniform uint ray_count;
uniform uint light_index;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= ray_count) return;
    Path path = load_path(i);
    vec3 irradiance;
    rays[i] = shadow_ray(load_surface(i), load_light(light_index), start_of_other_shadows, irradiance);
    paths[i].radiance = settled(path, load_hit(i));
    paths[i].pending = path.throughput * irradiance / PI;
}
