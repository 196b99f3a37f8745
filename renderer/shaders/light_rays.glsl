// Shadow rays from surfaces to one light; none where the light is behind the surface.
layout(local_size_x = 64) in;

uniform uint ray_count;
uniform uint first_surface;
uniform uint light_index;
uniform float reach;  // of rays to directional lights
uniform float start;  // see leave

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= ray_count) return;
    Surface s = surfaces[first_surface + i];
    Ray ray = Ray(vec3(0.0), 0.0, vec3(0.0, 1.0, 0.0), 2e-4);
    if (s.material != no_surface) {
        Light light = lights[light_index];
        ray.origin = leave(s, start);
        vec3 to_light = light.directional != 0u ? -light.position : light.position - ray.origin;
        float distance = length(to_light);
        ray.direction = distance > 0.0 ? to_light / distance : s.normal;
        if (dot(ray.direction, s.normal) > 0.0) ray.reach = light.directional != 0u ? reach : distance;
    }
    rays[i] = ray;
}
