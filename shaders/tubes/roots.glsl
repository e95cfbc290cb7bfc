// Roots in a bracket: the four ways to find them. Paper: Russig et al. 2020, section 3.2, "Root finding".
//
// Symbols
//   u            the function (tubes/functions.glsl), by its order; it changes its sign between lo and hi
//   n            steps at most: tube_search_steps
//   fine         t that is good enough
//
// bisection    the paper's: n steps, each halves the bracket
// illinois     regula falsi; an end that stays twice counts half, so that none stays for ever
// itp          interpolate, truncate, project (Oliveira and Takahashi 2020): as fast as the secant, no slower than bisection
// newton       steps by the next derivative, which tubes/functions.glsl has anyway; by bisection where they leave the bracket

#if FEATURE_TUBE_ILLINOIS
float root(int order, float lo, float hi, float u_lo, float u_hi, float fine) {
    float a = lo, b = hi, u_a = u_lo, u_b = u_hi;
    for (int i = 0; i < tube_search_steps; ++i) {
        float t = b - u_b * (b - a) / (u_b - u_a);
        if (!(t >= lo && t <= hi)) t = 0.5 * (a + b);
        float u_t = u(order, t), step = abs(t - b);
        bool crossed = (u_t < 0.0) != (u_b < 0.0);
        if (crossed) {
            a = b;
            u_a = u_b;
        } else {
            u_a *= 0.5;
        }
        b = t;
        u_b = u_t;
        if (u_t == 0.0 || crossed && step < fine) break;      // a short step alone says nothing
    }
    return b;
}
#elif FEATURE_TUBE_ITP
float root(int order, float lo, float hi, float u_lo, float u_hi, float fine) {
    float a = lo, b = hi, u_a = u_lo, u_b = u_hi;
    float steps = ceil(log2(max((hi - lo) / fine, 1.0)));     // what bisection would take
    float most = 0.5 * fine * exp2(steps), kappa = 0.2 / (hi - lo);
    for (int i = 0; i < tube_search_steps && b - a > fine; ++i) {
        float half_way = 0.5 * (a + b), secant = (u_b * a - u_a * b) / (u_b - u_a);
        float side = half_way < secant ? -1.0 : 1.0, cut = kappa * (b - a) * (b - a);
        float t = cut <= abs(half_way - secant) ? secant + side * cut : half_way;
        float slack = most - 0.5 * (b - a);
        if (!(abs(t - half_way) <= slack)) t = half_way - side * max(slack, 0.0);
        float u_t = u(order, t);
        if (u_t == 0.0) return t;
        if ((u_t < 0.0) == (u_a < 0.0)) {
            a = t;
            u_a = u_t;
        } else {
            b = t;
            u_b = u_t;
        }
        most *= 0.5;
    }
    float t = b - u_b * (b - a) / (u_b - u_a);                // the secant once more costs nothing
    return t >= a && t <= b ? t : 0.5 * (a + b);
}
#elif FEATURE_TUBE_NEWTON
float root(int order, float lo, float hi, float u_lo, float u_hi, float fine) {
    float t = lo - u_lo * (hi - lo) / (u_hi - u_lo);
    if (!(t >= lo && t <= hi)) t = 0.5 * (lo + hi);
    for (int i = 0; i < tube_search_steps; ++i) {
        float step;
        float u_t = u_with_step(order, t, step);
        if ((u_t < 0.0) == (u_lo < 0.0)) lo = t;
        else hi = t;
        if (u_t == 0.0) break;
        if (hi - lo < 2.5 * fine) {
            float last = t - step;                            // costs nothing, and takes back what went too far
            return last >= lo && last <= hi ? last : t;
        }
        // Almost there: a little too far, so that the root is between the last two.
        float next = t - step - (abs(step) < fine ? ((u_t < 0.0) == (u_lo < 0.0) ? -fine : fine) : 0.0);
        t = next > lo && next < hi ? next : 0.5 * (lo + hi);
    }
    return t;
}
#else
float root(int order, float lo, float hi, float u_lo, float u_hi, float fine) {
    for (int i = 0; i < tube_search_steps; ++i) {
        float t = 0.5 * (lo + hi);
        if ((u(order, t) < 0.0) == (u_lo < 0.0)) lo = t;
        else hi = t;
    }
    return 0.5 * (lo + hi);
}
#endif
