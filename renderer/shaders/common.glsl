// What all kernels share: the frame's constants, the records that travel between kernels, random numbers. World frame,
// y up, metres. The C++ side of the records is renderer/records.h; a test compares the layouts.

#define PI 3.14159265358979

layout(std140, binding = 0) uniform Frame {
    vec3 camera_position;
    float pixel_angle;      // radians across one pixel at the picture's centre
    vec3 camera_right;      // to the right edge of the picture at distance 1
    float jitter_x;         // of this frame's camera rays within the pixel, -0.5..0.5
    vec3 camera_up;         // to the upper edge
    float jitter_y;
    vec3 camera_forward;
    uint seed;
    vec3 sky_horizon;
    int light_count;
    vec3 sky_zenith;
    float minimum_step;     // hits may be 2^this times as far off as usual
    ivec2 image_size;       // pixels
    int step_limit;         // distance evaluations for each ray; 0: the tracer's own limit
    int emitter_count;
};

struct Ray {
    vec3 origin;
    float reach;      // how far to look; 0 for no ray
    vec3 direction;   // unit
    float footprint;  // a hit may be this much off for each metre travelled
};

struct Hit {
    float distance;  // along the ray; -1 for none
    uint normal;     // octahedral, see pack_normal
    uint material;   // code of blend_materials
    uint steps;      // lower bits: distance evaluations of the march; upper ones: the part of the scene that was hit
};
const uint steps_mask = 0x7fffu;
const uint exhausted_flag = 0x8000u;  // a march ran out of steps
const int part_shift = 16;

const uint no_surface = 0xffffffffu;
struct Surface {
    vec3 position;
    uint material;  // code, or no_surface
    vec3 normal;
    float epsilon;  // how far the position may be off, metres
};

const float most_guided = 0.5;  // share of the rays towards emitters at most
const float no_hit = 1e30;
const float far_reach = 1e4;  // how far rays look, metres

// See leave. What the camera sees wants shadows that touch what casts them. What light is gathered from does not: grazing
// rays that start nearer took 12 % of the time of the Cornell room.
const float start_of_seen_shadows = 0.2;
const float start_of_other_shadows = 1.0;

// One path of far light.
struct Path {
    vec3 radiance;
    float first_hit;   // distance of the first vertex, metres; no_hit when nothing was met
    vec3 pending;      // radiance that comes with the shadow ray under way if it meets nothing
    float weight;      // of the first ray, see guided_ray
    vec3 throughput;   // what the next vertex contributes is multiplied by it
    float unused;
};

struct Material {
    vec3 albedo;
    float specular;
    vec3 emission;
    float exponent;
};

struct Light {
    vec3 position;   // directional: the way the light travels, unit
    uint directional;
    vec3 intensity;  // W/sr, directional: W/m²
    float unused;
};

// A box around something that emits.
struct Emitter {
    vec3 low;
    float radiance;  // in units of all light that comes from elsewhere, roughly
    vec3 high;
    float unused;
};

// Kernels write records through storage blocks and read them through buffer textures of the same memory, at unit 8 + binding:
// llvmpipe fetches a texel for all lanes together, but loads the words of a block lane by lane, which takes five times as long.
layout(std430, binding = 0) writeonly buffer Rays { Ray rays[]; };
layout(std430, binding = 1) writeonly buffer Hits { Hit hits[]; };
layout(std430, binding = 2) writeonly buffer Surfaces { Surface surfaces[]; };  // of the camera rays or of the paths' vertices
layout(std430, binding = 3) writeonly buffer Paths { Path paths[]; };
layout(binding = 8) uniform usamplerBuffer ray_texels;
layout(binding = 9) uniform usamplerBuffer hit_texels;
layout(binding = 10) uniform usamplerBuffer surface_texels;
layout(binding = 11) uniform usamplerBuffer path_texels;
layout(binding = 27) uniform usamplerBuffer material_texels;
layout(binding = 28) uniform usamplerBuffer light_texels;
layout(binding = 26) uniform usamplerBuffer emitter_texels;

