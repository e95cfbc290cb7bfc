// Where a ray meets one half of a segment. Paper: Russig et al. 2020, section 3.2, "Intersection" and "Root finding".
//
//        |  f(t) = h(t) - sqrt g(t), real where g >= 0          A ray that meets the tube twice has two such parts,
//        | \         /        \    /                            and of each the lowest point is an entry. All of a
//      l |  \       /          \__/  <- second entry            part lies between its entry and its exit, the
//        |   \__*__/  <- nearest entry                          greatest h + sqrt g: what is between is inside.
//        +----------------------------> t
//
// Algorithm
//   1. g has the five Bezier coefficients <q_i, q_j>: with none positive the ray misses. Most fragments end here.
//   2. Where g is concave, and f convex for certain, f has one minimum: the root of F1 in all of 0..1, or an end. One search.
//   3. Else, and always with the paper's own bisection: roots of g'' by formula; between these, of g'; between these, of g:
//      the parts. In every part roots of f''', then f'', then f': the minima. The paper found one root of f''' at most; tubes
//      whose radius changes as fast as their length have up to three, so that it is looked for in both halves of a part.
// All that can be wrong with a t is that it is not the best: every t with g >= 0 is a point of the tube.
//
// Ends. A sphere closes each end of a half. Where another one goes on, an entry or exit there that is not also one of f' = 0
// is inside the other: it is left to that, or looking along the inside of a tube would show a wall at each node.
//
// The ray is looked at from `first` on. What it is inside of there is cut open (kind CUT) where a plane or region of the
// caller's made `first`; where the near plane did, its exit shows (EXIT): one is inside and sees the wall.

// Needs tubes/functions.glsl before it.

#include "tubes/roots.glsl"

float f_at(float t) {
    vec3 q = q_a + t * (q_b + t * q_c);
    return h_a + t * (h_b + t * h_c) - sqrt(max(product(q, q), 0.0));
}

// Whether an extremum at an end where another segment goes on is that one's.
bool others(float t, bool joined) {
    if (!joined) return false;
    vec3 q = q_a + t * (q_b + t * q_c), dq = q_b + 2.0 * t * q_c;
    float g1 = product(q, dq), s = sqrt(max(product(q, q), 0.0)), sloped = s * (h_b + 2.0 * t * h_c);
    return abs(sloped - g1) > 1e-3 * (abs(sloped) + abs(g1)) + 4e-6 * length(q) * length(dq);
}

// Least f of a part, by the chain of derivatives.
void least_of_part(float lo, float hi, float fine, out float l, out float t) {
    float cuts[5], stops[3] = float[3](lo, 0.5 * (lo + hi), hi);
    cuts[0] = lo;
    int n = 1;
    float at_lo = u(4, lo), at_hi;
    for (int i = 0; i < 2; ++i) {
        at_hi = u(4, stops[i + 1]);
        if ((at_lo < 0.0) != (at_hi < 0.0)) cuts[n++] = root(4, stops[i], stops[i + 1], at_lo, at_hi, fine);
        cuts[n++] = stops[i + 1];
        at_lo = at_hi;
    }
    float next[6];
    next[0] = lo;
    int m = 1;
    at_lo = u(3, lo);
    for (int i = 0; i < n - 1; ++i) {
        at_hi = u(3, cuts[i + 1]);
        if ((at_lo < 0.0) != (at_hi < 0.0)) next[m++] = root(3, cuts[i], cuts[i + 1], at_lo, at_hi, fine);
        at_lo = at_hi;
    }
    next[m] = hi;
    // f' goes to - at a root of g that begins a part, to + at one that ends it. Where it does not, that is the half's own end,
    // or the part is so narrow, or ends in so fine a point, that rounding decides: then the sign is that of beside it.
    l = 3e38;
    t = hi;
    at_lo = u(2, lo);
    if (at_lo >= 0.0) {
        t = lo;
        l = f_at(lo);
        at_lo = u(2, mix(lo, hi, 1e-3));
    }
    for (int i = 0; i < m; ++i) {
        at_hi = u(2, next[i + 1]);
        if (i + 1 == m && at_hi < 0.0) {
            if (f_at(hi) < l) {
                t = hi;
                l = f_at(hi);
            }
            at_hi = u(2, mix(hi, lo, 1e-3));
        }
        if (at_lo < 0.0 && at_hi >= 0.0) {
            float found = root(2, next[i], next[i + 1], at_lo, at_hi, fine), value = f_at(found);
            if (value < l) {
                l = value;
                t = found;
            }
        }
        at_lo = at_hi;
    }
}

