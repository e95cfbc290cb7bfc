// A segment as a rectangle, four corners an instance, between points that decode.vert has left: before, from, to, after.
//
// Clipping, joints and tangents are the engine's (fiblets/segments, fiblets/attributes/tangent.glsl). Thin lines take the pixels
// of thin_line_rule.glsl, which segment.frag chooses from the rectangle; their depth is linear in the window and comes with it.

#version 430

#include "fiblets/segments/thin_line_rule.glsl"
#include "fiblets/segments/clipped_segment.glsl"
#include "fiblets/segments/joint.glsl"
#include "fiblets/attributes/tangent.glsl"
#include "page/segment_varyings.glsl"

const int SHARE = 20, ROW_BITS = 12;

layout(location = 0) in vec3 before;
layout(location = 1) in vec3 from;
layout(location = 2) in vec3 to;
layout(location = 3) in vec3 after;

uniform highp usampler2D items;        // rgba32ui: streamline; first point; points, begin, end and share; points before
uniform int first_item;
uniform uint layer;                    // in the upper four bits of the streamline
#if FEATURE_STREAMLINE_MASK
uniform highp usampler2D kept;         // r8ui, by streamline: not 0 where it is drawn
#endif
#if FEATURE_VALUES_COLOUR
uniform highp sampler2D point_colours; // rgba8, by point

vec4 colour_of(uint point) { return texelFetch(point_colours, ivec2(int(point & 4095u), int(point >> 12u)), 0); }
#endif
#if FEATURE_VALUES_STORED
uniform highp usampler2D value_texels; // r8ui or r16ui, by point
uniform vec3 value_code;               // value of code 0, value per code, the code of NaN

float value_of(uint point) {
    uint code = texelFetch(value_texels, ivec2(int(point & 4095u), int(point >> 12u)), 0).x;
    return float(code) == value_code.z ? uintBitsToFloat(0x7FC00000u) : value_code.x + value_code.y * float(code);
}
#endif

void main() {
    int place = first_item + gl_InstanceID / SHARE;
    uvec4 item = texelFetch(items, ivec2(place & ((1 << ROW_BITS) - 1), place >> ROW_BITS), 0);
    uint points = item.z & 63u, share = item.z >> 8u;
    bool begins = (item.z & 64u) != 0u, ends = (item.z & 128u) != 0u;
    uint k = share * uint(SHARE) + uint(gl_InstanceID % SHARE), count = points - (ends && points > 1u ? 1u : 0u);
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    if (k >= count) return;
#if FEATURE_STREAMLINE_MASK
    if (texelFetch(kept, ivec2(int(item.x & 4095u), int(item.x >> 12u)), 0).x == 0u) return;
#endif
    bool start = k == 0u && begins, cap = k + 1u == count && ends;
    vec2 values = vec2(0.0);
#if FEATURE_VALUES_STORED
    values = vec2(value_of(item.y + k), value_of(item.y + min(k + 1u, points - (ends ? 1u : 0u))));
#endif
    ClippedSegment piece;
    if (!piece_of(from, to, start, cap, piece)) return;

    vec3 ahead = after - to, u_here = unit_or_none(to - from), u_before = k == 0u ? vec3(0.0) : unit_or_none(from - before);
    bool leads = k + 1u == count && !ends;
    vec3 u_after = cap ? vec3(0.0) : unit_or_none(ahead);
    Tangents tangents;
    if (points == 1u && ends) tangents = Tangents(unit_or_none(ahead), unit_or_none(ahead));
    else tangents = tangents_of(u_before, u_here, u_after, leads);
    uvec2 packed_ends = packed_tangents(tangents);
    seg_ids = uvec4(item.x | layer, packed_ends, (piece.start ? 1u : 0u) | (piece.cap ? 2u : 0u));
    seg_start = piece.a;
    seg_end = piece.b;
    seg_along = vec4(piece.t0, piece.t1, values);
#if FEATURE_VALUES_COLOUR
    seg_colours = uvec2(packUnorm4x8(colour_of(item.y + k)), packUnorm4x8(colour_of(item.y + min(k + 1u, points - (ends ? 1u : 0u)))));
#endif
#if FEATURE_WIDE_LINES
    seg_onward = piece.cap ? vec2(0.0) : onward_at(piece.b, ahead);
#if FEATURE_CLIP_PLANES
    seg_from = mix(from, to, piece.t0);
    seg_to = mix(from, to, piece.t1);
#endif
    vec2 a = piece.a.xy, run = piece.b.xy - a;
    float size = length(run), reach = half_line_width + 0.05, back = piece.start ? reach : 0.05;
    vec2 along = size > 0.0 ? run / size : vec2(1.0, 0.0), across = vec2(-along.y, along.x);
    vec2 at = ((gl_VertexID & 2) == 0 ? a - back * along : piece.b.xy + reach * along) + ((gl_VertexID & 1) == 0 ? -reach : reach) * across;
    gl_Position = vec4(2.0 * at / viewport - 1.0, 0.0, 1.0);
#else
    vec2 p = pixel_of(piece.a) + 0.5 + CELL_SHIFT, q = pixel_of(piece.b) + 0.5 + CELL_SHIFT, run = q - p;
    float square = dot(run, run), size = sqrt(square);
    vec2 along = size > 0.0 ? run / size : vec2(1.0, 0.0), across = vec2(-along.y, along.x);
    if (size == 0.0 && !piece.cap) return;
    const float reach = 0.75;
    vec2 at = ((gl_VertexID & 2) == 0 ? p - reach * along : q + reach * along) + ((gl_VertexID & 1) == 0 ? -reach : reach) * across;
    float depth = square > 0.0 ? piece.a.z + dot(at - p, run) / square * (piece.b.z - piece.a.z) : piece.b.z;
    gl_Position = vec4(2.0 * at / viewport - 1.0, 2.0 * clamp(depth, 0.0, 0.99999988) - 1.0, 1.0);
#endif
}
