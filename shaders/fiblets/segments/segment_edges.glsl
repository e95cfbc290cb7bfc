// The edges (frame/edges.glsl) of a pixel that shows a segment.

#include "fiblets/segments/drawn_segment.glsl"
#include "fiblets/segments/edges.glsl"
#if FEATURE_LINE_ENDS
#include "fiblets/segments/ends.glsl"
#endif

uint edges_of(ivec2 pixel, Segment segment) {
    ClippedSegment piece = segment.piece;
    vec2 centre = vec2(pixel) + 0.5;
#if FEATURE_TUBES
    vec4 c0 = segment.from.clip, c1 = segment.to.clip;
    Tube body = tube_of(segment.from.local, segment.to.local, c0, piece.start, piece.cap, next_run(segment));
    Hit hit;
    return tube_found(body, c0, c1, centre, hit) ? tube_edges(body, c0, c1, centre, hit) : 0u;
#elif FEATURE_LINE_ENDS
    vec2 run = piece.b.xy - piece.a.xy, from = centre - piece.a.xy;
    return capsule_edges(from - end_at(piece, from, run, half_line_width) * run, vec2(0.0), half_line_width);
#elif FEATURE_WIDE_LINES
    return capsule_edges(centre - piece.a.xy, piece.b.xy - piece.a.xy, half_line_width);
#else
    ivec2 first = ivec2(pixel_of(piece.a)), last = ivec2(pixel_of(piece.b));
    return thin_edges(first, last, vec2(pixel - first), parts_of(piece), piece.start, piece.cap);
#endif
}
