// Line or halo, and how deep it lies.
// Paper: Everts et al. 2009, sections 3.3 (equations 2 and 3), 3.4 (tapering, smooth edges) and 3.6 (filtering).
//
// Symbols
//   r            distance from the axis over half the strip's width, 2 s / w_strip in the paper: |v|, and around vertices where
//                lines bend sharply, and of points, the distance from that place
//   m            half width that the mask leaves, 0..1: sqrt(x (2 - x)), an ellipse, x = min(u, 1 - u) / 0.2 at most 1
//   f            displacement function
//
// Algorithm
// Line where r <= share m, halo where r <= m, nothing beyond. A halo lies d_max f(r) farther from the viewer than its line. Where
// a filter's threshold cuts a line its distance along the line, estimated by how fast the number changes, is the mask's x.
// The depth buffer keeps the nearest: 1 - depth, so that float32 is fine far away.
//
// Out: item | place along the segment, 16 bits; ink, 8 bits; halo or line, 1 bit.

#version 430

#include "frame/blocks.glsl"
#include "halos/block.glsl"
#define HANDED in
#include "halos/handed.glsl"

layout(location = 0) out uvec2 shown;

float displacement(float x) {
    if (halo_counts.y == 0) return x;
    if (halo_counts.y == 1) return x * x;
    if (halo_counts.y == 2) return sqrt(x);
    float at = x * float(halo_counts.z - 1);
    int before = min(int(at), halo_counts.z - 2), after = before + 1;
    return mix(halo_table[before >> 2][before & 3], halo_table[after >> 2][after & 3], at - float(before));
}

float mask(float x) {
    float within = clamp(x, 0.0, 1.0);
    return sqrt(within * (2.0 - within));
}

void main() {
    float across = handed_strip.x, along = handed_strip.y;
#if FEATURE_HALO_POINTS
    float r = length(vec2(across, along));
    float t = 0.0;
#else
    float past = max(max(-along, along - handed_length), 0.0);
    float r = length(vec2(across, past));
    float t = handed_length > 0.0 ? clamp(along / handed_length, 0.0, 1.0) : 0.0;
#endif
    float half_strip = inversesqrt(max(dot(vec2(dFdx(across), dFdy(across)), vec2(dFdx(across), dFdy(across))), 1e-30));
    float m = halo_mask.x > 0.0 ? mask(5.0 * min(handed_strip.z, 1.0 - handed_strip.z)) : 1.0;
#if FEATURE_HALO_FILTER
    float a = handed_filter.x, inside = min(a - halo_filter.x, halo_filter.y - a);
    if (!(inside >= 0.0)) discard;       // NaN as well
    if (halo_filter.z > 0.0) m = min(m, mask(inside / max(handed_filter.y * halo_filter.z, 1e-30)));
#endif
    if (!(r <= m)) discard;
    float edge = handed_strip.w * m;
    bool line = r <= edge;
    float w = 1.0 / gl_FragCoord.w, d = line ? 0.0 : halo_depth.x * displacement(r);
    float back = d * (halo_depth.y + halo_depth.z / (w * (w + halo_depth.w * d)));
    gl_FragDepth = max(gl_FragCoord.z - back, 1e-9);       // a halo beyond the far plane is there
    float ink = halo_filter.w > 0.0 ? clamp(0.5 - (r - edge) * half_strip, 0.0, 1.0) : float(line);
    shown = uvec2(handed_item, uint(t * 65535.0 + 0.5) << 16u | uint(ink * 255.0 + 0.5) << 8u | (line ? 1u : 0u));
}
