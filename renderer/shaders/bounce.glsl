// Where a far-light path goes on: adds sky or emission, takes the surface's albedo into the throughput and leaves the new
// vertex for direct light and the next ray. `surfaces` are the vertices here.
layout(local_size_x = 64) in;

uniform uint ray_count;
uniform int first_bounce;  // 1: the path's first ray

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= ray_count) return;
    Ray ray = rays[i];
    Hit hit = hits[i];
    Surface vertex = Surface(vec3(0.0), no_surface, vec3(0.0, 1.0, 0.0), 0.0);
    if (ray.reach > 0.0) {
        Path path = paths[i];
        if (hit.distance >= 0.0) {
            Material m = material_of(hit.material);
            vertex = Surface(ray.origin + hit.distance * ray.direction, hit.material, unpack_normal(hit.normal),
                             ray.footprint * exp2(minimum_step) * hit.distance);
            if (first_bounce == 1) path.first_hit = hit.distance;
            path.radiance += path.throughput * m.emission;
            path.throughput *= m.albedo;
        } else {
            path.radiance += path.throughput * sky(ray.direction);
        }
        paths[i] = path;
    }
    surfaces[i] = vertex;
}
