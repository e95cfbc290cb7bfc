// Stores where the edges run of what a pixel shows (pvfiblets/engine/gbuffer.py); without FEATURE_EDGES nothing.

#if FEATURE_EDGES
#include "fiblets/segments/edges.glsl"
layout(r32ui, binding = {{ image_edges }}) writeonly uniform uimage2D edges_image;

void store_edges(ivec2 pixel, Segment segment) {
    ClippedSegment piece = segment.piece;
    vec2 centre = vec2(pixel) + 0.5;
    uint word;
#if FEATURE_TUBES
    vec4 c0 = segment.from.clip, c1 = segment.to.clip;
    Tube body = tube_of(segment.from.local, segment.to.local, c0, piece.start, piece.cap, next_run(segment));
    Hit hit;
    if (!tube_found(body, c0, c1, centre, hit)) return;
    word = tube_edges(body, c0, c1, centre, hit);
#elif FEATURE_LINE_ENDS
    vec2 run = piece.b.xy - piece.a.xy, from = centre - piece.a.xy;
    word = capsule_edges(from - end_at(piece, from, run, half_line_width) * run, vec2(0.0), half_line_width);
#elif FEATURE_WIDE_LINES
    word = capsule_edges(centre - piece.a.xy, piece.b.xy - piece.a.xy, half_line_width);
#else
    ivec2 first = ivec2(pixel_of(piece.a)), last = ivec2(pixel_of(piece.b));
    word = thin_edges(first, last, vec2(pixel - first), parts_of(piece), piece.start, piece.cap);
#endif
    imageStore(edges_image, pixel, uvec4(word));
}
#else
void store_edges(ivec2 pixel, Segment segment) {}
#endif