// ---- accumulators: sums over frames, one element for each pixel, row 0 at the top ----
layout(std430, binding = 6) writeonly buffer Direct { vec4 direct_sum[]; };        // radiance; w: depth, metres
layout(std430, binding = 7) writeonly buffer Geometry { vec4 geometry_sum[]; };    // normal; w: hits
layout(std430, binding = 8) writeonly buffer Reflectance { vec4 albedo_sum[]; };   // albedo; w: steps of the camera ray
layout(std430, binding = 9) writeonly buffer FarLight { vec4 far_sum[]; };         // irradiance / pi where there is a surface; w: samples
layout(std430, binding = 10) writeonly buffer Indirect { vec4 indirect_sum[]; };   // albedo x irradiance / pi; w: samples, surface or not
layout(std430, binding = 11) writeonly buffer Occlusion { vec4 occlusion_sum[]; }; // short rays; x: left the AO radius, y: all, z: sum of near weights
// Far light split by the near weight of the AO radius; restarted with it, so they count their own samples.
layout(std430, binding = 13) writeonly buffer SplitFar { vec4 split_far_sum[]; };   // (1 - w) radiance; w: 1 - w
layout(std430, binding = 14) writeonly buffer SplitNear { vec4 split_near_sum[]; }; // w radiance; w: samples
layout(std430, binding = 15) writeonly buffer Squares { float square_sum[]; };      // mean of the radiance's three squares; samples as far_sum
layout(binding = 14) uniform usamplerBuffer direct_texels;
layout(binding = 15) uniform usamplerBuffer geometry_texels;
layout(binding = 16) uniform usamplerBuffer albedo_texels;
layout(binding = 17) uniform usamplerBuffer far_texels;
layout(binding = 18) uniform usamplerBuffer indirect_texels;
layout(binding = 19) uniform usamplerBuffer occlusion_texels;
layout(binding = 21) uniform usamplerBuffer split_far_texels;
layout(binding = 22) uniform usamplerBuffer split_near_texels;
layout(binding = 23) uniform usamplerBuffer square_texels;

vec4 load(usamplerBuffer texels, uint i) {
    return uintBitsToFloat(texelFetch(texels, int(i)));
}

Ray load_ray(uint i) {
    vec4 a = load(ray_texels, 2u * i), b = load(ray_texels, 2u * i + 1u);
    return Ray(a.xyz, a.w, b.xyz, b.w);
}

Hit load_hit(uint i) {
    uvec4 a = texelFetch(hit_texels, int(i));
    return Hit(uintBitsToFloat(a.x), a.y, a.z, a.w);
}

Surface load_surface(uint i) {
    uvec4 a = texelFetch(surface_texels, int(2u * i));
    vec4 b = load(surface_texels, 2u * i + 1u);
    return Surface(uintBitsToFloat(a.xyz), a.w, b.xyz, b.w);
}

Path load_path(uint i) {
    vec4 a = load(path_texels, 3u * i), b = load(path_texels, 3u * i + 1u), c = load(path_texels, 3u * i + 2u);
    return Path(a.xyz, a.w, b.xyz, emitter_count > 0 ? b.w : 1.0, c.xyz, c.w);
}

Light load_light(uint i) {
    uvec4 a = texelFetch(light_texels, int(2u * i));
    vec4 b = load(light_texels, 2u * i + 1u);
    return Light(uintBitsToFloat(a.xyz), a.w, b.xyz, b.w);
}

Material load_material(uint i) {
    vec4 a = load(material_texels, 2u * i), b = load(material_texels, 2u * i + 1u);
    return Material(a.xyz, a.w, b.xyz, b.w);
}

// Near weight w of light that comes from distance t: 1 at 0, 0 from the AO radius on, and smooth.
float near_weight(float t, float radius) {
    float x = clamp(t / radius, 0.0, 1.0);
    return (1.0 - x * x) * (1.0 - x * x);
}

// Openness A of a pixel: the mean of 1 - w over short and long rays.
float openness_at(uint pixel) {
    vec4 short_rays = load(occlusion_texels, pixel);
    float rays = short_rays.y + load(split_near_texels, pixel).w;
    return rays > 0.0 ? (load(split_far_texels, pixel).w + short_rays.y - short_rays.z) / rays : 1.0;
}

// Of coordinates near p, metres; twice that of a float.
float float_spacing(vec3 p) {
    return 2.5e-7 * max(abs(p.x), max(abs(p.y), abs(p.z)));
}

// How far off a hit may be after t metres of a ray with that footprint and the float spacing of its origin, metres.
float hit_tolerance(float footprint, float spacing, float t) {
    return max(1e-5, max(footprint * t, spacing + 2.5e-7 * t));
}

