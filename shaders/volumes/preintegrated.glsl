// Light of steps that are integrated beforehand, between two values; where values bend, of shorter ones.
// This work is based on: Engel, Kraus and Ertl, "High-quality pre-integrated volume rendering using hardware-accelerated
// pixel shading" (2001).
//
// Symbols
//   front, back  values at a step's ends
//   slope        by how much the value changed in the step before, over the length of a whole one
//   bend         by how much it changes now, less the slope
//
// Between its ends a step's value is linear. Lines through samples lie beside a curve on the side that it bends to, everywhere, and
// errors add up. Lines nearest to it (least squares) pass its samples at a twelfth of the bend on the other side: both ends are
// moved by that of the front, and the mean over many steps is right to the fourth order, at no sample more.
//
// That is of no help at an edge between two cells, where the value turns at once: what the step's line is off by depends on where in
// it the edge is. There is one if the bend is large; then the step is taken again in parts, and so are those that follow as long
// as their last part bends. A kink D at a share x of the step shows as (1 - x) D in its own bend and as x D in the next step's, and
// its line is off by x (1 - x) D at most: what hardly shows is hardly off.
//
// Kinks may cancel in a bend. Of a step with two of them, between steps without, the value is off its line by x1 times its own bend at
// the first and by (1 - x2) times the next step's at the second, so by no more than the larger of both. A step is taken back, and
// again in parts, if the next one's bend is more than what its own was allowed to be. A third kink, or kinks of both neighbours that
// cancel too, may still hide: values at random have such in 2 pixels of 1,000.
//
// By how much values may bend depends on them: pvfiblets/volumes/steepness.py. Where even parts are not to be looked up, light is that
// of volumes/adaptive.glsl.

uniform sampler2D segments;       // of a step: premultiplied colour and opacity by the values at both ends; above, of a part
#if FEATURE_VOLUME_FINER
uniform sampler2D allowed_bends;  // by the values at a step's ends; above, of a part; negative where the table is off
uniform float all_bends;          // what nothing exceeds
uniform vec2 opaque_values;       // what is lower than the first or higher than the second is not seen
const float PARTS = float({{ parts }});
#define SHORTEST (step / PARTS)
#else
#define SHORTEST step
#endif
#if FEATURE_VOLUME_EXACT
#include "volumes/adaptive.glsl"
#endif

const float MOVED = 1.0 / 12.0, UNKNOWN = 3e38;

vec4 light_of_step(float front, float back, float row) {
    float size = float(textureSize(segments, 0).x), middle = 0.5 * (front + back);
    vec2 entry = vec2(place_of(front), place_of(back)) * (size - 1.0);
#if FEATURE_VOLUME_FINER
    entry.y += row * size;
#endif
    return middle >= value_low && middle <= value_high ? entry_at(segments, entry) : vec4(0.0);
}

#if FEATURE_VOLUME_FINER
float allowed_between(float front, float back, float row) {
    return textureLod(allowed_bends, vec2(place_of(front), 0.5 * (min(place_of(back), 0.999999) + row)), 0.0).x;
}
#endif

