// What a pixel shows, beside its depth, of the segment that owns it: found once for each pixel, after all lines are drawn
// (fiblets/hardware_raster/varyings.glsl). The fiblet is decoded up to the segment; streamline, tangent, place and value are those of the
// compute pipeline (fiblets/attributes/pixel.glsl).
//
// Symbols
//   s            where along the drawn part of the segment the pixel lies, in the window
//   t            where along the segment, in space
//
//   shown_owner, shown_segment    the fiblet of each pixel, counted over all chunks, and its segment

#version 430

#include "fiblets/segments/polyline.glsl"
#include "fiblets/segments/drawn_segment.glsl"
#include "fiblets/segments/thin_line_rule.glsl"
#include "fiblets/attributes/pixel.glsl"
#if FEATURE_EDGES
#include "fiblets/segments/segment_edges.glsl"
#endif
#if FEATURE_LINE_ENDS
#include "fiblets/segments/ends.glsl"
#endif

uniform usampler2D shown_owner;
uniform usampler2D shown_segment;

layout(location = 0) out uvec2 out_ids;
layout(location = 1) out vec2 out_position;
#if FEATURE_CROSS_LINE && FEATURE_TUBES
layout(location = 2) out uint out_across;
#elif FEATURE_CROSS_LINE
layout(location = 2) out float out_across;
#endif
#if FEATURE_EDGES && FEATURE_CROSS_LINE
layout(location = 3) out uint out_edges;
#elif FEATURE_EDGES
layout(location = 2) out uint out_edges;
#endif

// Walks to a segment, and finds its tangents.
Segment walked_to(uint f, uint index) {
    begin_pixels(f);
    begin_polyline(f);
    vec3 behind = polyline.whole ? direction_before(f, true) : tangent_before, from = walk_point, run = vec3(0.0);
    index = min(index, polyline.count - 1u);
    for (uint i = 0u; i <= index; ++i) {
        if (run != vec3(0.0)) behind = run;
        from = walk_point;
        next_point(i + 1u);
        run = walk_delta;
        start_values(i, walk_point, run, polyline.steps);
    }
    vec3 to = walk_point, ahead = walk_ahead(index + 1u);
    bool last = index + 1u == polyline.count, start = index == 0u && polyline.begin, cap = last && polyline.end;
    tangents = tangents_of(unit_or_none(behind), unit_or_none(run), unit_or_none(ahead), last && !polyline.whole);
    mask_segment(index, start, cap);
    Vertex a = vertex_of(from), b = vertex_of(to);
    ClippedSegment piece;
    piece_of(a, b, start, cap, piece);
    return Segment(index, a, b, piece, polyline.steps, ahead, goes_on(index + 1u));
}

float place_of(Segment segment, ivec2 pixel) {
    ClippedSegment piece = segment.piece;
    vec2 run = piece.b.xy - piece.a.xy, centre = vec2(pixel) + 0.5 - piece.a.xy;
#if FEATURE_TUBES
    Tube body = tube_of(segment.from.local, segment.to.local, segment.from.clip, piece.start, piece.cap, next_run(segment));
    Hit hit = Hit(0.0, 0.5, vec3(1.0, 0.0, 0.0), false);
    if (!tube_found(body, segment.from.clip, segment.to.clip, vec2(pixel) + 0.5, hit)) return 0.5;
#if FEATURE_CROSS_LINE
    out_across = packed_direction(smooth_normal(hit, tangent_between(tangents, hit.t)));
#endif
    return hit.t;
#elif FEATURE_LINE_ENDS
    return max(end_at(piece, centre, run, half_line_width), 0.0);
#elif FEATURE_WIDE_LINES
    float inverse = 1.0 / max(dot(run, run), 1e-12);
#if FEATURE_CROSS_LINE
    vec2 left = vec2(-run.y, run.x) * sqrt(inverse) / half_line_width;
    out_across = clamp(dot(left, centre), -1.0, 1.0);
#endif
    return clamp(dot(centre, run) * inverse, 0.0, 1.0);
#else
    ivec2 p = ivec2(pixel_of(piece.a)), q = ivec2(pixel_of(piece.b));
    Cells cells = cells_between(p, q);
    vec2 at = vec2(pixel - p);
    return at == cells.run ? 1.0 : dot(at - CELL_SHIFT, cells.run) * cells.square;
#endif
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uint f = texelFetch(shown_owner, pixel, 0).x - chunk_first;
    if (f >= chunk_fiblets) discard;   // empty, or another chunk's
    Segment segment = walked_to(f, texelFetch(shown_segment, pixel, 0).x);
    float s = place_of(segment, pixel), t = along_segment(segment.from, segment.to, segment.piece, s);
    out_ids = pixel_ids(t);
    out_position = pixel_place(segment.index, t);
#if FEATURE_EDGES
    out_edges = edges_of(pixel, segment);
#endif
}
