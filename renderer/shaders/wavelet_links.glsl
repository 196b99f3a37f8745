// How well a pixel hangs together with its neighbours to the right and below. The wavelet takes the weakest link on the way
// to a tap, so far light stays on its side of a wall that is thinner than the filter's steps, though both sides of the floor
// have one normal and one plane.
layout(local_size_x = 64) in;

layout(binding = 0) uniform samplerBuffer guide;
layout(std430, binding = 0) writeonly buffer Right { float right[]; };
layout(std430, binding = 1) writeonly buffer Below { float below[]; };

float link(vec4 here, ivec2 at, ivec2 offset) {
    ivec2 tap = min(at + offset, image_size - 1);
    vec4 there = texelFetch(guide, int(index_in(image_size, tap)));
    // The fourth root: bent surfaces hang together, only breaks cut.
    return sqrt(sqrt(min(same_surface(here, there, tangent_distance(here, at, there, tap), surface_sharpness(here)),
                         same_surface(there, here, tangent_distance(there, tap, here, at), surface_sharpness(there)))));
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, image_size))) return;
    uint pixel = index_in(image_size, at);
    vec4 here = texelFetch(guide, int(pixel));
    right[pixel] = link(here, at, ivec2(1, 0));
    below[pixel] = link(here, at, ivec2(0, 1));
}