// Colour (premultiplied) and opacity, and where the first of it is.
bool gather(Ray ray, float step, float start, out float hit, out vec4 light) {
    float t = start, front = value_at(at(ray, t)), slope = UNKNOWN;
#if FEATURE_VOLUME_FINER
    float parts = 0.0;      // of this step that are still to come
    float slope_before = slope, allowed_before = UNKNOWN;     // of a step that may be taken back
    vec4 light_before = vec4(0.0);
#endif
    light = vec4(0.0);
    hit = -1.0;
#if FEATURE_VOLUME_EXACT
    for (;;) {
    bool off = false;       // the next stretch is not to be looked up
    while (!off && t + SHORTEST <= ray.last && light.a < opaque_from) {
#else
    while (t + SHORTEST <= ray.last && light.a < opaque_from) {
#endif
        float number, end = t + to_end_of_node(ray, t, 0.5, number);
        if (number <= 0.5 && end - t >= step) {
            t += floor((end - t) / step) * step;
            if (t + SHORTEST > ray.last) break;
            front = value_at(at(ray, t));
            slope = front - value_at(at(ray, t - step));      // as if nothing had been skipped
#if FEATURE_VOLUME_FINER
            allowed_before = UNKNOWN;
#endif
        }
#if FEATURE_VOLUME_HOMOGENEOUS
        else if (number > 1.5 && end - t >= step) {
            float mm = floor((min(end, ray.last) - t) / step) * step;
            vec4 m = medium_at(mean_of_node);
            float a = 1.0 - exp(-m.a * mm);
            if (a > 0.0 && hit < 0.0) hit = t;
            light += (1.0 - light.a) * vec4(m.rgb * a, a);
            t += mm;
            if (t + SHORTEST > ray.last || light.a >= opaque_from) break;
            front = value_at(at(ray, t));
            slope = UNKNOWN;
#if FEATURE_VOLUME_FINER
            allowed_before = UNKNOWN;
#endif
        }
#endif
        do {
#if FEATURE_VOLUME_FINER
            float share = parts > 0.0 ? 1.0 / PARTS : 1.0;
            float back = value_at(at(ray, t + share * step)), change = back - front;
            float bend = slope == UNKNOWN ? 0.0 : change - share * slope, seen = abs(bend) * (1.0 - light.a);
            float row = parts > 0.0 ? 1.0 : 0.0, allowed = allowed_between(front, back, row);
            float to_opaque = max(opaque_values.x - max(front, back), min(front, back) - opaque_values.y);
            bool visible = abs(bend) > to_opaque;
            // The step before is taken back.
            if (parts == 0.0 && abs(bend) * (1.0 - light_before.a) > allowed_before) {
                t -= step;
                light = light_before;
                front -= slope;
                slope = slope_before;
                allowed_before = UNKNOWN;
                parts = PARTS;
                continue;
            }
#if FEATURE_VOLUME_EXACT
            off = visible && (allowed < 0.0 || (parts > 0.0 && seen > allowed));
            if (off) break;
#endif
            bool bent = seen > allowed || (slope == UNKNOWN && allowed < all_bends);
            if (parts == 0.0 && visible && (bent || t + step > ray.last)) {
                parts = PARTS;
            } else {
                light_before = light;
                slope_before = slope;
                allowed_before = parts > 0.0 ? UNKNOWN : allowed < 0.0 ? to_opaque : allowed;
                vec4 part = light_of_step(front - MOVED * bend, back - MOVED * bend, row);
                if (part.a > 0.0 && hit < 0.0) hit = t;
                light += (1.0 - light.a) * shaded(ray, t + 0.5 * share * step, part);
                t += share * step;
                front = back;
                slope = change / share;
                parts = parts == 1.0 && PARTS * PARTS * seen > allowed ? PARTS : max(parts - 1.0, 0.0);
            }
        } while ((parts > 0.0 || t < end) && t + SHORTEST <= ray.last && light.a < opaque_from);
#else
            float back = value_at(at(ray, t + step)), change = back - front;
            float bend = slope == UNKNOWN ? 0.0 : change - slope;
            vec4 part = light_of_step(front - MOVED * bend, back - MOVED * bend, 0.0);
            if (part.a > 0.0 && hit < 0.0) hit = t;
            light += (1.0 - light.a) * shaded(ray, t + 0.5 * step, part);
            t += step;
            front = back;
            slope = change;
        } while (t < end && t + SHORTEST <= ray.last && light.a < opaque_from);
#endif
    }
#if FEATURE_VOLUME_EXACT
    if (!(t < ray.last && light.a < opaque_from)) break;
    // What is off, or left in the end. In a loop of its own: software OpenGL works out what branches leave out, at every step.
    float mm = min(parts > 0.0 || !off ? step / PARTS : step, ray.last - t);
    Look here = look_at(u_of(front));
    vec4 part = adaptive_stretch(ray, t, mm, step, 1.0 - light.a, here);
    if (part.a > 0.0 && hit < 0.0) hit = t;
    light += (1.0 - light.a) * shaded(ray, t + 0.5 * mm, part);
    allowed_before = UNKNOWN;
    t += mm;
    float back = value_at(at(ray, t));
    slope = (back - front) * (step / mm);
    front = back;
    parts = parts == 1.0 ? PARTS : max(parts - 1.0, 0.0);      // it bent in the last of them
    }
#else
    if (t < ray.last && light.a < opaque_from) {
        // What is left is shorter. A power is dear, and software OpenGL works out what branches leave out: not in the loop.
        vec4 part = light_of_step(value_at(at(ray, t)), value_at(at(ray, ray.last)), 0.0);
        if (part.a > 0.0) {
            if (hit < 0.0) hit = t;
            part = shaded(ray, 0.5 * (t + ray.last), part);
            light += (1.0 - light.a) * part * ((1.0 - pow(1.0 - min(part.a, 0.9999999), (ray.last - t) / step)) / part.a);
        }
    }
#endif
    if (light.a >= opaque_from) light /= light.a;      // what is behind would not be seen
    return light.a > 0.0;
}
