// The pixels of a tube's segment: column by column of the longer axis of its outline (fiblets/segments/line_tube.glsl), those rows that
// the outline reaches, and of these all pixels whose ray meets the tube.

void cover(Segment segment) {
    ClippedSegment piece = segment.piece;
    Outline outline = Outline(piece.a, piece.b, piece.t0, piece.t1, piece.reach, piece.thin);
    Tube body = tube_of(segment.from.local, segment.to.local, segment.from.clip, piece.start, piece.cap, next_run(segment));
    float r = outline.reach;
    vec2 run = outline.b.xy - outline.a.xy;
    peel_segment(outline.a.xy, outline.b.xy, r, segment.steps);
    bool steep = abs(run.y) > abs(run.x);
    vec2 a = steep ? outline.a.yx : outline.a.xy, b = steep ? outline.b.yx : outline.b.xy;
    vec2 size = steep ? viewport.yx : viewport;
    float slope = abs(b.x - a.x) > 1e-6 ? (b.y - a.y) / (b.x - a.x) : 0.0, height = r * sqrt(1.0 + slope * slope);
    vec2 ends = vec2(min(a.x, b.x), max(a.x, b.x));
    int column0 = int(max(ceil(ends.x - r - 0.5), 0.0)), column1 = int(min(floor(ends.y + r - 0.5), size.x - 1.0));
    for (int column = column0; column <= column1; ++column) {
        float x = float(column) + 0.5, y = a.y + slope * (clamp(x, ends.x, ends.y) - a.x);
        int row0 = int(max(ceil(y - height - 0.5), 0.0)), row1 = int(min(floor(y + height - 0.5), size.y - 1.0));
        for (int row = row0; row <= row1; ++row) {
            ivec2 pixel = steep ? ivec2(row, column) : ivec2(column, row);
            Hit hit;
            if (tube_at(body, segment.from.clip, outline, vec2(pixel) + 0.5, hit)) {
                put(Fragment(pixel, hit.z, hit.t, shown_normal(hit)), segment);
            }
        }
    }
}
