// How well pixels hang together with those `stride` to the right and below: the weakest of all links between neighbours on
// the way. So far light stays on its side of a wall that is thinner than the filter's steps, though both sides of the floor
// have one normal and one plane.
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D finer;  // links of half the stride
layout(binding = 1) uniform sampler2D guide;
layout(binding = 0, rg32f) writeonly uniform image2D links;

uniform int stride;

float neighbours(vec4 here, vec3 position, ivec2 tap) {
    vec4 there = texelFetch(guide, tap, 0);
    vec3 other = position_at(tap, there.w);
    // The fourth root: bent surfaces hang together, only breaks cut.
    return sqrt(sqrt(min(same_surface(here, position, there, other),
                         same_surface(there, other, here, position))));
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, image_size))) return;
    vec2 link;
    if (stride == 1) {
        vec4 here = texelFetch(guide, at, 0);
        vec3 position = position_at(at, here.w);
        ivec2 last = image_size - 1;
        link = vec2(neighbours(here, position, min(at + ivec2(1, 0), last)),
                    neighbours(here, position, min(at + ivec2(0, 1), last)));
    } else {
        ivec2 right = min(at + ivec2(stride / 2, 0), image_size - 1);
        ivec2 below = min(at + ivec2(0, stride / 2), image_size - 1);
        link = min(texelFetch(finer, at, 0).rg, vec2(texelFetch(finer, right, 0).r, texelFetch(finer, below, 0).g));
    }
    imageStore(links, at, vec4(link, 0.0, 0.0));
}