// Octahedral map of the unit sphere (Meyer et al. 2010), 16 bits for each of two coordinates.
uint pack_normal(vec3 n) {
    vec2 q = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    vec2 s = vec2(q.x >= 0.0 ? 1.0 : -1.0, q.y >= 0.0 ? 1.0 : -1.0);
    return packSnorm2x16(n.z >= 0.0 ? q : (1.0 - abs(q.yx)) * s);
}

vec3 unpack_normal(uint code) {
    vec2 q = unpackSnorm2x16(code);
    vec3 n = vec3(q, 1.0 - abs(q.x) - abs(q.y));
    float t = max(-n.z, 0.0);
    n.x += n.x >= 0.0 ? -t : t;
    n.y += n.y >= 0.0 ? -t : t;
    return normalize(n);
}

vec3 sky(vec3 direction) {
    return mix(sky_horizon, sky_zenith, clamp(direction.y, 0.0, 1.0));
}

Material material_of(uint code) {
    Material m = load_material(code & 0xfffu);
    float share = float(code >> 24u) / 255.0;
    Material other = load_material(share > 0.0 ? (code >> 12u) & 0xfffu : code & 0xfffu);
    return Material(mix(m.albedo, other.albedo, share), mix(m.specular, other.specular, share),
                    mix(m.emission, other.emission, share), mix(m.exponent, other.exponent, share));
}

// pcg3d of Jarzynski and Olano, "Hash Functions for GPU Rendering", 2020.
uvec3 hash(uvec3 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> 16u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}

vec2 unit_square(uvec2 v) {
    return vec2(v >> 8u) * (1.0 / 16777216.0);
}

// Points of a low-discrepancy sequence (renderer/sobol.h) that all pixels share are moved, modulo 1, for each pixel otherwise
// (Cranley and Patterson 1976): by a lattice, found by search (METHOD.md, "Samples"), and as a whole by a hash of stream and
// seed. So the pixels that a filter averages share out the hemisphere among them. Any one pixel is uniform over the seeds.
vec2 stratified_sample(uvec2 pixel, uvec2 point, uint stream) {
    return unit_square(point + hash(uvec3(stream, seed, 0u)).xy + pixel.x * uvec2(1706056358u, 2975996583u) +
                       pixel.y * uvec2(767103493u, 2002359280u));
}

// The same by a hash of the pixel, for further bounces: moved by one lattice in all dimensions, neighbours would share out no
// more than a slice of them, and what a filter makes of them would be biased.
vec2 independent_sample(uint pixel, uvec2 point, uint stream) {
    return unit_square(point + hash(uvec3(pixel, seed, stream)).xy);
}

// Direction about unit n with density cos / pi (Malley's method in the basis of Duff et al. 2017).
vec3 cosine_direction(vec3 n, vec2 u) {
    float s = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + n.z);
    float b = n.x * n.y * a;
    vec3 tangent = vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x);
    vec3 bitangent = vec3(b, s + n.y * n.y * a, -n.y);
    float r = sqrt(u.x);
    float phi = 2.0 * PI * u.y;
    return normalize(tangent * (r * cos(phi)) + bitangent * (r * sin(phi)) + n * sqrt(max(1.0 - u.x, 0.0)));
}

// Where rays leave a surface: clear of it by more than float spacing and by a share of what it may be off, which is above
// the surface, never below. A small share is right where shadows touch what casts them; a large one saves steps.
vec3 leave(Surface s, float share) {
    float spacing = max(abs(s.position.x), max(abs(s.position.y), abs(s.position.z))) * 1e-6;
    return s.position + s.normal * (2.0 * max(share * s.epsilon, max(1e-4, spacing)));
}

// Cosine-distributed. With a footprint of 1e-3 a round opening of 60 degrees loses 0.4 % of its light, and with 3e-4 an emitter
// of 0.4 m in a room of 2 m gives 1.1 % too much, now 0.6 %. Finer costs 2 to 16 % more time of far light.
const float hemisphere_footprint = 1e-4;
Ray hemisphere_ray(Surface s, vec2 u, float reach) {
    return Ray(leave(s, 1.0), reach, cosine_direction(s.normal, u), hemisphere_footprint);
}

