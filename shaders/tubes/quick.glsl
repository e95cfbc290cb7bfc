// Where a ray meets one half of a segment, in one loop for all of it: what tubes/solver.glsl finds by the chain of
// derivatives, where nothing cuts the ray short.
//
// Symbols: see tubes/functions.glsl. F1, on with -G1 where g < 0, goes from - to + at each minimum of f, and where g has
// a maximum below 0, which is a miss.
//
// Algorithm
//   1. g has the five Bezier coefficients <q_i, q_j>: with none positive the ray misses.
//   2. Where g is concave, and f convex for certain, F1 has one root in 0..1: one piece. Else there are stops at the roots of
//      g'' and at the minima of g, which lie where g'' > 0: between two of them g > 0 in one part at most. Three more stops
//      between each find minima of f that have a maximum between them. At a node without slopes f' = 0, and a minimum
//      may be close beside: two stops lie MARGIN away from the ends.
//   3. From stop to stop: where F1 goes from - to +, the bracket is narrowed to the root. The ends count where f rises
//      from 0, or falls to 1. The nearest of all is kept.
// Stops and roots take turns in one loop with one evaluation, whatever its lanes are at: processors that run many fragments at
// once run all of a shader for all of them. A minimum is missed only where f has two and a maximum between two stops, and
// then for the other one; the report measures how often that is, and how far off.

// Needs tubes/functions.glsl before it.

const float MARGIN = 0.125;

// Whether a minimum at an end where another segment goes on is that one's: its slope says so clearly.
bool others(float sloped, float g1, float size) {
    return abs(sloped - g1) > 0.01 * (abs(sloped) + abs(g1)) + 1e-5 * size;
}

// Where g has its minima in two ranges, in each of which it is convex: narrowed to a 64th by halving; an end where it has none.
// F1 is + before a minimum below 0 and - after it, and so says what parts there are on both sides.
void bottoms(inout vec2 low, inout vec2 high, bool easy) {
    for (int i = 0; i < 6 && !easy; ++i) {
        vec2 t = 0.5 * (low + high);
        bool falls_x = product(q_a + t.x * (q_b + t.x * q_c), q_b + 2.0 * t.x * q_c) < 0.0;
        bool falls_y = product(q_a + t.y * (q_b + t.y * q_c), q_b + 2.0 * t.y * q_c) < 0.0;
        low = vec2(falls_x ? t.x : low.x, falls_y ? t.y : low.y);
        high = vec2(falls_x ? high.x : t.x, falls_y ? high.y : t.y);
    }
}

