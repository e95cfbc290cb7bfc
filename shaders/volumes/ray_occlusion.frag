// How open each pixel's surface point is: ambient occlusion in the volume itself, by rays.
// Paper: Lesar 2015, section III.G, equation (10):
//
//   A = 1/pi integral over the hemisphere of N of V(w) (N.w) dw     is about     1/n sum_i V(w_i)
//
// for n directions w_i whose density is (N.w) / pi. V(w) is 0 where a ray from the point crosses any of the surfaces within a
// radius, else 1. Rays end where planes of the caller's and the box cut the volume: beyond, nothing is there. The near and the far
// plane of the camera end none, so that what they hide does not change the light. What the caller's region takes away does not occlude.
//
// Directions are points of a square (u, v), as even as the two-dimensional golden ratio has them (Roberts' R2, additive recurrence),
// moved around by a hash of pixel and seed (Cranley and Patterson 1976), and taken to the disc below the hemisphere by r^2 = u
// (Malley). They are whole numbers until then: the same everywhere.
//
// Symbols
//   mu           value of the surface that the pixel shows
//   g            gradient by mm of the data; N, its normal towards the open side, in coordinates of the world
//   low, high    values between which all of the open side around the point is: what is beside them is behind a surface
//   to_data      directions: world -> data coordinates
//   radius       mm of the world
//
// The point is moved onto the surface first, along the gradient: interpolated ones (sparse casting) and those that nothing refined
// lie beside it. Rays then start a part of a voxel above it, and look at the field as often as those of the picture.
//
// Out: how many of the rays meet nothing, to be added to those of other draws: pvfiblets/engine/volumes/ray_occlusion.py casts them in
// portions.

#version 430

#include "volumes/block.glsl"
#include "volumes/field.glsl"
#include "volumes/ray.glsl"
#include "volumes/nodes.glsl"
#if FEATURE_CLIP_REGION
#include "regions/boundaries.glsl"

uniform mat4 to_clip;               // voxels -> clip coordinates, of any scale

// Whether a place in voxels is in the caller's region. Where that ends is drawn for the picture's pixels: beside them all is there.
bool is_there(vec3 p) {
    vec4 clip = to_clip * vec4(p, 1.0);
    vec2 size = 2.0 * half_picture, pixel = (0.5 * clip.xy / clip.w + 0.5) * size;
    if (clip.w <= 0.0 || any(lessThan(pixel, vec2(0.0))) || any(greaterThanEqual(pixel, size))) return true;
    return region_keeps(ivec2(pixel), clamp(0.5 * clip.z / clip.w + 0.5, 0.0, 1.0));
}
#endif

const float LIFT = {{ lift }};      // voxels
const float BESIDE = 0.1;           // voxels
const int FIRST_OWN_PLANE = 2;      // after near and far

uniform usampler2D surface_depth;
uniform sampler2D surface_position;   // mm along the pixel's ray, mu
uniform mat3 to_data;
uniform float radius;
uniform int samples;                // of this portion
uniform uint first_sample;
uniform uint seed;

layout(location = 0) out float free;

// PCG's output function over a linear congruential step (Jarzynski and Olano 2020).
uint hashed(uint x) {
    x = x * 747796405u + 2891336453u;
    x = ((x >> ((x >> 28) + 4u)) ^ x) * 277803737u;
    return (x >> 22) ^ x;
}

vec3 in_voxels(vec3 mm) { return mm * gradient_from_voxels; }

#if FEATURE_VOLUME_NEAREST
// Just behind the face of the voxel that the ray enters, by halving.
vec3 on_surface(Ray ray, float hit, float mu) {
    float a = hit - ray_step, b = hit + ray_step;
    bool above = value_at(at(ray, a)) >= mu;
    if (above == (value_at(at(ray, b)) >= mu)) return at(ray, hit);
    for (int k = 0; k < 12; ++k) {
        float middle = 0.5 * (a + b);
        if ((value_at(at(ray, middle)) >= mu) == above) a = middle;
        else b = middle;
    }
    return at(ray, b);
}
#else
vec3 on_surface(Ray ray, float hit, float mu) {
    vec3 p = at(ray, hit);
    float psi = value_at(p) - mu;
    for (int k = 0; k < 2 && psi != 0.0; ++k) {
        vec3 g = gradient_at(p), move = in_voxels(g) * (-psi / max(dot(g, g), 1e-30));
        vec3 next = p + move * min(1.0, 0.5 / max(length(move), 1e-30));
        float after = value_at(next) - mu;
        if (abs(after) >= abs(psi)) break;
        p = next;
        psi = after;
    }
    return p;
}
#endif

