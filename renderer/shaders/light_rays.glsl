// Shadow rays from what the camera sees to one light; none where the light is behind the surface.
layout(local_size_x = 64) in;

uniform uint ray_count;
uniform uint first_pixel;
uniform uint light_index;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= ray_count) return;
    vec3 irradiance;
    rays[i] = shadow_ray(load_surface(first_pixel + i), load_light(light_index), start_of_seen_shadows, irradiance);
}
