// Cuts of the round brush of a wide line by the caller's planes. Without planes all is kept.
//
// h / w, the height above a plane over clip w, is linear in the window: it is found at both ends of a piece, and no division
// is left to do at a pixel. `away` is how far the pixel is from the piece's point s.

#if FEATURE_CLIP_PLANES
struct BrushHeights {
    vec2 at_ends[{{ max_clip_planes }}];   // h / w at the piece's ends
};

BrushHeights brush_heights(vec3 from, vec3 to, ClippedSegment piece) {
    BrushHeights heights;
    for (int plane = 0; plane < clip_plane_count; ++plane) {
        precise float ha = clip_height_of(plane, from), hb = clip_height_of(plane, to);
        precise vec2 h = vec2(ha + piece.t0 * (hb - ha), ha + piece.t1 * (hb - ha)) / max(vec2(piece.a.w, piece.b.w), vec2(1e-30));
        heights.at_ends[plane] = max(h, vec2(0.0));
    }
    return heights;
}

bool brush_kept(BrushHeights heights, float s, vec2 away) {
    for (int plane = 0; plane < clip_plane_count; ++plane) {
        vec2 h = heights.at_ends[plane];
        precise float there = h.x + s * (h.y - h.x);
        there += dot(clip_tilts[plane], away);
        if (there < 0.0) return false;
    }
    return true;
}
#else
struct BrushHeights { int none; };
BrushHeights brush_heights(vec3 from, vec3 to, ClippedSegment piece) { return BrushHeights(0); }
bool brush_kept(BrushHeights heights, float s, vec2 away) { return true; }
#endif
