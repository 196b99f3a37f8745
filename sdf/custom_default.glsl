// A ball in waves. Write your own: sdf is the signed distance at p, in metres, negative inside.
// Each uniform becomes a slider; the comment after it gives its range, its unit and its tip.
uniform float radius = 0.5;   // [0, 1] m    Radius of the ball
uniform float height = 0.04;  // [0, 0.2] m  Height of the waves
uniform int waves = 3;        // [0, 12]     Waves across the ball

// How many times faster than 1 the distance may change from place to place; steps are divided by it.
const float lipschitz = 1.0;

float sdf(vec3 p) {
    float k = 3.14159265 * float(waves) / max(radius, 0.1);
    vec3 w = sin(k * p);
    float d = length(p) - radius + height * w.x * w.y * w.z;
    return d / (1.0 + height * k);  // the waves are as steep as height * k
}
