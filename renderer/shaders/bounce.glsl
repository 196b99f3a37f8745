// Where a far-light path has come to: adds sky or emission, takes the surface's albedo into the throughput, and sends a
// shadow ray to the first light. Vertices and throughputs are left for further lights and bounces, where there are any
// (`more_follows`, a constant).
layout(local_size_x = 64) in;

uniform uint ray_count;
uniform int first_bounce;  // 1: the path's first ray

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= ray_count) return;
    Ray ray = load_ray(i);
    Hit hit = load_hit(i);
    Path path = load_path(i);
    if (first_bounce == 1) path = Path(vec3(0.0), no_hit, vec3(0.0), path.weight, vec3(path.weight), 0.0);
    bool traced = ray.reach > 0.0, found = traced && hit.distance >= 0.0;
    Material m = material_of(found ? hit.material : 0u);
    Surface vertex = Surface(ray.origin + hit.distance * ray.direction, found ? hit.material : no_surface,
                             unpack_normal(hit.normal), ray.footprint * exp2(minimum_step) * hit.distance);
    if (found && first_bounce == 1) path.first_hit = hit.distance;
    path.radiance += traced ? path.throughput * (found ? m.emission : sky(ray.direction)) : vec3(0.0);
    path.throughput *= found ? m.albedo : vec3(0.0);
    if (path.throughput == vec3(0.0)) vertex.material = no_surface;  // as of a lamp: nothing more will count
    path.pending = vec3(0.0);
    if (light_count > 0) {
        vec3 irradiance;
        rays[i] = shadow_ray(vertex, load_light(0u), start_of_other_shadows, irradiance);
        path.pending = path.throughput * irradiance / PI;
    }
    paths[i].radiance = path.radiance;
    paths[i].first_hit = path.first_hit;
    paths[i].pending = path.pending;
#if more_follows
    paths[i].throughput = path.throughput;
    surfaces[i] = vertex;
#endif
}
