// Ray buffer to hit buffer: how far each ray gets in a part of the scene. March.glsl and the generated distance function stand
// before this.
uniform vec3 scene_low;      // all surfaces lie within this box
uniform vec3 scene_high;

#if !marches
void main() {
    load_parameters();
    i = gl_GlobalInvocationID.x;
    if (i >= ray_count) return;
    ray = load_ray(i);
    if (distance_left() > 0.0)
        store(true, scene_cast(ray.origin, ray.direction), part, 1u, false);
    else
        store_nothing();
}
#else
#if !casts
const float cast_at = 1e20;
#else
float cast_at;  // how far the ray gets until it meets what needs no march
#endif

void main() {
    load_parameters();
    share_out_rays();
    do {
        // The next ray that comes near what is marched.
        do {
            if (take_ray(!marching)) {
                limit = distance_left();
#if casts
                cast_at = scene_cast(ray.origin, ray.direction);
                bool enough = limit <= 0.0 || (any_hit == 1 && cast_at < limit);
                limit = min(limit, cast_at);
                marching = !enough && enter(scene_low, scene_high);
                if (!marching) store(true, cast_at, part, 1u, false);
#else
                marching = enter(scene_low, scene_high);
                if (!marching) store_nothing();
#endif
            }
        } while (some(!marching) && next_ray < end);
        bool traced = marching;
        march();
        if (traced && !marching) {
            bool exhausted = arrive();
            store(found || cast_at < 1e20, found ? t : cast_at, part, uint(steps), exhausted);
        }
    } while (marching || next_ray < end);
}
#endif