// What p, where the normal is n, sees of an emitter.
struct EmitterView {
    vec3 low;    // of the box, larger by what rays from p may be off: without that few of them met bright emitters beside their boxes
    vec3 high;
    vec3 faces;  // for each pair of faces what it fills of the view, times the cube of the distance: area times p's height above it
    float light;  // irradiance / pi if nothing is in the way, roughly; 0 where the emitter is behind the surface
};

EmitterView view_of_emitter(int i, vec3 p, vec3 n) {
    vec4 a = load(emitter_texels, 2u * uint(i)), b = load(emitter_texels, 2u * uint(i) + 1u);
    vec3 way = 0.5 * (a.xyz + b.xyz) - p;
    float square = dot(way, way);
    float margin = 2.0 * hemisphere_footprint * exp2(minimum_step) * sqrt(square) + 2.0 * float_spacing(p) + 1e-5;
    EmitterView e = EmitterView(a.xyz - margin, b.xyz + margin, vec3(0.0), 0.0);
    vec3 side = e.high - e.low;
    e.faces = side.yzx * side.zxy * max(max(e.low - p, p - e.high), 0.0);
    float height = max(dot(n, way) + 0.5 * dot(abs(n), side), 0.0);
    square = max(square, 0.25 * dot(side, side));
    e.light = a.w * (e.faces.x + e.faces.y + e.faces.z) * height / (PI * square * square);
    return e;
}

// A ray from the hemisphere, more often towards what emits, and by how much what it finds counts less for that: one-sample
// multiple importance sampling with the balance heuristic (Veach and Guibas 1995) of the cosine and of points spread over the
// seen faces of the emitters' boxes. Those need not fit: what comes from there is what the ray meets.
Ray guided_ray(Surface s, vec2 u, float reach, out float weight) {
    Ray ray = hemisphere_ray(s, u, reach);
    float all = 0.0;
    EmitterView own;  // the emitter that it may go to
    int own_index = -1;
    float v = u.y;  // stays uniform whatever is chosen by it
    for (int i = 0; i < emitter_count; ++i) {
        EmitterView e = view_of_emitter(i, ray.origin, s.normal);
        all += e.light;
        float chance = e.light / max(all, 1e-30);
        if (v < chance) {
            own = e;
            own_index = i;
            v /= chance;
        } else {
            v = (v - chance) / (1.0 - chance);
        }
    }
    float share = min(all / (all + 1.0), most_guided), way = 0.0;
    if (u.x < share) {
        float place = u.x / share * (own.faces.x + own.faces.y + own.faces.z);
        // The pair of faces, and the point of it.
        int axis = place < own.faces.x ? 0 : place < own.faces.x + own.faces.y ? 1 : 2;
        place = (place - (axis > 0 ? own.faces.x : 0.0) - (axis > 1 ? own.faces.y : 0.0)) / own.faces[axis];
        vec3 at = axis == 0 ? vec3(0.0, place, v) : axis == 1 ? vec3(v, 0.0, place) : vec3(place, v, 0.0);
        vec3 target = mix(own.low, own.high, clamp(at, 0.0, 1.0));
        target[axis] = ray.origin[axis] < own.low[axis] ? own.low[axis] : own.high[axis];
        way = distance(target, ray.origin);
        ray.direction = (target - ray.origin) / way;
    } else {
        own_index = -1;
        ray.direction = cosine_direction(s.normal, vec2((u.x - share) / (1.0 - share), u.y));
    }
    // The density of this direction.
    float cosine = dot(ray.direction, s.normal), density = 0.0;
    vec3 inverse = 1.0 / mix(ray.direction, vec3(1e-20), lessThan(abs(ray.direction), vec3(1e-20)));
    for (int i = 0; i < emitter_count; ++i) {
        EmitterView e = view_of_emitter(i, ray.origin, s.normal);
        vec3 to_low = (e.low - ray.origin) * inverse, to_high = (e.high - ray.origin) * inverse;
        vec3 first = min(to_low, to_high), last = max(to_low, to_high);
        float enters = max(first.x, max(first.y, first.z)), leaves = min(last.x, min(last.y, last.z));
        bool meets = i == own_index || (e.light > 0.0 && enters > 0.0 && enters <= leaves);
        if (i == own_index) enters = way;
        density += meets ? e.light / all * enters * enters * enters / (e.faces.x + e.faces.y + e.faces.z) : 0.0;
    }
    weight = cosine > 0.0 ? 1.0 / (1.0 - share + share * PI * density / cosine) : 0.0;
    ray.reach = cosine > 0.0 ? ray.reach : 0.0;
    return ray;
}

