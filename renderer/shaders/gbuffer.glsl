// Camera hits to the G-buffer: the surfaces of this frame, and sums of normal, albedo, depth, emission and sky.
layout(local_size_x = 64) in;

uniform uint ray_count;
uniform uint first_pixel;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= ray_count) return;
    uint pixel = first_pixel + i;
    Ray ray = load_ray(i);
    Hit hit = load_hit(i);
    bool found = hit.distance >= 0.0;
    Surface surface = Surface(vec3(0.0), no_surface, vec3(0.0, 1.0, 0.0), 0.0);
    vec3 emitted = sky(ray.direction);
    vec3 albedo = vec3(0.0);
    if (found) {
        Material m = material_of(hit.material);
        surface = Surface(ray.origin + hit.distance * ray.direction, hit.material, unpack_normal(hit.normal),
                          ray.footprint * exp2(minimum_step) * hit.distance);
        emitted = m.emission;
        albedo = m.albedo;
        geometry_sum[pixel] = load(geometry_texels, pixel) + vec4(surface.normal, 1.0);
    }
    surfaces[pixel] = surface;
    direct_sum[pixel] = load(direct_texels, pixel) + vec4(emitted, max(hit.distance, 0.0));
    albedo_sum[pixel] = load(albedo_texels, pixel) + vec4(albedo, float(hit.steps & steps_mask));
}
