// One step of the mip chain: the mean over 2 x 2 texels, three where the finer level has an odd size at its end.
layout(local_size_x = 64) in;

layout(binding = 0) uniform sampler2D source;
layout(binding = 0, rgba32f) writeonly uniform image2D target;

uniform int source_level;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(target);
    if (any(greaterThanEqual(at, size))) return;
    ivec2 fine = textureSize(source, source_level);
    ivec2 first = at * 2;
    ivec2 last = ivec2(at.x == size.x - 1 ? fine.x - 1 : first.x + 1, at.y == size.y - 1 ? fine.y - 1 : first.y + 1);
    vec4 sum = vec4(0.0);
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) sum += texelFetch(source, ivec2(x, y), source_level);
    imageStore(target, at, sum / float((last.x - first.x + 1) * (last.y - first.y + 1)));
}