// To a light, and the irradiance that it brings if that ray meets nothing; neither where the light is behind the surface.
// Distance and angle are the surface's, not those of the ray, which starts a little above it.
Ray shadow_ray(Surface s, Light light, float start, out vec3 irradiance) {
    Ray ray = Ray(leave(s, start), 0.0, s.normal, 2e-4);
    vec3 to_light = light.directional != 0u ? -light.position : light.position - ray.origin;
    float way = length(to_light);
    if (way > 0.0) ray.direction = to_light / way;
    irradiance = vec3(0.0);
    if (s.material != no_surface && dot(ray.direction, s.normal) > 0.0) {
        ray.reach = light.directional != 0u ? far_reach : way;
        to_light = light.directional != 0u ? -light.position : light.position - s.position;
        float square = max(dot(to_light, to_light), 1e-8);  // of a directional light 1
        irradiance = light.intensity * (max(dot(s.normal, to_light), 0.0) * inversesqrt(square) / square);
    }
    return ray;
}

// Of a path whose last shadow ray has been traced.
vec3 settled(Path path, Hit hit) {
    return path.radiance + (hit.distance < 0.0 ? path.pending : vec3(0.0));
}

// Of one of a grid's places by rows.
uint index_in(ivec2 size, ivec2 at) {
    return uint(at.y * size.x + at.x);
}

// Of a picture's pixel by its number. Vector units divide no integers.
uvec2 place_of(uint pixel) {
    uint width = uint(image_size.x);
    uint y = uint((float(pixel) + 0.5) / float(width));
    if (y * width > pixel) --y;
    if ((y + 1u) * width <= pixel) ++y;
    return uvec2(pixel - y * width, y);
}

// To the centre of a pixel, along camera_forward 1: where the camera's surface lies for each metre of depth.
vec3 ray_at(ivec2 pixel) {
    vec2 q = (vec2(pixel) + 0.5) / vec2(image_size) * 2.0 - 1.0;
    return camera_forward + q.x * camera_right - q.y * camera_up;
}

// Of the second pixel's surface from the tangent plane of the first's, metres. A guide holds normal and depth; 0 for no surface.
float tangent_distance(vec4 guide, ivec2 pixel, vec4 other_guide, ivec2 other_pixel) {
    return dot(guide.xyz, other_guide.w * ray_at(other_pixel) - guide.w * ray_at(pixel));
}

// Of the tangent distance at which two pixels show different surfaces, 1 / metres; 0 for no surface.
float surface_sharpness(vec4 guide) {
    return guide.w > 0.0 ? 1.0 / max(2.0 * pixel_angle * guide.w, 1e-20) : 0.0;
}

// How far two pixels show the same surface, 0..1: the cosine of their normals to the 64th power times a Gaussian of the
// tangent distance, two pixels wide.
float same_surface(vec4 guide, vec4 other_guide, float tangent_distance, float sharpness) {
    float cosine = clamp(dot(guide.xyz, other_guide.xyz), 0.0, 1.0);
    float c4 = cosine * cosine * cosine * cosine;
    float c16 = c4 * c4 * c4 * c4;
    float plane = tangent_distance * sharpness;
    return guide.w > 0.0 && other_guide.w > 0.0 ? c16 * c16 * c16 * c16 * exp(-plane * plane) : 0.0;
}

// Light of a level of the wavelet, A B[F] / B[A] + B[N]: mean far radiance, which is smooth, times the openness of a narrow
// level, plus near light.
vec3 wavelet_light(vec4 far, vec3 near, int level, int narrow_level, float openness) {
    return near + (level > narrow_level ? openness / max(far.w, 1e-6) : 1.0) * far.rgb;  // without openness there is no far light
}

// The variance of what a level has beyond the coarser one, for that of a single pixel there and as widely averaged as anything.
// `gain` is what the level has left of it; of the B3 wavelet (Starck and Murtagh 1994) details have .79 / 1, .040 / .075, ... of
// their level's.
float noise_of_detail(float here, float gain, float around, int level) {
    return (level == 0 ? 0.79 : 0.5 * gain) * max(here, around);
}
