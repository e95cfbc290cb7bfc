// A segment as a rectangle, four corners an instance, between points that decode.vert has left; or, of thin lines whose segments
// take few pixels, as a square of pixels, one vertex each (SPRITES).
//
// Clipping and joints are the engine's (fiblets/segments). Thin lines take the pixels of thin_line_rule.glsl, which segment.frag
// chooses from the rectangle; their depth is linear in the window and comes with it.

#version 430

#include "fiblets/segments/thin_line_rule.glsl"
#include "fiblets/segments/clipped_segment.glsl"
#include "fiblets/segments/joint.glsl"
#include "fiblets/attributes/tangent.glsl"
#include "page/far_tile_size.glsl"
#include "page/rows.glsl"
#include "page/segment_varyings.glsl"

const bool SPRITES = false;

layout(location = 0) in uvec4 slot_from;    // point, tangent
layout(location = 1) in uvec4 slot_to;
#if FEATURE_WIDE_LINES
layout(location = 2) in uvec4 slot_after;
#endif

uniform int share_size;
uniform highp usampler2D items;        // rgba32ui: streamline; first point; points, begin, end and share; points before
uniform int first_item;
uniform uint layer;                    // in the upper four bits of the streamline
#if FEATURE_STREAMLINE_MASK
uniform highp usampler2D kept;         // r8ui, by streamline: not 0 where it is drawn
#endif
#if FEATURE_POINT_MASK
uniform highp usampler2D kept_points;  // r32ui, a bit for each point: 1 where it is kept (shaders/fiblets/data/point_mask.glsl)

bool point_kept(uint point) {
    uint word = point >> 5u;
    return ((texelFetch(kept_points, texel(word), 0).x >> (point & 31u)) & 1u) != 0u;
}
#endif
#if FEATURE_VALUES_COLOUR
uniform highp sampler2D point_colours; // rgba8, by point

vec4 colour_of(uint point) { return texelFetch(point_colours, texel(point), 0); }
#endif
#if FEATURE_VALUES_STORED
uniform highp usampler2D value_texels; // r8ui or r16ui, by point
uniform highp usampler2D value_table;  // r32ui, by code: a float's bits

float value_of(uint point) {
    return uintBitsToFloat(texelFetch(value_table, texel(texelFetch(value_texels, texel(point), 0).x), 0).x);
}
#endif

uniform highp usampler2D far_tiles;    // r32ui, by far_tiles.frag; a whole picture of 1.0 where nothing is known

// Whether all pixels of a piece, which takes at most two tiles by two, are nearer than it.
bool hidden(ClippedSegment piece) {
    vec2 reach = vec2(half_line_width > 0.0 ? half_line_width + 1.0 : 0.0), low = min(piece.a.xy, piece.b.xy) - reach, high = max(piece.a.xy, piece.b.xy) + reach;
    ivec2 last = textureSize(far_tiles, 0) - 1;
    ivec2 from = clamp(ivec2(low) / FAR_TILE, ivec2(0), last), to = clamp(ivec2(high) / FAR_TILE, ivec2(0), last);
    if (any(greaterThan(to - from, ivec2(1)))) return false;
    uint farthest = max(max(texelFetch(far_tiles, from, 0).x, texelFetch(far_tiles, to, 0).x),
                        max(texelFetch(far_tiles, ivec2(from.x, to.y), 0).x, texelFetch(far_tiles, ivec2(to.x, from.y), 0).x));
    // A pixel's depth may lie a little beyond both ends' (thin_line_rule.glsl).
    return min(piece.a.z, piece.b.z) - abs(piece.b.z - piece.a.z) > uintBitsToFloat(farthest);
}

