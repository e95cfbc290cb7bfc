// Ends of streamlines: a disc about the first point and one about the last, in the window, at the depths of these points.
// A segment is drawn only where it has one of them, and shows nothing else.

// The end whose disc a pixel shows, of both the nearer: 0 at the segment's start, 1 at its end; -1 for none.
// centre: the pixel's, from the start; run: from there to the end; r: the radius.
float end_at(ClippedSegment piece, vec2 centre, vec2 run, float r) {
    bool first = piece.start && dot(centre, centre) <= r * r, last = piece.cap && dot(centre - run, centre - run) <= r * r;
    if (first && !(last && piece.b.z < piece.a.z)) return 0.0;
    return last ? 1.0 : -1.0;
}
