// Camera rays of a run of pixels, through a point of the pixel that changes from frame to frame (antialiasing).
layout(local_size_x = 64) in;

uniform uint ray_count;
uniform uint first_pixel;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= ray_count) return;
    uint pixel = first_pixel + i;
    vec2 at = vec2(place_of(pixel)) + 0.5 + vec2(jitter_x, jitter_y);
    vec2 q = at / vec2(image_size) * 2.0 - 1.0;
    vec3 direction = normalize(camera_forward + q.x * camera_right - q.y * camera_up);
    // A fiftieth of a pixel: with a tenth a bright lamp grew by as much, and contact shadows began some millimetres too late.
    rays[i] = Ray(camera_position, far_reach, direction, 0.02 * pixel_angle);
}
