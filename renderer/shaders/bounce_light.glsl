// Direct light of one light on the paths' vertices, Lambert only: the highlight is for the camera's surfaces.
layout(local_size_x = 64) in;

uniform uint ray_count;
uniform uint light_index;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= ray_count) return;
    vec3 irradiance = irradiance_of(lights[light_index], rays[i], hits[i], surfaces[i]);
    paths[i].radiance += paths[i].throughput * irradiance / PI;
}
