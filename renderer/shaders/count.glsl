// Adds the rays of the last march, what they took and how many of them ran out of steps to the counters.
layout(local_size_x = 64) in;

layout(std430, binding = 12) buffer Counters { uint counted_rays; uint counted_steps; uint exhausted_rays; };

uniform uint ray_count;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= ray_count || load_ray(i).reach <= 0.0) return;
    uint steps = load_hit(i).steps;
    atomicAdd(counted_rays, 1u);
    atomicAdd(counted_steps, steps & steps_mask);
    if ((steps & exhausted_flag) != 0u) atomicAdd(exhausted_rays, 1u);
}
