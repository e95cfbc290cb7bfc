// The tangent of a line, which its colour and its light are made of: continuous along the line, not one value a segment.
//
// Symbols
//   u_i          unit vector of segment i, from point i to point i + 1; one of no length has none
//   T_i          tangent at point i, the mean of u_(i-1) and u_i, as unit vector. At the first point of a streamline and of a
//                fiblet it is u_i: the segment before belongs to a fiblet that is not decoded here, and both fiblets can tell
//                u_i from the later one's record
//   T(t)         between both, mix(T_i, T_(i+1), t), as unit vector
//
// A segment of no length is stepped over: its neighbours are those next to it that have a length. Where a line turns back on
// itself the mean has no direction, and that of the segment before counts.
//
// Tangents are handed on in 32 bits, and interpolated from those: all pipelines show the same.

#include "codec/layout.glsl"
#include "frame/tangent.glsl"

// Of a vector of any length; of none it is none.
vec3 unit_or_none(vec3 d) {
    float size = max(abs(d.x), max(abs(d.y), abs(d.z)));
    return size > 0.0 ? normalize(d / size) : vec3(0.0);
}

vec3 mean_direction(vec3 before, vec3 after) {
    vec3 sum = before + after;
    return dot(sum, sum) > 1e-6 ? sum : before;
}

// Packed tangents at both ends of a segment. Directions of any length: of the segment before, of this one, of the one after;
// leads: this one leads to a fiblet's first point.
uvec2 tangents_at_ends(vec3 before, vec3 here, vec3 after, bool leads) {
    vec3 u = unit_or_none(before), v = unit_or_none(here), w = unit_or_none(after);
    bool none = v == vec3(0.0);
    vec3 start = mean_direction(u, none ? w : v), end = mean_direction(none ? u : v, w);
    if (leads && w != vec3(0.0)) end = w;
    return uvec2(packed_tangent(start, 0u), packed_tangent(end, 0u));
}

vec3 unpacked_tangent(uint word) {
    ivec2 s = ivec2(int(word << 16) >> 16, int(word) >> 16);
    vec2 p = vec2(s) / FIBLET_DIRECTION_SCALE;
    float x = 1.0 - abs(p.x) - abs(p.y);
    if (x < 0.0) p = (1.0 - abs(p.yx)) * vec2(s.x < 0 ? -1.0 : 1.0, s.y < 0 ? -1.0 : 1.0);
    return normalize(vec3(x, p));
}

// T(t), of any length.
vec3 tangent_between(uvec2 ends, float t) {
    vec3 a = unpacked_tangent(ends.x), d = mix(a, unpacked_tangent(ends.y), t);
    return dot(d, d) > 1e-8 ? d : a;
}

uint packed_tangent_between(uvec2 ends, float t) {
    return ends.x == ends.y ? ends.x : packed_direction(tangent_between(ends, t));
}
