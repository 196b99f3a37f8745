// From the accumulators and the filtered far light to the chosen view, linear. The paper's synthesis: direct light by
// Phong plus albedo x ambient occlusion x filtered far light ("ambient occlusion whose ambient colour is the filtered
// light"). Its product counts near occlusion twice; the reference method uses what was accumulated as it is, and
// farfield the estimate of the wavelet passes (METHOD.md).
layout(local_size_x = 64) in;

layout(binding = 0) uniform sampler2D paper_light;      // premultiplied by w, as is
layout(binding = 1) uniform samplerBuffer filtered_light;
layout(binding = 2) uniform samplerBuffer estimate;
layout(std430, binding = 0) writeonly buffer Target { vec4 target[]; };

uniform int view;    // enum View of renderer/views.h
uniform int method;  // enum Method of sdf/scene.h
uniform float frames;  // accumulated

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, image_size))) return;
    uint pixel = index_in(image_size, at);
    vec4 direct4 = load(direct_texels, pixel);
    vec3 direct = direct4.rgb / frames;
    vec4 albedo4 = load(albedo_texels, pixel);
    vec3 albedo = albedo4.rgb / frames;
    vec4 coarse4 = load(far_texels, pixel);
    vec3 coarse = coarse4.rgb / max(coarse4.w, 1.0);
    vec4 filtered4 = method == 1 ? texelFetch(filtered_light, int(pixel))
                                 : textureLod(paper_light, (vec2(at) + 0.5) / vec2(image_size), 0.0);
    vec3 filtered = filtered4.w > 0.0 ? filtered4.rgb / filtered4.w : vec3(0.0);
    vec4 occlusion4 = load(occlusion_texels, pixel);
    float occlusion = method == 0 && occlusion4.y > 0.0 ? occlusion4.x / occlusion4.y : openness_at(pixel);
    vec4 indirect4 = load(indirect_texels, pixel);
    vec4 geometry = load(geometry_texels, pixel);
    float covered = geometry.w / frames;

    vec3 color = vec3(0.0);
    vec3 indirect = indirect4.rgb / max(indirect4.w, 1.0);
    if (method == 0) indirect = albedo * occlusion * filtered;
    // Where a pixel shows several materials the product of means is not the mean of products: the rest is added.
    if (method == 1) indirect += albedo * texelFetch(estimate, int(pixel)).rgb - albedo * coarse;
    if (view == 0) color = direct + indirect;
    if (view == 1) color = direct;
    if (view == 2) color = coarse * covered;
    if (view == 3) color = filtered * covered;
    if (view == 4) color = direct + albedo * filtered;
    if (view == 5) color = vec3(mix(1.0, occlusion, covered));
    if (view == 6) color = geometry.w > 0.0 ? normalize(geometry.xyz + vec3(0.0, 1e-9, 0.0)) * 0.5 + 0.5 : vec3(0.0);
    if (view == 7) color = vec3(geometry.w > 0.0 ? direct4.w / geometry.w : 0.0);
    if (view == 8) color = vec3(albedo4.w / frames);
    target[pixel] = vec4(color, 1.0);
}
