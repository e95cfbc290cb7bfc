// The per-point value of the G-buffer, if the style asks for one; without, nothing of this file is left but a zero.
//
//   stored       one or two bytes per point, code c means the c-th word of the buffer, before the codes; or a float32
//   colours      stored as a word per point, RGBA; the value is a colour as a number (fiblets/attributes/packed_colour.glsl)
//   arc length   mm from the streamline's first point; `starts` holds it for every fiblet's anchor
//   volume       fiblets/data/volume.glsl at every point, looked up for the pixels that are written
//
// `step` and `rest` are t in steps from point to point, where a segment stands for a whole fiblet (far views).
// value_of_point(i) serves stages that hand values on with points: that of the point which start_values() came to last, but 0
// where fragments look it up. pvfiblets/engine/fiblets/data/point_values.py makes the buffers. Between points a value is interpolated; next to NaN the nearer counts.

#include "fiblets/data/values.glsl"

#if FEATURE_VALUES_STORED
#if FEATURE_VALUES_COLOUR
#include "fiblets/attributes/packed_colour.glsl"
#endif
uint values_first;
uint values_last;  // index within the fiblet of the last point that a segment of it reaches

#if FEATURE_VALUES_COLOUR
vec4 point_colour(uint segment) {
    uint word = value_word(values_first + min(segment, values_last));
    return vec4(word & 255u, (word >> 8u) & 255u, (word >> 16u) & 255u, word >> 24u) / 255.0;
}

float value_along(uint segment, float t, uint step, float rest) {
    return packed_colour(mix(point_colour(segment + step), point_colour(segment + step + 1u), rest), value_bits == 24u);
}
#else
// Two codes of 16 bits or four of 8 to a word. A chunk's points are fewer than 2^32, their bits are not.
uint value_code(uint segment) {
    uint bits = value_bits, point = values_first + min(segment, values_last);
    uint shift = bits == 8u ? 2u : bits == 16u ? 1u : 0u, within = point & ((1u << shift) - 1u);
    return bitfieldExtract(value_word(value_table + (point >> shift)), int(within * bits), int(bits));
}

uint value_of_code(uint code) { return value_bits == 32u ? code : value_word(code); }

bool is_none(uint value) { return (value & 0x7FFFFFFFu) > 0x7F800000u; }

float value_along(uint segment, float t, uint step, float rest) {
    segment += step;
    t = rest;
    uint a = value_of_code(value_code(segment)), b = value_of_code(value_code(segment + 1u));
    if (is_none(a) || is_none(b)) return uintBitsToFloat(t < 0.5 ? a : b);
    return mix(uintBitsToFloat(a), uintBitsToFloat(b), t);
}
#endif

void begin_values(uint f) {
    values_first = first_point_of(f);
    values_last = fiblet_last(decoding_words(f)) + (ends(f) ? 0u : 1u);
}

void start_values(uint segment, vec3 to, vec3 delta, float steps) {}

float value_of_point(uint i) { return 0.0; }

#elif FEATURE_VALUES_ARC_LENGTH
// Length of a fiblet of constant step; 0 for others.
float whole_length(uvec3 words) {
    return fiblet_kind(words) == KIND_DIRECTION ? float(fiblet_last(words)) * step_length(words) : 0.0;
}

float arc_from;
float arc_to;

uint arc_fiblet;

void begin_values(uint f) {
    arc_fiblet = f;
    arc_from = arc_to = start_value(f);
}

// A whole fiblet drawn as one segment is longer than that: its length is that of its steps.
void start_values(uint segment, vec3 to, vec3 delta, float steps) {
    arc_from = arc_to;
#if FEATURE_SUBSAMPLES
    if (!polyline.whole) {
        arc_to += polyline.run;
        return;
    }
#endif
    if (steps <= 1.0) arc_to += length(delta);
    else if (!ends(arc_fiblet)) arc_to = start_value(arc_fiblet + 1u);
    else arc_to += max(length(delta), whole_length(decoding_words(arc_fiblet)));
}

float value_along(uint segment, float t, uint step, float rest) { return mix(arc_from, arc_to, t); }

float value_of_point(uint i) { return arc_to; }

vec2 values_at_ends(uint segment) { return vec2(arc_from, arc_to); }

#elif FEATURE_VALUES_VOLUME
#include "fiblets/data/volume.glsl"
#include "culling/bounds.glsl"

vec3 volume_from;
vec3 volume_to;
float volume_steps;
vec2 volume_values_at;   // values at both, where they are
bvec2 volume_known;

void begin_values(uint f) {
    volume_from = volume_to = anchor_local(f);
    volume_known = bvec2(false);
}

float value_of_point(uint i) {
    if (!volume_known.y) volume_values_at.y = volume_at(volume_to);
    volume_known.y = true;
    return volume_values_at.y;
}

void start_values(uint segment, vec3 to, vec3 delta, float steps) {
    volume_from = volume_to;
    volume_to = to;
    volume_steps = steps;
    volume_values_at.x = volume_values_at.y;
    volume_known = bvec2(volume_known.y, false);
}

float value_along(uint segment, float t, uint step, float rest) {
    if (volume_steps > 1.0) return volume_between(volume_from, volume_to, volume_steps, step, rest);
    if (!volume_known.x) volume_values_at.x = volume_at(volume_from);
    volume_known.x = true;
    return value_between(volume_values_at.x, value_of_point(segment + 1u), rest);
}

// Of a whole fiblet drawn as one segment, where fragments look it up.
float value_along_capsule(uint f, float steps, uint step, float rest) {
    Capsule capsule = capsule_of(f);
    return volume_between(capsule.a, capsule.b, steps, step, rest);
}

#else
void begin_values(uint f) {}
void start_values(uint segment, vec3 to, vec3 delta, float steps) {}
float value_along(uint segment, float t, uint step, float rest) { return 0.0; }
float value_of_point(uint i) { return 0.0; }
#endif
