// As many multiply-adds as the device can do, in independent chains so that none waits for another.
layout(local_size_x = 64) in;

uniform uint ray_count;
uniform int turns;  // of 32 multiply-adds each

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= ray_count) return;
    vec4 x = vec4(i), a = x + 1.0, b = x + 2.0, c = x + 3.0, d = x + 4.0;
    vec4 factor = vec4(0.999 + 1e-9 * float(ray_count)), sum = vec4(1e-3);
    int k = 0;
    do {
        a = a * factor + sum, b = b * factor + sum, c = c * factor + sum, d = d * factor + sum;
        a = a * factor + sum, b = b * factor + sum, c = c * factor + sum, d = d * factor + sum;
        ++k;
    } while (k < turns);
    x = a + b + c + d;
    hits[i].distance = x.x + x.y + x.z + x.w;
}
