// The tangent of a line, which its colour and its light are made of: continuous along the line, not one value a segment.
//
// Symbols
//   u_i          unit vector of segment i, from point i to point i + 1; zero for a segment of no length
//   T_i          tangent at point i, the mean of u_i and of the last u before it, as unit vector. At the first point of a
//                streamline and of a fiblet it is u_i: the segment before belongs to a fiblet that is not decoded here, and
//                both fiblets can tell u_i from the later one's record
//   T(t)         between both, mix(T_i, T_(i+1), t), as unit vector
//
// Where a line turns back on itself the mean has no direction, and that of the segment before counts.

#include "codec/layout.glsl"
#include "frame/tangent.glsl"

// Of a vector of any length; of none it is none.
vec3 unit_or_none(vec3 d) {
    float size = max(abs(d.x), max(abs(d.y), abs(d.z)));
    return size > 0.0 ? normalize(d / size) : vec3(0.0);
}

// Of two unit vectors; either may be zero.
vec3 mean_direction(vec3 before, vec3 after) {
    vec3 sum = before + after;
    float square = dot(sum, sum);
    return square > 1e-6 ? sum * inversesqrt(square) : before;
}

// Tangents at both ends of a segment.
struct Tangents { vec3 start; vec3 end; };

// before: u of the last segment before that has one; here, after: u of this segment and of the next; leads: this one leads to
// a fiblet's first point.
Tangents tangents_of(vec3 before, vec3 here, vec3 after, bool leads) {
    Tangents t = Tangents(mean_direction(before, here), vec3(0.0));
    if (here != vec3(0.0)) before = here;
    t.end = leads && after != vec3(0.0) ? after : mean_direction(before, after);
    if (t.start == vec3(0.0)) t.start = t.end;
    return t;
}

// T(t), of any length.
vec3 tangent_between(Tangents ends, float t) {
    vec3 d = mix(ends.start, ends.end, t);
    return dot(d, d) > 1e-6 ? d : ends.start;
}

// Handed on in 32 bits each.
uvec2 packed_tangents(Tangents ends) { return uvec2(packed_tangent(ends.start, 0u), packed_tangent(ends.end, 0u)); }

vec3 unpacked_tangent(uint word) {
    ivec2 s = ivec2(int(word << 16) >> 16, int(word) >> 16);
    vec2 p = vec2(s) / FIBLET_DIRECTION_SCALE;
    float x = 1.0 - abs(p.x) - abs(p.y);
    if (x < 0.0) p = (1.0 - abs(p.yx)) * vec2(s.x < 0 ? -1.0 : 1.0, s.y < 0 ? -1.0 : 1.0);
    return normalize(vec3(x, p));
}

Tangents unpacked_tangents(uvec2 words) { return Tangents(unpacked_tangent(words.x), unpacked_tangent(words.y)); }
