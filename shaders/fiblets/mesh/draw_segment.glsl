// Writes one segment by the functions of fiblets/mesh/outputs.glsl; fiblets/mesh/segment.glsl says how.

// slot: place in the share, which has `count` segments. handed: what the fragments need beside the piece.
void draw_segment(uint slot, uint count, Varyings varyings, vec3 from, vec3 to, bool start, bool cap) {
    ClippedSegment piece;
    uint primitive = PRIMITIVES * (count - 1u - slot);
    bool any = mask_segment(varyings.segment, start, cap) && piece_of(from, to, start, cap, piece);
#if FEATURE_WIDE_LINES
    for (int corner = 0; corner < 4; ++corner) put_vertex(4u * slot + uint(corner), any ? corner_of(piece, corner) : NOWHERE);
    put_triangle(primitive, 4u * slot + uvec3(0u, 1u, 2u));
    put_triangle(primitive + 1u, 4u * slot + uvec3(1u, 2u, 3u));
    put_varyings(primitive, varyings, piece, from, to);
    put_varyings(primitive + 1u, varyings, piece, from, to);
#else
    Thin line = thin_line(piece);
#if FEATURE_CLIPPING
    uint first = 2u * slot;
    put_vertex(first, any ? line.first : NOWHERE);
    put_vertex(first + 1u, any ? line.last : NOWHERE);
#else
    uint first = slot;
    if (slot == 0u) put_vertex(0u, line.first);
    put_vertex(first + 1u, line.last);
#endif
    put_line(primitive, uvec2(first, first + 1u));
    put_varyings(primitive, varyings, piece, from, to);
#endif
}
