// The per-point value of the G-buffer, if the style asks for one; without, nothing of this file is left but a zero.
//
//   stored       one or two bytes per point; code c means chunk_values.x + chunk_values.y * c, the largest means NaN
//   arc length   mm from the streamline's first point; `starts` holds it for every fiblet's anchor
//   curvature    turn() at every point; the ends of a streamline take their neighbour's. `starts` holds it for every
//                anchor, because the segment before an anchor is another fiblet's
//
// pvfiblets/engine/values.py makes the buffers. Between points a value is interpolated; next to NaN the nearer counts.

#if FEATURE_VALUES_STORED
layout(std430, binding = 7) readonly buffer Values { uint values[]; };

uint values_first;
uint values_last;  // index within the fiblet of the last point that a segment of it reaches

uint value_code(uint segment) {
    uint bits = chunk_bases.y, bit = (values_first + min(segment, values_last)) * bits;
    return bitfieldExtract(values[bit >> 5], int(bit & 31u), int(bits));
}

void begin_values(uint f) {
    values_first = first_point_of(f);
    values_last = fiblet_last(decoding_words(f)) + (fiblet_end(anchors[f]) != 0u ? 0u : 1u);
}

void start_values(uint segment, vec3 delta) {}

float value_at(uint segment, float t) {
    uint a = value_code(segment), b = value_code(segment + 1u), invalid = (1u << chunk_bases.y) - 1u;
    if (a == invalid || b == invalid) {
        a = b = t < 0.5 ? a : b;
        if (a == invalid) return uintBitsToFloat(0x7FC00000u);
    }
    return chunk_values.x + chunk_values.y * mix(float(a), float(b), t);
}

#elif FEATURE_VALUES_ARC_LENGTH
layout(std430, binding = 7) readonly buffer Starts { float starts[]; };

float arc_from;
float arc_to;

void begin_values(uint f) { arc_from = arc_to = starts[f]; }

void start_values(uint segment, vec3 delta) {
    arc_from = arc_to;
    arc_to += length(delta);
}

float value_at(uint segment, float t) { return mix(arc_from, arc_to, t); }

#elif FEATURE_VALUES_CURVATURE
#include "compute/turn.glsl"

layout(std430, binding = 7) readonly buffer Starts { float starts[]; };

float curvatures[FIBLET_MAX_POINTS + 1u];

// Curvature at a point needs the segment after it: the fiblet is decoded once before it is drawn.
void begin_values(uint f) {
    bool end = fiblet_end(anchors[f]) != 0u;
    walk_begin(f);
    curvatures[0] = starts[f];
    curvatures[walk.last + 1u] = end ? 0.0 : starts[f + 1u];
    vec3 before = vec3(0.0);
    for (uint i = 1u; i <= walk.last; ++i) {
        walk_next(i);
        if (i > 1u) curvatures[i - 1u] = turn(before, walk_delta);
        before = walk_delta;
    }
    if (walk.last > 0u) {
        if (!end) curvatures[walk.last] = turn(before, anchor_local(f + 1u) - walk_point);
        else curvatures[walk.last] = curvatures[walk.last - 1u];
    }
}

void start_values(uint segment, vec3 delta) {}

float value_at(uint segment, float t) { return mix(curvatures[segment], curvatures[segment + 1u], t); }

#else
void begin_values(uint f) {}
void start_values(uint segment, vec3 delta) {}
float value_at(uint segment, float t) { return 0.0; }
#endif
