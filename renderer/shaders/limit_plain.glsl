// The scene's function of the march at evenly spaced points of each ray, and nothing else: as fast as a tracer could be that
// never waits and never decides. The generated distance function stands before this.
layout(local_size_x = 64) in;

uniform uint ray_count;
uniform int evaluations;
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
        vec2 there = scene_march(ray.origin + t * ray.direction, ray.direction);
        t += stride + 1e-9 * (clamp(there.x, -1.0, 1.0) + clamp(there.y, -1.0, 1.0));  // so that none is left out
        ++k;
    } while (k < evaluations);
    hits[i].distance = t;
}
