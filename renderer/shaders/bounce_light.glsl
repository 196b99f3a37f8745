// Direct light of one light on the paths' vertices, Lambert only: the highlight is for the camera's surfaces.
layout(local_size_x = 64) in;

uniform uint ray_count;
uniform uint light_index;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= ray_count) return;
    Ray ray = rays[i];
    if (ray.reach <= 0.0 || hits[i].distance >= 0.0) return;
    Light light = lights[light_index];
    float falloff = light.directional != 0u ? 1.0 : 1.0 / max(ray.reach * ray.reach, 1e-8);
    float cosine = dot(surfaces[i].normal, ray.direction);
    paths[i].radiance += paths[i].throughput * light.intensity * (falloff * cosine / PI);
}
