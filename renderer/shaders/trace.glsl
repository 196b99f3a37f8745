// Ray buffer to hit buffer: how far each ray gets in a part of the scene. March.glsl and the generated distance function stand
// before this.
uniform vec3 scene_low;      // all surfaces lie within this box
uniform vec3 scene_high;

void main() {
    load_parameters();
    share_out_rays();
    do {
        // The next ray that comes near this part.
        do {
            if (take_ray(!marching)) {
                marching = enter(scene_low, scene_high, distance_left());
                if (!marching) store_nothing();
            }
        } while (some(!marching) && next_ray < end);
        bool traced = marching;
        march();
        if (traced && !marching) {
            bool exhausted = arrive();
            store(found, t, part, uint(steps), exhausted);
        }
    } while (marching || next_ray < end);
}
