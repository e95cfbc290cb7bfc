// Light through a medium that emits and absorbs.
// Paper: Lesar 2015, section III.E, equations (6) to (8).
//
// Symbols
//   kappa        extinction per mm; c colour; g = kappa c emission
//   T            what is left of the light from behind
//   dI/ds = T kappa c,  dT/ds = -kappa T
//
// Nodes whose values hardly differ are taken as their mean, exactly (equation 8).
//
// colours holds (c, kappa) by value; segments (premultiplied colour, opacity) of a whole step between two values, between which the
// value is linear: integrated exactly beforehand.

uniform sampler2D colours;
#include "volumes/shading.glsl"

// Of a table, between its entries, which are counted from 0: by the hardware, unless it is too coarse. Whole numbers give an entry
// itself and nothing of its neighbours, on all cards: where the table is clear there is no light, as the octree has it.
vec4 entry_at(sampler2D table, vec2 entry) {
#if FEATURE_VOLUME_FETCHED
    ivec2 last = textureSize(table, 0) - 1;
    vec2 p = clamp(entry, vec2(0.0), vec2(last));
    ivec2 a = ivec2(p), b = min(a + 1, last);
    vec2 x = p - vec2(a);
    return mix(mix(texelFetch(table, a, 0), texelFetch(table, ivec2(b.x, a.y), 0), x.x),
               mix(texelFetch(table, ivec2(a.x, b.y), 0), texelFetch(table, b, 0), x.x), x.y);
#else
    return textureLod(table, (entry + 0.5) / vec2(textureSize(table, 0)), 0.0);
#endif
}

float place_of(float value) { return clamp((value - transfer_low) / max(transfer_high - transfer_low, 1e-30), 0.0, 1.0); }

vec4 medium_at(float value) {
    if (!(value >= value_low && value <= value_high)) return vec4(0.0);
    return entry_at(colours, vec2(place_of(value) * float(textureSize(colours, 0).x - 1), 0.0));
}

#if FEATURE_VOLUME_PREINTEGRATED
#include "volumes/preintegrated.glsl"
#else
#define WHOLE(mm) (floor((mm) / step) * step)
float before_at(Ray ray, float t) {
#if FEATURE_VOLUME_SIMPSON || FEATURE_VOLUME_ROMBERG || FEATURE_VOLUME_RK4
    return value_at(at(ray, t));
#else
    return 0.0;
#endif
}

// Premultiplied colour and opacity of a stretch of some mm.
vec4 stretch(Ray ray, float t, float mm, float step, inout float before) {
#if FEATURE_VOLUME_RIEMANN
    vec4 m = medium_at(value_at(at(ray, t + 0.5 * mm)));
    float a = min(m.a * mm, 1.0);
    return vec4(m.rgb * a, a);
#elif FEATURE_VOLUME_SIMPSON
    vec4 m0 = medium_at(before), m1 = medium_at(value_at(at(ray, t + 0.5 * mm)));
    float after = value_at(at(ray, t + mm));
    vec4 m2 = medium_at(after);
    before = after;
    float kappa = (m0.a + 4.0 * m1.a + m2.a) / 6.0, a = 1.0 - exp(-kappa * mm);
    vec3 emission = (m0.rgb * m0.a + 4.0 * m1.rgb * m1.a + m2.rgb * m2.a) / 6.0;
    return vec4(kappa > 0.0 ? emission / kappa * a : vec3(0.0), a);
#elif FEATURE_VOLUME_ROMBERG
    // The trapezoidal rule of 1, 2 and 4 intervals, extrapolated twice: weights 7, 32, 12, 32 and 7 of 90.
    vec4 sum = vec4(0.0), m = medium_at(before);
    for (int k = 0; k < 5; ++k) {
        if (k > 0) m = medium_at(before = value_at(at(ray, t + 0.25 * float(k) * mm)));
        sum += (k == 2 ? 12.0 : (k & 1) == 1 ? 32.0 : 7.0) / 90.0 * vec4(m.rgb * m.a, m.a);
    }
    float a = 1.0 - exp(-sum.a * mm);
    return vec4(sum.a > 0.0 ? sum.rgb / sum.a * a : vec3(0.0), a);
#elif FEATURE_VOLUME_RK4
    vec4 m0 = medium_at(before), m1 = medium_at(value_at(at(ray, t + 0.5 * mm)));
    float after = value_at(at(ray, t + mm));
    vec4 m2 = medium_at(after);
    before = after;
    float k1 = m0.a, t2 = 1.0 - 0.5 * mm * k1, k2 = m1.a * t2, t3 = 1.0 - 0.5 * mm * k2, k3 = m1.a * t3;
    float t4 = 1.0 - mm * k3, k4 = m2.a * t4;
    float a = mm / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    vec3 c = mm / 6.0 * (m0.rgb * k1 + m1.rgb * (2.0 * k2 + 2.0 * k3) + m2.rgb * k4);
    return clamp(vec4(c, a), 0.0, 1.0);
#else
    vec4 m = medium_at(value_at(at(ray, t + 0.5 * mm)));
    float a = 1.0 - exp(-m.a * mm);
    return vec4(m.rgb * a, a);
#endif
}

// Colour (premultiplied) and opacity, and where the first of it is.
bool gather(Ray ray, float step, float start, out float hit, out vec4 light) {
    float t = start;
    float before = before_at(ray, t);
    light = vec4(0.0);
    hit = -1.0;
    while (t < ray.last && light.a < opaque_from) {
        float number, end = t + to_end_of_node(ray, t, 0.5, number);
        if (number <= 0.5 && end - t >= step) {
            t += WHOLE(end - t);
            if (t >= ray.last) break;
            before = before_at(ray, t);
        }
#if FEATURE_VOLUME_HOMOGENEOUS
        else if (number > 1.5 && end - t >= step) {
            float mm = WHOLE(min(end, ray.last) - t);
            vec4 m = medium_at(mean_of_node);
            float a = 1.0 - exp(-m.a * mm);
            if (a > 0.0 && hit < 0.0) hit = t;
            light += (1.0 - light.a) * vec4(m.rgb * a, a);
            t += mm;
            if (t >= ray.last || light.a >= opaque_from) break;
            before = before_at(ray, t);
        }
#endif
        do {
            vec4 part = stretch(ray, t, min(step, ray.last - t), step, before);
            part = shaded(ray, t + 0.5 * min(step, ray.last - t), part);
            if (part.a > 0.0 && hit < 0.0) hit = t;
            light += (1.0 - light.a) * part;
            t += step;
        } while (t < end && t < ray.last && light.a < opaque_from);
    }
    if (light.a >= opaque_from) light /= light.a;      // what is behind would not be seen
    return light.a > 0.0;
}
#endif