// Roots of g in 0..1 with both ends around them; returns how many pieces they make.
int pieces_of_g(float fine, out float cuts[6]) {
    float a = 6.0 * product(q_c, q_c), b = 6.0 * product(q_b, q_c), c = product(q_b, q_b) + 2.0 * product(q_a, q_c);
    float bends[4];
    int n = 1;
    bends[0] = 0.0;
    float under = b * b - 4.0 * a * c;
    if (under > 0.0) {
        float w = -0.5 * (b + (b < 0.0 ? -1.0 : 1.0) * sqrt(under));
        float t0 = w / a, t1 = c / w;                     // infinite or NaN where there is none: in no range
        if (t0 > t1) {
            float swap = t0;
            t0 = t1;
            t1 = swap;
        }
        if (t0 > 0.0 && t0 < 1.0) bends[n++] = t0;
        if (t1 > 0.0 && t1 < 1.0 && t1 != t0) bends[n++] = t1;
    }
    bends[n] = 1.0;
    float tops[5];
    int m = 1;
    tops[0] = 0.0;
    float at_lo = u(1, 0.0);
    for (int i = 0; i < n; ++i) {
        float at_hi = u(1, bends[i + 1]);
        if ((at_lo < 0.0) != (at_hi < 0.0)) tops[m++] = root(1, bends[i], bends[i + 1], at_lo, at_hi, fine);
        at_lo = at_hi;
    }
    tops[m] = 1.0;
    int k = 1;
    cuts[0] = 0.0;
    at_lo = u(0, 0.0);
    for (int i = 0; i < m; ++i) {
        float at_hi = u(0, tops[i + 1]);
        if ((at_lo < 0.0) != (at_hi < 0.0)) cuts[k++] = root(0, tops[i], tops[i + 1], at_lo, at_hi, fine);
        at_lo = at_hi;
    }
    cuts[k] = 1.0;
    return k;
}

void turn_round() {
    h_a = -h_a;
    h_b = -h_b;
    h_c = -h_c;
}

// What a part shows: from `first` on.
void part_seen(float l, float t, float lo, float hi, float first, bool cut, float fine, bvec2 joined, inout Found best) {
    bool hidden = t <= 0.0 && others(0.0, joined.x) || t >= 1.0 && others(1.0, joined.y);
    if (l >= first && !hidden) {
        if (l < best.l) best = Found(l, t, ENTRY);
        return;
    }
#if FEATURE_CLIP_PLANES || FEATURE_CLIP_REGION || FEATURE_TUBE_HOLLOW
    if (first >= best.l) return;
#if !FEATURE_TUBE_HOLLOW
    if (!cut || l >= first) return;
#endif
    float far, at;
    turn_round();
    least_of_part(lo, hi, fine, far, at);
    bool beyond = at <= 0.0 && others(0.0, joined.x) || at >= 1.0 && others(1.0, joined.y);
    turn_round();
    far = -far;
    if (far <= first) return;
    if (cut && l < first) best = Found(first, t, CUT);
#if FEATURE_TUBE_HOLLOW
    else if (!cut && !beyond && far < best.l) best = Found(far, at, EXIT);
#endif
#endif
}

// Looks for something nearer than `best` on the half with control points k0, k1, k2, in ray space.
void meet_half(vec4 k0, vec4 k1, vec4 k2, float first, bool cut, bvec2 joined, inout Found best) {
    vec3 q0 = k0.xyz, q1 = k1.xyz, q2 = k2.xyz;
    float g_0 = product(q0, q0), g_1 = product(q0, q1), g_2 = (product(q0, q2) + 2.0 * product(q1, q1)) / 3.0,
          g_3 = product(q1, q2), g_4 = product(q2, q2);
    float most = max(max(max(g_0, g_1), max(g_2, g_3)), g_4);
    if (most <= 0.0) return;
    float h0 = k0.w, h1 = k1.w, h2 = k2.w;
    // Nothing of this half is nearer than its control points less the largest radius.
    float widest = max(max(k0.x, k1.x), k2.x);
    if (min(min(h0, h1), h2) - widest >= best.l) return;
    take_half(k0, k1, k2);
    float fine = max(1e-3 * min(widest, 1.0), 2e-7), l, t;
#if FEATURE_TUBE_ILLINOIS || FEATURE_TUBE_ITP || FEATURE_TUBE_NEWTON
    float bend = max(max((g_2 - g_1) + (g_0 - g_1), (g_3 - g_2) + (g_1 - g_2)), (g_4 - g_3) + (g_2 - g_3));
    if (bend <= 0.0 && (h_c >= 0.0 || -3.0 * bend >= -h_c * sqrt(most))) {
        float at_0 = u(2, 0.0), at_1 = u(2, 1.0);
        if (at_0 >= 0.0) t = 0.0;
        else if (at_1 <= 0.0) t = 1.0;
        else t = root(2, 0.0, 1.0, at_0, at_1, fine);
        if (u(0, t) < 0.0) return;
        l = f_at(t);
        bool hidden = t <= 0.0 && others(0.0, joined.x) || t >= 1.0 && others(1.0, joined.y);
        if (l >= first && !hidden) {
            if (l < best.l) best = Found(l, t, ENTRY);
            return;
        }
#if !FEATURE_CLIP_PLANES && !FEATURE_CLIP_REGION && !FEATURE_TUBE_HOLLOW
        return;
#endif
    }
#endif
    float cuts[6];
    int pieces = pieces_of_g(fine, cuts);
    bool inside = u(0, 0.0) >= 0.0;          // g changes its sign from piece to piece
    for (int i = 0; i < pieces; ++i, inside = !inside) {
        if (!inside) continue;
        float lo = cuts[i], hi = cuts[i + 1];
        least_of_part(lo, hi, fine, l, t);
        part_seen(l, t, lo, hi, first, cut, fine, joined, best);
    }
}
