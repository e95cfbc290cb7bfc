// Whether a fiblet is wholly behind the depth drawn so far: two-phase culling against a depth pyramid.
//
// Fiblets visible in the last picture are drawn first; the pyramid is made of that depth, so that it belongs to this very
// camera, and anything that it hides is hidden in the finished picture. The paper (Schertzer et al. 2022, section 3.4) tests against the
// last picture's dilated depth; culling/coverage.glsl does that.
//
// Symbols
//   (X, Y, Z, W) homogeneous window coordinates (frame/blocks.glsl); X, Y, Z, W are linear in position
//   m            farthest depth in the squares of pixels that the capsule may touch, a key's upper end
//   h(p)         Z - m W: positive behind depth m. The points with h > 0 are a half-space
//   r            the capsule's radius, that of tubes included
//
// Algorithm
//   1. The capsule is cut into pieces; a piece lies within the rectangle around its ends' pixels, r and a margin further out.
//   2. The level of the pyramid is taken at which the rectangle spans no more than four squares each way; for the capsule as
//      a whole, which is tried first, no more than two.
//   3. The piece is hidden if both ends have h > r |grad h|: a capsule is the convex hull of two balls, and a half-space
//      that holds both balls holds the hull. This is exact for any projection, without a division.
//   4. A fiblet is hidden if all its pieces are. One that reaches beside or behind the camera never is.
//
// Invariant: a hidden fiblet has no visible pixel. Pixels of thin lines are up to one pixel off the line
// (fiblets/segments/thin_line_rule.glsl), pixels of wide lines half the width. Depth is that of the line itself; but the first pixel of a thin
// segment shows a place before its start, CELL_SHIFT / n of the segment, and the last one after its end: `overshoot`.
// Rounding of h is paid by `slack`.

#include "culling/bounds.glsl"
#include "frame/project.glsl"

#include "culling/pyramid_lookup.glsl"

const float MARGIN = 1.5;  // pixels
const float PIECES = 4.0;

vec3 gradient(int row) { return vec3(window_from_local[0][row], window_from_local[1][row], window_from_local[2][row]); }

// Pixels that a ball of radius r around a point with these coordinates reaches at most, to either side.
vec2 reach_of(vec4 c, vec2 s, float r) {
    float w = c.w - r * w_per_mm;
    vec2 across = vec2(length(gradient(0) - s.x * gradient(3)), length(gradient(1) - s.y * gradient(3)));
    return r * across / w;
}

// Depth from a ball's middle to its ends, at most.
float rise_of(vec4 c, float r) {
    float z = c.z / c.w;
    return r * length(gradient(2) - z * gradient(3)) / (c.w - r * w_per_mm);
}

// Greatest excess of the first pixel of a thin segment, nearer than the line.
float overshoot_of(vec4 a, vec4 b, float r) {
    float rise = abs(a.z / a.w - b.z / b.w) + rise_of(a, r) + rise_of(b, r);
    return half_line_width > 0.0 ? 0.0 : max(CELL_SHIFT.x, CELL_SHIFT.y) * rise;
}

// What h may lose to rounding, here and where the line is drawn: some parts in 2^23 of the terms that it is summed from,
// which are larger than W where the near and the far plane are close together.
float slack_of(Capsule c) {
    vec3 terms = abs(gradient(2)) + abs(gradient(3));
    return 1e-6 * (dot(terms, max(abs(c.a), abs(c.b)) + body_of(c)) + abs(window_from_local[3].z) + abs(window_from_local[3].w));
}

bool piece_hidden(vec4 a, vec4 b, float r, float overshoot, float slack, bool whole) {
    vec2 sa = a.xy / a.w, sb = b.xy / b.w, pad = max(reach_of(a, sa, r), reach_of(b, sb, r)) + half_line_width + MARGIN;
    vec2 low = min(sa, sb) - pad, high = max(sa, sb) + pad;
    bool beside = any(greaterThanEqual(low, viewport)) || any(lessThan(high, vec2(0.0)));
    ivec2 first = ivec2(clamp(low, vec2(0.0), viewport - 1.0)), last = ivec2(clamp(high, vec2(0.0), viewport - 1.0));
    float m = whole ? farthest_around(first, last) : farthest_in(first, last);
    bool deep = m > 1.0;
    m += overshoot;
    float away = r * length(gradient(2) - m * gradient(3));
    return beside || (!deep && min(a.z - m * a.w, b.z - m * b.w) > away + slack);
}

bool in_front(vec4 a, vec4 b, float r) { return min(a.w, b.w) > 1.01 * r * w_per_mm; }

bool hidden_as_a_whole(Capsule c) {
    vec4 a = to_homogeneous(c.a), b = to_homogeneous(c.b);
    float r = body_of(c);
    return in_front(a, b, r) && piece_hidden(a, b, r, overshoot_of(a, b, r), slack_of(c), true);
}

bool hidden_in_pieces(Capsule c) {
    vec4 a = to_homogeneous(c.a), b = to_homogeneous(c.b);
    float r = body_of(c), overshoot = overshoot_of(a, b, r), slack = slack_of(c);
    bool all_hidden = in_front(a, b, r);
    vec4 from = a;
    for (float i = 1.0; i <= PIECES && all_hidden; ++i) {
        vec4 to = mix(a, b, i / PIECES);
        all_hidden = piece_hidden(from, to, r, overshoot, slack, false);
        from = to;
    }
    return all_hidden;
}

bool hidden(Capsule c) { return hidden_as_a_whole(c) || hidden_in_pieces(c); }
