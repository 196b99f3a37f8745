// The coarsest estimate, which is the coarsest level of the wavelet, and the detail of the level below.
layout(binding = 0) uniform sampler2D far_light;
layout(binding = 1) uniform sampler2D near_light;  // w: variance of a single pixel, averaged as widely as anything
layout(binding = 3) uniform sampler2D finer_far;
layout(binding = 4) uniform sampler2D finer_near;
layout(binding = 5) uniform sampler2D finer_gain;
layout(binding = 7) uniform sampler2D narrow_far;  // w: openness A, see narrow_level
layout(location = 0) out vec4 estimate;
layout(location = 1) out vec4 finer_detail;

uniform int level;
uniform int narrow_level;  // whose openness is the one in front

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 near = texelFetch(near_light, at, 0);
    float openness = texelFetch(narrow_far, at, 0).w;
    vec3 result = wavelet_light(texelFetch(far_light, at, 0), near.rgb, level, narrow_level, openness);
    estimate = vec4(result, 1.0);
    finer_detail = wavelet_detail(texelFetch(finer_far, at, 0), texelFetch(finer_near, at, 0), texelFetch(finer_gain, at, 0).r,
                                  near.w, level - 1, narrow_level, openness, result);
}
