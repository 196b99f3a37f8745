// The coarsest estimate, which is the coarsest level of the wavelet.
layout(local_size_x = 64) in;

layout(binding = 0) uniform samplerBuffer far_light;
layout(binding = 1) uniform samplerBuffer near_light;
layout(binding = 2) uniform samplerBuffer narrow_far;  // w: openness A, see narrow_level
layout(binding = 3) uniform samplerBuffer gain;
layout(std430, binding = 0) writeonly buffer Estimate { vec4 estimate[]; };  // w: variance of a single pixel, averaged as widely as anything
layout(std430, binding = 1) writeonly buffer Risk { float risk[]; };  // see wavelet_shrink.glsl

uniform ivec2 grid_size;
uniform int level;
uniform int narrow_level;  // whose openness is the one in front
uniform ivec2 narrow_size;
uniform int narrow_step;   // places of its grid for one of this

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, grid_size))) return;
    uint cell = index_in(grid_size, at);
    vec4 near = texelFetch(near_light, int(cell));
    float openness = texelFetch(narrow_far, int(index_in(narrow_size, narrow_step * at))).w;
    estimate[cell] = vec4(wavelet_light(texelFetch(far_light, int(cell)), near.rgb, level, narrow_level, openness), near.w);
    risk[cell] = texelFetch(gain, int(cell)).r * near.w;
}
