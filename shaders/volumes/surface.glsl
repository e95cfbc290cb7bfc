// The first surface on a ray: by cells where the field between voxels is linear, else, or where that is asked for, by steps.
// Paper: Lesar 2015, section III.B: a linear search for a change of sign, then regula falsi (equation 3) or Newton (equation 4).
//
// Symbols
//   Psi          value minus that of the surface
//
// Regula falsi halves the weight of an end that stays twice (Illinois): it then converges where the field bends. A step of Newton
// that leaves the bracket is replaced by a bisection.

#if FEATURE_VOLUME_CLOSED
#include "volumes/closed.glsl"
#endif

#if FEATURE_VOLUME_CELLS
#include "volumes/surface_cells.glsl"

#if !FEATURE_VOLUME_LAYERS
float shown_at, shown_value = 3e38;

bool show_stretch(Ray ray, Stretch found) {
    float best = 2.0;
    for (int k = 0; k < isovalue_count; ++k) {
        float place = crossings(found.b - isovalues[k], (found.sides >> k & 1u) != 0u).x;
        if (place < best) {
            best = place;
            shown_value = isovalues[k];
        }
    }
    shown_at = place_of(found, best);
    return best <= 1.0;
}

bool find_surface(Ray ray, float step, float start, out float hit, out float value) {
    walk_surfaces(ray, start);
    hit = shown_at;
    value = shown_value;
    return value < 3e38;
}
#endif
#else
float refined(Ray ray, float value, float a, float psi_a, float b, float psi_b) {
#if FEATURE_VOLUME_UNREFINED
    return b;
#elif FEATURE_VOLUME_NEAREST
    // The field jumps, and what is behind the jump is the voxel that the ray enters: nothing is faster than halving.
    for (int k = 0; k < refinement_steps; ++k) {
        float t = 0.5 * (a + b);
        if ((value_at(at(ray, t)) < value) == (psi_a < 0.0)) a = t;
        else b = t;
    }
    return b;
#elif FEATURE_VOLUME_NEWTON
    float t = a + (b - a) * psi_a / (psi_a - psi_b);
    for (int k = 0; k < refinement_steps; ++k) {
        vec3 p = at(ray, t);
        float psi = value_at(p) - value;
        if ((psi > 0.0) == (psi_a > 0.0)) a = t;
        else b = t;
        vec3 g = 0.5 * vec3(value_at(p + vec3(1.0, 0.0, 0.0)) - value_at(p - vec3(1.0, 0.0, 0.0)),
                            value_at(p + vec3(0.0, 1.0, 0.0)) - value_at(p - vec3(0.0, 1.0, 0.0)),
                            value_at(p + vec3(0.0, 0.0, 1.0)) - value_at(p - vec3(0.0, 0.0, 1.0)));
        float rise = dot(g, ray.d), next = t - psi / (abs(rise) > 1e-30 ? rise : 1e-30);
        t = next > a && next < b ? next : 0.5 * (a + b);
    }
    return t;
#else
    float t = b;
    int kept = 0;
    for (int k = 0; k < refinement_steps; ++k) {
        t = b - psi_b * (b - a) / (psi_b - psi_a);
        float psi = value_at(at(ray, t)) - value;
        if (psi == 0.0) break;
        if ((psi > 0.0) == (psi_a > 0.0)) {
            a = t;
            psi_a = psi;
            if (kept == 1) psi_b *= 0.5;
            kept = 1;
        } else {
            b = t;
            psi_b = psi;
            if (kept == -1) psi_a *= 0.5;
            kept = -1;
        }
    }
    return t;
#endif
}

// Says whether there is one, where, and which. Nothing before the first sample is looked at: a surface is where values change sides.
bool find_surface(Ray ray, float step, float start, out float hit, out float value) {
    float t = start, before = value_along(at(ray, t));
    value = 0.0;
    hit = 0.0;
    while (t < ray.last) {
        float number, end = t + to_end_of_node(ray, t, 0.5, number);
        if (number <= 0.5 && end - t >= step) {
            t += floor((end - t) / step) * step;
            if (t >= ray.last) return false;
            before = value_along(at(ray, t));
        }
        do {
            float next = min(t + step, ray.last), after = value_along(at(ray, next)), best = 2.0;
            for (int k = 0; k < isovalue_count; ++k) {
                float mu = isovalues[k], a = before - mu, b = after - mu;
                float share = (a < 0.0) != (b < 0.0) ? a / (a - b) : 2.0;
                if (share < best) {
                    best = share;
                    value = mu;
                }
            }
            if (best <= 1.0) {
#if FEATURE_VOLUME_FETCHED
                before = value_at(at(ray, t));
                after = value_at(at(ray, next));
                if ((before < value) == (after < value)) {      // by a little beyond one of the ends
                    hit = abs(before - value) < abs(after - value) ? t : next;
                    return true;
                }
#endif
                hit = refined(ray, value, t, before - value, next, after - value);
                return true;
            }
            before = after;
            t = next;
        } while (t < end && t < ray.last);
    }
    return false;
}
#endif
