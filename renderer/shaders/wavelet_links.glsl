// How well a pixel hangs together with its neighbours to the right and below. The wavelet takes the weakest link on the way
// to a tap, so far light stays on its side of a wall that is thinner than the filter's steps, though both sides of the floor
// have one normal and one plane.
layout(binding = 0) uniform sampler2D guide;
layout(location = 0) out float right;
layout(location = 1) out float below;

float link(vec4 here, ivec2 at, ivec2 offset) {
    ivec2 tap = min(at + offset, image_size - 1);
    vec4 there = texelFetch(guide, tap, 0);
    // The fourth root: bent surfaces hang together, only breaks cut.
    return sqrt(sqrt(min(same_surface(here, there, tangent_distance(here, at, there, tap)),
                         same_surface(there, here, tangent_distance(there, tap, here, at)))));
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 here = texelFetch(guide, at, 0);
    right = link(here, at, ivec2(1, 0));
    below = link(here, at, ivec2(0, 1));
}
