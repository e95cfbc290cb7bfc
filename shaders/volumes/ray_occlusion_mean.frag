// Mean of the occlusion by rays over squares of 5 x 5 pixels, as far as these show the same piece of surface.
// After volumes/ray_occlusion.frag, whose error is another in each pixel: the mean of 25 would err as 25 times the rays do.
//
//   mean = sum w_j free_j / sum w_j
//   w_j  = max(0, 1 - |N.(p_j - p)| / away) * max(0, 1 - |p_j - p|^2 / near^2) * max(0, 1 - (1 - N.N_j) / bend)
//
// over pixels j of the same surface. The first factor keeps what lies in the plane of the pixel's surface and leaves out what is
// before or behind it; the second what is too far away to be as open, where pixels are large; the third what faces elsewhere, as
// the other side of an edge.
//
// Symbols
//   p, N         place and normal of the surface, mm of the data
//   away, near   mm at which nothing mixes any more
//   bend         1 less the cosine of an angle, likewise
//
// Out: a number of rays, as before.

#version 430

#include "volumes/block.glsl"

const int REACH = 2;
const uint EMPTY = 0xFFFFFFFFu;

uniform usampler2D surface_depth;
uniform sampler2D surface_position;
uniform usampler2D surface_normal;    // unit, mm of the data, octahedral about +x, two snorm16
uniform sampler2D rough;
uniform float away;
uniform float near;
uniform float bend;

layout(location = 0) out float free;

vec3 normal_of(ivec2 pixel) {
    uint word = texelFetch(surface_normal, pixel, 0).x;
    ivec2 s = ivec2(int(word << 16) >> 16, int(word) >> 16);
    vec2 p = vec2(s) / 32767.0;
    float x = 1.0 - abs(p.x) - abs(p.y);
    if (abs(s.x) + abs(s.y) > 32767) p = (1.0 - abs(p.yx)) * vec2(s.x < 0 ? -1.0 : 1.0, s.y < 0 ? -1.0 : 1.0);
    return normalize(vec3(x, p));
}

vec3 in_mm(vec3 voxels) { return mm_from_voxels * voxels; }

// But for the place of the first voxel, which falls out of differences.
vec3 place_of(ivec2 pixel, float t) {
    vec2 right = vec2(pixel) + 0.5 - half_picture;
    vec3 way = in_mm(ray_direction[0] + right.x * ray_direction[1] + right.y * ray_direction[2]);
    vec3 start = in_mm(ray_origin[0] + right.x * ray_origin[1] + right.y * ray_origin[2]);
    return start + t * (way / max(length(way), 1e-30));
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy), last = textureSize(surface_depth, 0) - 1;
    free = 0.0;
    if (texelFetch(surface_depth, pixel, 0).x == EMPTY) return;
    vec2 shown = texelFetch(surface_position, pixel, 0).xy;
    vec3 place = place_of(pixel, shown.x), normal = normal_of(pixel);
    vec2 sum = vec2(texelFetch(rough, pixel, 0).x, 1.0);
    for (int y = -REACH; y <= REACH; ++y) {
        for (int x = -REACH; x <= REACH; ++x) {
            ivec2 other = pixel + ivec2(x, y);
            if (other == pixel || any(lessThan(other, ivec2(0))) || any(greaterThan(other, last))) continue;
            if (texelFetch(surface_depth, other, 0).x == EMPTY) continue;
            vec2 there = texelFetch(surface_position, other, 0).xy;
            if (there.y != shown.y) continue;
            vec3 apart = place_of(other, there.x) - place;
            float weight = max(0.0, 1.0 - abs(dot(normal, apart)) / away) * max(0.0, 1.0 - dot(apart, apart) / (near * near))
                         * max(0.0, 1.0 - (1.0 - dot(normal, normal_of(other))) / bend);
            sum += weight * vec2(texelFetch(rough, other, 0).x, 1.0);
        }
    }
    free = sum.x / sum.y;
}
