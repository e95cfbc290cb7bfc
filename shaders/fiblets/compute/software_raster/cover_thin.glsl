// The pixels of a thin line's segment: see fiblets/segments/thin_line_rule.glsl.

#include "fiblets/segments/thin_line_rule.glsl"

void cover(Segment segment) {
    ClippedSegment piece = segment.piece;
    ivec2 p = ivec2(pixel_of(piece.a)), q = ivec2(pixel_of(piece.b));
    Cells cells = cells_between(p, q);
    precise vec2 slope = cells.square * (piece.b.z - piece.a.z) * cells.run;
    precise float base = piece.a.z - dot(CELL_SHIFT, slope);
    vec2 per = cells.run * cells.inverse, begin = 0.5 + CELL_SHIFT - cells.shift * per;
    for (int i = 0; i < cells.count; ++i) {
        precise vec2 at = floor(begin + float(i) * per);
        precise float z = base + dot(at, slope);
        put(Fragment(p + ivec2(at), z, dot(at - CELL_SHIFT, cells.run) * cells.square, vec3(0.0)), segment);
    }
    if (piece.cap) put(Fragment(q, piece.b.z, 1.0, vec3(0.0)), segment);
}
