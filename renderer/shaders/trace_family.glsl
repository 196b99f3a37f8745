// Ray buffer to hit buffer: how far each ray gets among the members of a family (sdf/families.h). It marches to one after the
// other, those whose boxes it meets, the nearer first. March.glsl and the generated distance function stand before this.
//
// Nodes of the tree of boxes (sdf/box_tree.h), two texels each: low corner, where the walk goes on if the ray misses the box;
// high corner, the member whose box it is.
layout(binding = 24) uniform usamplerBuffer node_texels;

uniform uint node_count;     // of each of the eight walks

const uint no_member = 0xffffffffu;

void main() {
    share_out_rays();
    bool tracing = false;  // has a ray, with members left to meet if node < last_node
    uint first_node = 0u, node = 0u, last_node = 0u;
    uint member = 0u;
    float nearest;         // hit so far, or how far to look
    uint nearest_member;
    uint all_steps;
    bool any_exhausted;
    do {
        do {
            if (tracing && !marching && node >= last_node) {
                store(nearest_member != no_member, nearest, part + nearest_member, all_steps, any_exhausted);
                tracing = false;
            }
            if (take_ray(!tracing)) {
                nearest = distance_left();
                nearest_member = no_member;
                all_steps = 0u;
                any_exhausted = false;
                first_node = node_count * uint(dot(vec3(lessThan(ray.direction, vec3(0.0))), vec3(1.0, 2.0, 4.0)));
                node = first_node;
                last_node = first_node + node_count;
                tracing = nearest > 0.0;
                if (!tracing) store_nothing();
            }
            // The next member whose box it meets.
            bool walking;
            do {
                if (tracing && !marching && node < last_node) {
                    uvec4 low = texelFetch(node_texels, int(2u * node)), high = texelFetch(node_texels, int(2u * node + 1u));
                    limit = nearest;
                    bool meets = enter(uintBitsToFloat(low.xyz), uintBitsToFloat(high.xyz));
                    marching = meets && high.w != no_member;
                    member = marching ? high.w : member;
                    node = meets ? node + 1u : first_node + low.w;
                }
                walking = tracing && !marching && node < last_node;
            } while (some(walking));
        } while (some(tracing && !marching) || (some(!marching) && next_ray < end));
        load_member(member);
        bool traced = marching;
        march();
        if (traced && !marching) {
            any_exhausted = arrive() || any_exhausted;
            all_steps += uint(steps);
            nearest_member = found && t < nearest ? member : nearest_member;
            nearest = found ? min(nearest, t) : nearest;
            node = found && any_hit == 1 ? last_node : node;
        }
    } while (tracing || next_ray < end);
}
