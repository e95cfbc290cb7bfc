// A segment of a spline tube: from two nodes to the control points of its two quadratic halves.
// Paper: Russig et al. 2020, "GPU-based Raycasting of Hermite Spline Tubes", section 3.2, "Segment subdivision".
//
// Symbols
//   n_i, n_j     nodes: position and radius; m_i, m_j their derivatives by the segment's parameter
//   a1, a2, a3   control points of the first half; b1, b2, b3 of the second
//   c            1/4; the paper has 1/3
//
// Algorithm
//   a1 = n_i    a2 = n_i + c m_i    a3 = b1 = (a2 + b2) / 2    b2 = n_j - c m_j    b3 = n_j
// The halves meet with one tangent. With c = 1/4 they meet on the cubic itself and have its derivatives at both nodes, so
// that they are off by |2 (n_i - n_j) + m_i + m_j| / 54 at most; with 1/3 they miss its middle by (m_i - m_j) / 24.
// Bezier curves stay within the hull of their control points, and radii with all of theirs at least 0 stay so too.
//
// A tube thinner than the least width is widened to it: radii of control points grow to that of their depth, the same for
// all segments that share a node. Where edges are smoothed, that is a pixel at least, and what is between edges may be less.

#include "frame/blocks.glsl"
#include "tubes/block.glsl"

uniform usamplerBuffer node_texels;      // two of each node: place, radius; derivatives of both
uniform usamplerBuffer segment_texels;   // nodes i and j, tube, flags: 1, 2: another segment goes on before i, after j; 4: hidden

struct Segment {
    vec3 centre;        // of the control points, local mm
    float size;         // mm: their largest distance from it, radius included
    vec4 a1;            // control points relative to the centre, over the size; w: radius
    vec4 a2;
    vec4 b2;
    vec4 b3;
    uvec2 ids;          // tube, flags
    ivec3 place;        // of the first node, in integers from the reference
    vec3 middle;        // from there to the centre, mm
};

float w_of(vec3 p) {
    return window_from_local[0].w * p.x + window_from_local[1].w * p.y + window_from_local[2].w * p.z
         + window_from_local[3].w;
}

float least_radius(vec3 p) { return tube_least_over_w * max(w_of(p), 0.0); }

// Length that neither overflows nor vanishes where squares would.
float safe_length(vec3 v) {
    float size = max(abs(v.x), max(abs(v.y), abs(v.z)));
    return size > 0.0 ? size * length(v / size) : 0.0;
}

Segment segment_of(int index) {
    uvec4 s = texelFetch(segment_texels, index);
    uvec4 i = texelFetch(node_texels, 2 * int(s.x)), j = texelFetch(node_texels, 2 * int(s.y));
    vec4 m_i = uintBitsToFloat(texelFetch(node_texels, 2 * int(s.x) + 1));
    vec4 m_j = uintBitsToFloat(texelFetch(node_texels, 2 * int(s.y) + 1));
    vec3 start = vec3(ivec3(i.xyz) - ivec3(reference)) * tube_place_scale;
    vec3 run = vec3(ivec3(j.xyz) - ivec3(i.xyz)) * tube_place_scale;
    float c = tube_control_share * (tube_by_length != 0 ? safe_length(run) : 1.0);
    vec4 a1 = vec4(vec3(0.0), uintBitsToFloat(i.w)), b3 = vec4(run, uintBitsToFloat(j.w));
    vec4 a2 = a1 + c * m_i, b2 = b3 - c * m_j;
    vec4 least = vec4(least_radius(start), least_radius(start + a2.xyz), least_radius(start + b2.xyz), least_radius(start + run));
    a1.w = max(a1.w, least.x);
    a2.w = max(a2.w, least.y);
    b2.w = max(b2.w, least.z);
    b3.w = max(b3.w, least.w);
    vec3 low = min(min(a1.xyz, a2.xyz), min(b2.xyz, b3.xyz)), high = max(max(a1.xyz, a2.xyz), max(b2.xyz, b3.xyz));
    vec3 middle = 0.5 * (low + high), extent = 0.5 * (high - low);
    float size = max(extent.x, max(extent.y, extent.z)) + max(max(a1.w, a2.w), max(b2.w, b3.w));
    size = max(size, 1e-30);
    vec4 shift = vec4(middle, 0.0);
    return Segment(start + middle, size, (a1 - shift) / size, (a2 - shift) / size, (b2 - shift) / size,
                   (b3 - shift) / size, s.zw, ivec3(i.xyz) - ivec3(reference), middle);
}

// How much wider the control points of a segment are than the tube is, over its size.
vec4 widened_by(int index, Segment s) {
    uvec4 nodes = texelFetch(segment_texels, index);
    float scale = tube_by_length != 0 ? s.size * safe_length(s.b3.xyz - s.a1.xyz) : 1.0, c = tube_control_share * scale;
    float i = uintBitsToFloat(texelFetch(node_texels, 2 * int(nodes.x)).w), j = uintBitsToFloat(texelFetch(node_texels, 2 * int(nodes.y)).w);
    float m_i = uintBitsToFloat(texelFetch(node_texels, 2 * int(nodes.x) + 1).w), m_j = uintBitsToFloat(texelFetch(node_texels, 2 * int(nodes.y) + 1).w);
    vec4 drawn = s.size * vec4(s.a1.w, s.a2.w, s.b2.w, s.b3.w), own = vec4(i, i + c * m_i, j - c * m_j, j);
    vec4 least = vec4(w_of(s.centre + s.size * s.a1.xyz), w_of(s.centre + s.size * s.a2.xyz),
                      w_of(s.centre + s.size * s.b2.xyz), w_of(s.centre + s.size * s.b3.xyz));
    return max(drawn - max(own, tube_own_least_over_w * max(least, 0.0)), 0.0) / s.size;
}

vec4 junction(Segment s) { return 0.5 * (s.a2 + s.b2); }

vec4 quadratic(vec4 p0, vec4 p1, vec4 p2, float t) { return mix(mix(p0, p1, t), mix(p1, p2, t), t); }
