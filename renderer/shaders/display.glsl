// Linear view to what a screen shows: exposure, then the sRGB transfer function (IEC 61966-2-1). Normals and occlusion are
// shown as they are, depth and steps are mapped to grey.
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0, rgba32f) readonly uniform image2D source;
layout(binding = 1, rgba8) writeonly uniform image2D target;

uniform int view;
uniform float exposure;  // stops

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, image_size))) return;
    vec3 c = imageLoad(source, at).rgb;
    if (view <= 4) {
        c = clamp(c * exp2(exposure), 0.0, 1.0);
        c = mix(12.92 * c, 1.055 * pow(max(c, 1e-6), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
    }
    if (view == 7) c = vec3(c.x > 0.0 ? 1.0 / (1.0 + 0.15 * c.x) : 0.0);
    if (view == 8) c = c / 128.0;
    imageStore(target, at, vec4(clamp(c, 0.0, 1.0), 1.0));
}
