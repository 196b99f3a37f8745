// Direct light of one light on what the camera sees: Lambert plus a Phong highlight (Phong 1975) with the
// normalisation (n + 2) / 2 pi of Lafortune and Willems (1994). Hard shadows: the light counts where its ray met nothing.
layout(local_size_x = 64) in;

uniform uint ray_count;
uniform uint first_pixel;
uniform uint light_index;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= ray_count) return;
    Ray ray = rays[i];
    if (ray.reach <= 0.0 || hits[i].distance >= 0.0) return;
    Surface s = surfaces[first_pixel + i];
    Material m = material_of(s.material);
    Light light = lights[light_index];
    float falloff = light.directional != 0u ? 1.0 : 1.0 / max(ray.reach * ray.reach, 1e-8);
    vec3 irradiance = light.intensity * (falloff * dot(s.normal, ray.direction));
    vec3 view = normalize(camera_position - s.position);
    float highlight = max(dot(reflect(-ray.direction, s.normal), view), 0.0);
    float lobe = m.specular * (m.exponent + 2.0) / (2.0 * PI) * pow(max(highlight, 1e-6), m.exponent);
    direct_sum[first_pixel + i].rgb += irradiance * (m.albedo / PI + lobe);
}
