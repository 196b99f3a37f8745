// The guide and the links of a grid with every second row and column of another.
layout(local_size_x = 64) in;

layout(binding = 0) uniform samplerBuffer fine_guide;
layout(binding = 1) uniform samplerBuffer fine_right;
layout(binding = 2) uniform samplerBuffer fine_below;
layout(std430, binding = 0) writeonly buffer Guide { vec4 guide[]; };
layout(std430, binding = 1) writeonly buffer Right { float right[]; };
layout(std430, binding = 2) writeonly buffer Below { float below[]; };

uniform ivec2 grid_size;
uniform ivec2 fine_size;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, grid_size))) return;
    uint cell = index_in(grid_size, at);
    int fine = int(index_in(fine_size, 2 * at));
    int beside = int(index_in(fine_size, min(2 * at + ivec2(1, 0), fine_size - 1)));
    int under = int(index_in(fine_size, min(2 * at + ivec2(0, 1), fine_size - 1)));
    guide[cell] = texelFetch(fine_guide, fine);
    right[cell] = min(texelFetch(fine_right, fine).r, texelFetch(fine_right, beside).r);
    below[cell] = min(texelFetch(fine_below, fine).r, texelFetch(fine_below, under).r);
}
