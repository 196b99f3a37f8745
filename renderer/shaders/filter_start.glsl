// Level 0 of the mip chain: accumulated far light times a weight in w, 1 where there is a surface and 0 elsewhere, so
// that averages never mix in the background.
layout(local_size_x = 64) in;

layout(binding = 0, rgba32f) writeonly uniform image2D target;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, image_size))) return;
    vec4 sum = load(far_texels, index_in(image_size, at));
    imageStore(target, at, sum.w > 0.0 ? vec4(sum.rgb / sum.w, 1.0) : vec4(0.0));
}
