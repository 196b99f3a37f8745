// The estimate with what the last picture knew of the same surfaces, which it saw from another camera. Irradiance does not
// depend on where one looks from, so that only what is hidden there, or was no part of the picture, has no past.
layout(local_size_x = 64) in;

layout(binding = 0) uniform samplerBuffer estimate;
layout(binding = 1) uniform samplerBuffer guide;
layout(binding = 2) uniform samplerBuffer past;        // w: see past_unit
layout(binding = 3) uniform samplerBuffer past_guide;  // normal; w: depth, 0 for no surface
layout(std430, binding = 0) writeonly buffer Target { vec4 target[]; };  // w: samples for each of this picture's pixels

uniform vec3 past_position, past_right, past_up, past_forward;  // its camera, as in the frame's constants
uniform ivec2 past_size;
uniform float past_unit;  // samples that a past w of 1 stands for, for each of this picture's pixels
uniform float samples;    // of this picture
uniform float most;       // samples that the past may count for

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, image_size))) return;
    int pixel = int(index_in(image_size, at));
    vec4 here = texelFetch(guide, pixel);
    vec3 seen = camera_position - past_position + here.w * ray_at(at);  // from the past camera
    float depth = dot(seen, past_forward);
    vec2 side = vec2(dot(seen, past_right) / dot(past_right, past_right), -dot(seen, past_up) / dot(past_up, past_up));
    // Both pictures' pixels at this depth; far outside the picture every place is as good.
    vec2 place = clamp((side / max(depth, 1e-20) * 0.5 + 0.5) * vec2(past_size) - 0.5, vec2(-2.0), vec2(past_size + 2));
    ivec2 corner = ivec2(floor(place));
    vec2 part = place - floor(place);
    float tolerance = 2.0 * here.w * max(pixel_angle, 2.0 * length(past_up) / float(past_size.y));
    vec4 sum = vec4(0.0);
    float agreed = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 tap = corner + ivec2(i & 1, i >> 1);
        if (any(lessThan(tap, ivec2(0))) || any(greaterThanEqual(tap, past_size))) continue;
        vec4 there = texelFetch(past_guide, int(index_in(past_size, tap)));
        vec2 q = (vec2(tap) + 0.5) / vec2(past_size) * 2.0 - 1.0;
        vec3 surface = there.w * (past_forward + q.x * past_right - q.y * past_up);
        if (there.w <= 0.0 || abs(dot(here.xyz, surface - seen)) > tolerance || dot(here.xyz, there.xyz) < 0.9) continue;
        vec2 near = mix(1.0 - part, part, vec2(i & 1, i >> 1));
        sum += near.x * near.y * texelFetch(past, int(index_in(past_size, tap)));
        agreed += near.x * near.y;
    }
    vec3 light = texelFetch(estimate, pixel).rgb;
    float known = min(sum.w * past_unit, most * agreed);
    if (known > 0.0) light = mix(light, sum.rgb / agreed, known / (known + samples));
    target[pixel] = vec4(light, samples + known);
}
