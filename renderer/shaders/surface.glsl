// What the rays of the ray buffer have met: normal and material of each hit, into the hit buffer. The generated distance
// function stands before this. A kernel apart from the march, whose rays end at different times: here all lanes do the
// same, and rays that only ask whether something is in the way never come here.
layout(local_size_x = 64) in;

uniform uint ray_count;
uniform uint part;          // of the scene; the others' hits are left alone
uniform uint member_count;  // of a family; else 1

// Of the gradient around a surface, where the field is that of a distance.
const float least_steepness = flat_field ? 0.05 : 0.8;

void main() {
    load_parameters();
    uint i = gl_GlobalInvocationID.x;
    if (i >= ray_count) return;
    Hit hit = load_hit(i);
    uint member = (hit.steps >> part_shift) - part;
    if (hit.distance < 0.0 || member >= member_count) return;
    load_member(member);
    Ray ray = load_ray(i);
    float t = hit.distance;
    vec3 p = ray.origin + t * ray.direction;
    float spacing = float_spacing(ray.origin);
    float apart = max(hit_tolerance(ray.footprint * exp2(minimum_step), spacing, t), 4.0 * spacing + 1e-4);
    vec3 gradient = vec3(0.0);
    uint material, front;
    bool several = false;  // materials around
    int k = 0, last = 4;
    do {
        // Corners of a tetrahedron: (1,1,1), (1,-1,-1), (-1,1,-1), (-1,-1,1). They bring the material along, so that the
        // scene stands in the program once.
        vec3 e = vec3((k & 2) == 0 ? 1.0 : -1.0, (k & 1) == 0 ? 1.0 : -1.0, (k & 3) == 0 || (k & 3) == 3 ? 1.0 : -1.0);
        if (last == 5 && k == 4) e = vec3(0.0);
        gradient += e * scene_surface(p + e * apart, material);
        several = several || (k > 0 && k < 4 && material != front);
        if (last < 8) front = material;
        ++k;
        // Around a skin thinner than that, slopes of both sides cancel out: once more, on the side that the ray came from.
        bool both_sides = k == 4 && (length(gradient) < least_steepness * 4.0 * apart || dot(gradient, ray.direction) > 0.0);
        // Where materials meet, that of the place itself: by a corner's, emitters of 5 cm gave 1.3 % more light.
        if (k == 4 && several) last = 5;
        if (both_sides) {
            last = 8;
            gradient = vec3(0.0);
            p -= 8.0 * apart * ray.direction;
        }
    } while (k < last);
    float steepness = dot(gradient, gradient);
    vec3 normal = steepness > 0.0 ? gradient * inversesqrt(steepness) : -ray.direction;
    hits[i].normal = pack_normal(normal);
    hits[i].material = front;
}