void meet_half(vec4 k0, vec4 k1, vec4 k2, float first, bool cut, bvec2 joined, inout Found best) {
    vec3 q0 = k0.xyz, q1 = k1.xyz, q2 = k2.xyz;
    float g_0 = product(q0, q0), g_1 = product(q0, q1), g_2 = (product(q0, q2) + 2.0 * product(q1, q1)) / 3.0,
          g_3 = product(q1, q2), g_4 = product(q2, q2);
    float most = max(max(max(g_0, g_1), max(g_2, g_3)), g_4);
    float h0 = k0.w, h1 = k1.w, h2 = k2.w, widest = max(max(k0.x, k1.x), k2.x);
    if (most <= 0.0 || min(min(h0, h1), h2) - widest >= best.l) return;
    take_half(k0, k1, k2);
    float fine = max(1e-3 * min(widest, 1.0), 2e-7);
    float bend_0 = (g_2 - g_1) + (g_0 - g_1), bend_1 = (g_3 - g_2) + (g_1 - g_2), bend_2 = (g_4 - g_3) + (g_2 - g_3);
    float bend = max(max(bend_0, bend_1), bend_2);
    bool easy = bend <= 0.0 && (h_c >= 0.0 || -3.0 * bend >= -h_c * sqrt(most));
    // Roots of g'': of bend_0 (1-t)^2 + 2 bend_1 t (1-t) + bend_2 t^2.
    float a = (bend_0 - bend_1) + (bend_2 - bend_1), b = bend_1 - bend_0, under = b * b - a * bend_0;
    float w = -(b + (b < 0.0 ? -1.0 : 1.0) * sqrt(max(under, 0.0)));
    float r_0 = w / a, r_1 = bend_0 / w, t_0 = min(r_0, r_1), t_1 = max(r_0, r_1);
    bool bends = under > 0.0;
    t_0 = bends && t_0 > 0.0 ? min(t_0, 1.0) : 0.0;
    t_1 = bends && t_1 < 1.0 ? max(t_1, t_0) : 1.0;
    // Where g is convex: on both sides of them, between them, or in all of 0..1.
    bool outside = bends && a > 0.0;
    vec2 from = outside ? vec2(0.0, t_1) : vec2(t_0, 1.0), to = outside ? vec2(t_0, 1.0) : vec2(t_1, 1.0);
    bottoms(from, to, easy);
    vec4 stops = outside ? vec4(from.x, to.x, t_0, t_1) : vec4(t_0, from.x, to.x, t_1);

    bool narrowing = false, at_start = true;
    int stop = easy ? 27 : 0;
    float lo = 0.0, u_lo = 1.0, hi = 0.0, u_hi = 1.0, top = 0.0, u_top = 0.0, t = 0.0;
#if FEATURE_TUBE_ITP
    float slack = 0.0, kappa = 0.0;
#endif
    int left = tube_search_steps;
    for (int i = 0; i < 7 * tube_search_steps + 32; ++i) {
        vec3 q = q_a + t * (q_b + t * q_c), dq = q_b + 2.0 * t * q_c;
        float g = product(q, q), g1 = product(q, dq), s = sqrt(max(g, 0.0)), sloped = s * (h_b + 2.0 * t * h_c), u_t = sloped - g1;
        bool done = false, minimum = false;
        if (narrowing) {
#if FEATURE_TUBE_ILLINOIS
            if ((u_t < 0.0) != (u_hi < 0.0)) {
                minimum = abs(t - hi) < fine;      // the root lies between the last two; a short step alone says nothing
                lo = hi;
                u_lo = u_hi;
            } else {
                u_lo *= 0.5;
            }
            hi = t;
            u_hi = u_t;
#elif FEATURE_TUBE_ITP
            if (u_t < 0.0) {
                lo = t;
                u_lo = u_t;
            } else {
                hi = t;
                u_hi = u_t;
            }
            slack *= 0.5;
            minimum = hi - lo < fine;
#else
            if (u_t < 0.0) lo = t;
            else hi = t;
            minimum = hi - lo < 2.5 * fine;
#endif
            --left;
            minimum = minimum || u_t == 0.0 || left <= 0;
            done = minimum;
        } else {
            if (at_start) {
                minimum = u_t >= 0.0;
                at_start = false;
                lo = t;
                u_lo = u_t;
            } else if (u_lo < 0.0 && u_t >= 0.0) {
                narrowing = true;
                top = hi = t;
                u_top = u_hi = u_t;
                left = tube_search_steps;
#if FEATURE_TUBE_ITP
                slack = 0.5 * fine * exp2(ceil(log2(max((hi - lo) / fine, 1.0))));
                kappa = 0.2 / (hi - lo);
#endif
            } else {
                minimum = t >= 1.0 && u_t < 0.0;
                lo = t;
                u_lo = u_t;
                stop = max(stop + 1, t >= 1.0 - MARGIN ? 24 : 0);
            }
        }
        if (minimum && g >= 0.0) {
            float l = h_a + t * (h_b + t * h_c) - s;
            bool hidden = (t <= 0.0 && joined.x || t >= 1.0 && joined.y) && others(sloped, g1, length(q) * length(dq));
            if (l >= first && l < best.l && !hidden) best = Found(l, t, ENTRY);
        }
        if (done) {
            narrowing = false;
            lo = top;
            u_lo = u_top;
            ++stop;
        }
        if (!narrowing && stop > 27) break;
        if (narrowing) {
#if FEATURE_TUBE_ILLINOIS
            t = hi - u_hi * (hi - lo) / (u_hi - u_lo);
            if (u_hi == 0.0) t = mix(hi, lo, 1e-3);      // hi may be a maximum: the sign beside it decides
            float low = min(lo, hi), high = max(lo, hi);
            if (!(t >= low && t <= high)) t = 0.5 * (lo + hi);
#elif FEATURE_TUBE_ITP
            float half_way = 0.5 * (lo + hi), secant = (u_hi * lo - u_lo * hi) / (u_hi - u_lo);
            float side = half_way < secant ? -1.0 : 1.0, shift = kappa * (hi - lo) * (hi - lo);
            t = shift <= abs(half_way - secant) ? secant + side * shift : half_way;
            float room = slack - 0.5 * (hi - lo);
            if (!(abs(t - half_way) <= room)) t = half_way - side * max(room, 0.0);
#else
            float g2 = product(dq, dq) + 2.0 * product(q, q_c), f2 = 2.0 * g * s * h_c + g1 * g1 - g * g2;
            float step = g > 0.0 ? u_t * g / f2 : g1 / g2;
            // Almost there: a little too far, so that the root is between the last two.
            float next = t - step - (abs(step) < fine ? (u_t < 0.0 ? -fine : fine) : 0.0);
            t = next > lo && next < hi ? next : 0.5 * (lo + hi);
#endif
        } else {
            int k = stop >> 2, part = stop & 3;
            t = k < 2 ? (k == 0 ? stops.x : stops.y) : k == 2 ? stops.z : k == 3 ? stops.w : 1.0;
            if (outside && k > 3 && k < 6) t = k == 4 ? from.y : to.y;
            if (k < 6) t = clamp(t, max(MARGIN, lo), 1.0 - MARGIN);
            if (part < 3) t = lo + (t - lo) / float(4 - part);
        }
    }
}