void main() {
    int index = SPRITES ? gl_VertexID : gl_InstanceID, place = first_item + index / share_size;
    uvec4 item = texelFetch(items, texel(uint(place)), 0);
    uint points = item.z & 63u, share = item.z >> 8u;
    bool begins = (item.z & 64u) != 0u, ends = (item.z & 128u) != 0u;
    uint k = share * uint(share_size) + uint(index % share_size), count = points - (ends && points > 1u ? 1u : 0u);
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    gl_PointSize = 1.0;
    if (k >= count) return;
#if FEATURE_STREAMLINE_MASK
    if (texelFetch(kept, texel(item.x), 0).x == 0u) return;
#endif
    bool start = k == 0u && begins, cap = k + 1u == count && ends;
#if FEATURE_LINE_ENDS
    if (!start && !cap) return;
#endif
    uint here = item.y + k, there = item.y + min(k + 1u, points - (ends ? 1u : 0u));
#if FEATURE_POINT_MASK
    if (!point_kept(here) || !point_kept(there)) return;
#if !FEATURE_LINE_ENDS
    start = start || !point_kept(here - 1u);
    cap = cap || !point_kept(there + 1u);
#endif
#endif
    vec2 values = vec2(0.0);
#if FEATURE_VALUES_STORED
    values = vec2(value_of(here), value_of(there));
#endif
    vec3 from = uintBitsToFloat(slot_from.xyz), to = uintBitsToFloat(slot_to.xyz);
    ClippedSegment piece;
    if (!piece_of(from, to, start, cap, piece) || hidden(piece)) return;

    seg_ids = uvec2(item.x | layer, (piece.start ? 1u : 0u) | (piece.cap ? 2u : 0u));
    seg_tangent = unpacked_tangent(slot_from.w);
    seg_tangent_to = unpacked_tangent(slot_to.w);
    seg_start = piece.a;
    seg_end = piece.b;
    seg_along = vec4(piece.t0, piece.t1, values);
#if FEATURE_VALUES_COLOUR
    seg_colours = uvec2(packUnorm4x8(colour_of(here)), packUnorm4x8(colour_of(there)));
#endif
#if FEATURE_WIDE_LINES
#if FEATURE_GATHER_SLICES
    seg_place = here * uint(PLACE_STEPS);
#endif
    seg_onward = piece.cap ? vec2(0.0) : onward_at(piece.b, uintBitsToFloat(slot_after.xyz) - to);
#if FEATURE_CLIP_PLANES
    seg_from = mix(from, to, piece.t0);
    seg_to = mix(from, to, piece.t1);
#endif
    vec2 a = piece.a.xy, run = piece.b.xy - a;
    float size = length(run), reach = half_line_width + 0.05, back = piece.start ? reach : 0.05;
#if FEATURE_LINE_ENDS
    back = reach;   // a short segment's end reaches beyond its start
#endif
    vec2 along = size > 0.0 ? run / size : vec2(1.0, 0.0), across = vec2(-along.y, along.x);
    vec2 at = ((gl_VertexID & 2) == 0 ? a - back * along : piece.b.xy + reach * along) + ((gl_VertexID & 1) == 0 ? -reach : reach) * across;
    gl_Position = vec4(2.0 * at / viewport - 1.0, 0.0, 1.0);
#else
    vec2 p = pixel_of(piece.a) + 0.5 + CELL_SHIFT, q = pixel_of(piece.b) + 0.5 + CELL_SHIFT, run = q - p;
    float square = dot(run, run), size = sqrt(square);
    vec2 along = size > 0.0 ? run / size : vec2(1.0, 0.0), across = vec2(-along.y, along.x);
    if (size == 0.0 && !piece.cap) return;
    if (SPRITES) {
        // As many pixels as the line has, from its first one on.
        float pixels = max(abs(run.x), abs(run.y)) + (piece.cap ? 1.0 : 0.0);
        gl_PointSize = pixels;
        gl_Position = vec4(2.0 * (p - CELL_SHIFT + 0.5 * (pixels - 1.0) * sign(run + 1e-3)) / viewport - 1.0, 0.0, 1.0);
        return;
    }
    const float reach = 0.75;
    vec2 at = ((gl_VertexID & 2) == 0 ? p - reach * along : q + reach * along) + ((gl_VertexID & 1) == 0 ? -reach : reach) * across;
    float depth = square > 0.0 ? piece.a.z + dot(at - p, run) / square * (piece.b.z - piece.a.z) : piece.b.z;
    gl_Position = vec4(2.0 * at / viewport - 1.0, 2.0 * clamp(depth, 0.0, 0.99999988) - 1.0, 1.0);
#endif
}
