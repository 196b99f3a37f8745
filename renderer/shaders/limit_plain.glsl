// The scene's function of the march at evenly spaced points of each ray, and nothing else: as fast as a tracer could be that
// never waits and never decides. The generated distance function stands before this.
layout(local_size_x = 64) in;

uniform uint ray_count;
uniform int evaluations;
uniform int march_evaluations;  // for each time that a ray is cast
uniform uint member_count;  // of a family; else 1

void main() {
    load_parameters();
    uint i = gl_GlobalInvocationID.x;
    if (i >= ray_count) return;
    load_member(i % member_count);
    Ray ray = load_ray(i);
    float t = 0.0, stride = min(ray.reach, 10.0) / float(evaluations);
    int k = 0;
    do {
        vec3 p = ray.origin + t * ray.direction;
        float sum = 0.0;  // so that no evaluation is left out
#if marches
        vec2 there = scene_march(p, ray.direction);
        sum += clamp(there.x, -1.0, 1.0) + clamp(there.y, -1.0, 1.0);
#endif
#if casts
        if (k % march_evaluations == 0) sum += clamp(scene_cast(p, ray.direction), -1.0, 1.0);
#endif
        t += stride + 1e-9 * sum;
        ++k;
    } while (k < evaluations);
    hits[i].distance = t;
}
