// Sparse casting, phase 2: what lies between rays is interpolated where they agree; elsewhere pixels are left to rays of their own.
// Paper: Lesar 2015, section III.D.
//
// Rays agree if all four around a pixel meet something or none does, and what they meet differs by no more than a threshold:
// colours and opacities, values over their range, normals, and depths by what the slope of the surface explains.
//
// Depth out: 0 where the pixel is done, 1 where it wants a ray.

#version 430

#include "volumes/block.glsl"
#include "codec/layout.glsl"
#include "frame/tangent.glsl"

uniform usampler2D coarse_depth;
uniform usampler2D coarse_owner;
uniform sampler2D coarse_position;
#if FEATURE_VOLUME_SURFACE
uniform usampler2D coarse_normal;
#elif FEATURE_VOLUME_COMPOSITE
uniform sampler2D coarse_colour;
#endif
uniform int ray_stride;
uniform ivec2 last_pixel;
uniform float threshold;

layout(location = 0) out uint out_depth;
layout(location = 1) out uint out_owner;
layout(location = 2) out uvec2 out_ids;
layout(location = 3) out vec2 out_position;
#if FEATURE_VOLUME_SURFACE
layout(location = 4) out uint out_normal;

// Inverse of packed_direction().
vec3 unpacked(uint word) {
    ivec2 s = ivec2(int(word << 16) >> 16, int(word) >> 16);
    vec2 p = vec2(s) / FIBLET_DIRECTION_SCALE;
    float x = 1.0 - abs(p.x) - abs(p.y);
    if (x < 0.0) p = (1.0 - abs(p.yx)) * vec2(s.x < 0 ? -1.0 : 1.0, s.y < 0 ? -1.0 : 1.0);
    return normalize(vec3(x, p));
}
#endif
#if FEATURE_VOLUME_COMPOSITE
layout(location = 4) out vec4 out_colour;
#endif

void main() {
    vec2 place = (gl_FragCoord.xy - 0.5 - float(ray_stride / 2)) / float(ray_stride);
    ivec2 last = textureSize(coarse_depth, 0) - 1, low = clamp(ivec2(floor(place)), ivec2(0), last), high = min(low + 1, last);
    // The last rays of a row or column lie at the picture's edge, nearer than a stride.
    vec2 from = vec2(min(low * ray_stride + ray_stride / 2, last_pixel)), to = vec2(min(high * ray_stride + ray_stride / 2, last_pixel));
    vec2 share = clamp((gl_FragCoord.xy - 0.5 - from) / max(to - from, 1.0), 0.0, 1.0);
    ivec2 at[4] = ivec2[4](low, ivec2(high.x, low.y), ivec2(low.x, high.y), high);
    float weights[4] = float[4]((1.0 - share.x) * (1.0 - share.y), share.x * (1.0 - share.y), (1.0 - share.x) * share.y, share.x * share.y);
    uint found = 0u;
    float far[4], least = 3e38, greatest = -3e38, mean = 0.0;
    vec2 position = vec2(0.0), lowest = vec2(3e38), highest = vec2(-3e38);
    for (int k = 0; k < 4; ++k) {
        uint key = texelFetch(coarse_depth, at[k], 0).x;
        far[k] = float(0xFFFFFFFFu - key);
        found += key != 0xFFFFFFFFu ? 1u : 0u;
        vec2 p = texelFetch(coarse_position, at[k], 0).xy;
        lowest = min(lowest, p);
        highest = max(highest, p);
        position += weights[k] * p;
        mean += weights[k] * far[k];
    }
    // Beyond the outermost rays there is nothing to interpolate between.
    bool between = all(greaterThanEqual(gl_FragCoord.xy - 0.5, from)) && all(lessThanEqual(gl_FragCoord.xy - 0.5, to));
    bool alike = found == 4u && between;
#if FEATURE_VOLUME_SURFACE
    // Of a plane, depths of opposite corners have one sum.
    vec3 normal = vec3(0.0), first = unpacked(texelFetch(coarse_normal, at[0], 0).x);
    for (int k = 0; k < 4; ++k) {
        vec3 n = unpacked(texelFetch(coarse_normal, at[k], 0).x);
        alike = alike && dot(n, first) > 1.0 - threshold;
        normal += weights[k] * n;
    }
    float spread = max(max(far[0], far[1]), max(far[2], far[3])) - min(min(far[0], far[1]), min(far[2], far[3]));
    alike = alike && abs(far[0] + far[3] - far[1] - far[2]) <= max(threshold * spread, 1024.0) && lowest.y == highest.y;
    out_normal = alike ? packed_direction(normal) : 0u;
    vec3 along = abs(normal.x) < 0.7 * length(normal) ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    uint tangent = alike ? packed_tangent(cross(normal, along), 0u) : 0u;
#elif FEATURE_VOLUME_COMPOSITE
    vec4 colour = vec4(0.0), low_colour = vec4(1.0), high_colour = vec4(0.0);
    for (int k = 0; k < 4; ++k) {
        vec4 c = texelFetch(coarse_colour, at[k], 0);
        c.rgb *= c.a;
        low_colour = min(low_colour, c);
        high_colour = max(high_colour, c);
        colour += weights[k] * c;
    }
    vec4 differ = high_colour - low_colour;
    alike = alike && max(max(differ.x, differ.y), max(differ.z, differ.w)) <= threshold;
    out_colour = vec4(colour.rgb / max(colour.a, 1e-6), colour.a);
#else
    alike = alike && highest.y - lowest.y <= threshold * (transfer_high - transfer_low);
#endif
    bool nothing = found == 0u;
    out_depth = alike ? 0xFFFFFFFFu - uint(clamp(mean, 1.0, 4294967040.0)) : 0xFFFFFFFFu;
    out_owner = alike ? texelFetch(coarse_owner, at[weights[0] >= max(weights[1], max(weights[2], weights[3])) ? 0
        : weights[1] >= max(weights[2], weights[3]) ? 1 : weights[2] >= weights[3] ? 2 : 3], 0).x : 0xFFFFFFFFu;
#if FEATURE_VOLUME_SURFACE
    out_ids = uvec2(0u, tangent);
#else
    out_ids = uvec2(0u);
#endif
    out_position = alike ? position : vec2(0.0);
    gl_FragDepth = alike || nothing ? 0.0 : 1.0;
}
