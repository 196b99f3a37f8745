// Direct light of one light on what the camera sees: Lambert plus a Phong highlight (Phong 1975) with the
// normalisation (n + 2) / 2 pi of Lafortune and Willems (1994). Hard shadows: the light counts where its ray met nothing.
layout(local_size_x = 64) in;

uniform uint ray_count;
uniform uint first_pixel;
uniform uint light_index;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= ray_count) return;
    uint pixel = first_pixel + i;
    Surface s = load_surface(pixel);
    if (s.material == no_surface || load_hit(i).distance >= 0.0) return;
    Material m = material_of(s.material);
    vec3 irradiance;
    Ray ray = shadow_ray(s, load_light(light_index), start_of_seen_shadows, irradiance);
    vec3 view = normalize(camera_position - s.position);
    float highlight = max(dot(reflect(-ray.direction, s.normal), view), 0.0);
    float lobe = m.specular * (m.exponent + 2.0) / (2.0 * PI) * pow(max(highlight, 1e-6), m.exponent);
    direct_sum[pixel].rgb = load(direct_texels, pixel).rgb + irradiance * (m.albedo / PI + lobe);
}
