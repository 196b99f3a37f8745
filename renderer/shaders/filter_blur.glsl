// The blur of the chosen mip level: 5 x 5 binomial, a Gaussian of one texel.
layout(local_size_x = 64) in;

layout(binding = 0) uniform sampler2D source;
layout(binding = 0, rgba32f) writeonly uniform image2D target;

uniform int source_level;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(target);
    if (any(greaterThanEqual(at, size))) return;
    const float weight[3] = float[](6.0 / 16.0, 4.0 / 16.0, 1.0 / 16.0);
    vec4 sum = vec4(0.0);
    for (int y = -2; y <= 2; ++y)
        for (int x = -2; x <= 2; ++x)
            sum += weight[abs(x)] * weight[abs(y)] * texelFetch(source, clamp(at + ivec2(x, y), ivec2(0), size - 1), source_level);
    imageStore(target, at, sum);
}
