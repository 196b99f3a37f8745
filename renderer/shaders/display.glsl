// Linear view to what a screen shows: exposure, then the sRGB transfer function (IEC 61966-2-1). Normals and occlusion are
// shown as they are, depth and steps are mapped to grey.
layout(binding = 0) uniform samplerBuffer source;
layout(location = 0) out vec4 target;

uniform int view;
uniform float exposure;  // stops

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec3 c = texelFetch(source, int(index_in(image_size, at))).rgb;
    if (view <= 4) {
        c = clamp(c * exp2(exposure), 0.0, 1.0);
        c = mix(12.92 * c, 1.055 * pow(max(c, 1e-6), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
    }
    if (view == 7) c = vec3(c.x > 0.0 ? 1.0 / (1.0 + 0.15 * c.x) : 0.0);
    if (view == 8) c = c / 128.0;
    target = vec4(clamp(c, 0.0, 1.0), 1.0);
}