// A ray as far as there is a volume, from its start.
Ray ray_from(vec3 o, vec3 d) {
    Ray ray;
    ray.o = o;
    ray.d = d;
    vec3 least = max(abs(d), 1e-20);
    ray.inverse = vec3(d.x < 0.0 ? -1.0 : 1.0, d.y < 0.0 ? -1.0 : 1.0, d.z < 0.0 ? -1.0 : 1.0) / least;
    vec3 to_low = (box_low - o) * ray.inverse, to_high = (box_high - o) * ray.inverse;
    vec3 enter = min(to_low, to_high), leave = max(to_low, to_high);
    ray.first = max(max(enter.x, max(enter.y, enter.z)), 0.0);
    ray.last = min(leave.x, min(leave.y, leave.z));
    for (int plane = FIRST_OWN_PLANE; plane < ray_plane_count; ++plane) {
        narrow(dot(ray_planes[plane], vec4(o, 1.0)), dot(ray_planes[plane].xyz, d), ray.first, ray.last);
    }
    return ray;
}

bool is_open(Ray ray, float low, float high) {
    float t = ray.first, step = ray_step;
    while (t < ray.last) {
        float number, end = t + to_end_of_node(ray, t, 0.5, number);
        if (number <= 0.5 && end - t >= step) {
            t += floor((end - t) / step) * step;
            if (t >= ray.last) return true;
        }
        do {
            t = min(t + step, ray.last);
            float v = value_at(at(ray, t));
#if FEATURE_CLIP_REGION
            if ((v < low || v >= high) && is_there(at(ray, t))) return false;
#else
            if (v < low || v >= high) return false;
#endif
        } while (t < end && t < ray.last);
    }
    return true;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    free = 0.0;
    if (texelFetch(surface_depth, pixel, 0).x == 0xFFFFFFFFu) return;
    vec2 shown = texelFetch(surface_position, pixel, 0).xy;
    Ray seen = ray_of(gl_FragCoord.xy);
    float mu = shown.y;
    vec3 p = on_surface(seen, shown.x, mu);
    vec3 g = gradient_at(p), way = mm_from_voxels * seen.d;
    float size = max(abs(g.x), max(abs(g.y), abs(g.z)));
#if FEATURE_VOLUME_NEAREST
    bool above = value_at(p) < mu;
#else
    // By the field next to the surface: differences of two voxels pass over what is thinner than these.
    vec3 little = seen.d * (BESIDE / length(seen.d));
    bool above = value_at(p - little) > value_at(p + little);
#endif
    // Not to the viewer: where a surface turns away, that of differences may be on the other side of it.
    vec3 towards = size > 0.0 ? (above ? g : -g) / size : -way;
    // A gradient turns with the inverse's transpose.
    vec3 normal = normalize(transpose(to_data) * towards);
    float low = above ? mu : -3e38, high = above ? 3e38 : mu;
    for (int k = 0; k < isovalue_count; ++k) {
        float other = isovalues[k];
        if (other > mu) high = min(high, other);
        if (other < mu) low = max(low, other);
    }
    vec3 up = in_voxels(to_data * normal);
    vec3 lifted = p + up * (LIFT / length(up));
    float there = value_at(lifted);
    p = there < low || there >= high ? p - seen.d * (LIFT / length(seen.d)) : lifted;
    // A base around the normal without a seam (Duff et al. 2017).
    float side = normal.z < 0.0 ? -1.0 : 1.0, a = -1.0 / (side + normal.z), b = normal.x * normal.y * a;
    vec3 right = vec3(1.0 + side * normal.x * normal.x * a, side * b, -side * normal.x);
    vec3 ahead = vec3(b, side + normal.y * normal.y * a, -normal.y);
    uint turn = hashed(uint(pixel.x) + hashed(uint(pixel.y) + hashed(seed)));
    const uvec2 golden = uvec2({{ golden_u }}u, {{ golden_v }}u);
    uvec2 place = uvec2(turn, hashed(turn)) + first_sample * golden;
    for (int i = 0; i < samples; ++i) {
        place += golden;
        float squared = float(place.x >> 8) / 16777216.0, angle = float(place.y >> 8) * (6.283185307 / 16777216.0);
        vec2 flat_part = sqrt(squared) * vec2(cos(angle), sin(angle));
        vec3 d = to_data * (flat_part.x * right + flat_part.y * ahead + sqrt(1.0 - squared) * normal);
        float length_in_data = length(d);
        Ray ray = ray_from(p, in_voxels(d / length_in_data));
        ray.last = min(ray.last, radius * length_in_data);
        free += is_open(ray, low, high) ? 1.0 : 0.0;
    }
}
