// The pixels of a wide line's segment: all whose centre is at most half the width r from it: a capsule, whose round ends join
// segments without notches. The round end at a segment's start is left out where another segment ends: that segment draws it,
// without the pixels beside the next segment (fiblets/segments/joint.glsl).
//
// Algorithm: column by column of the longer axis, those rows that the capsule may reach; each pixel's distance decides.
//
// Symbols
//   from, to     ends of the piece, the longer axis first
//   foot, s      where on the piece a pixel is nearest to it, and the same within the piece
//   away         from there to the pixel
//
// FEATURE_LINE_ENDS: of these pixels only those of the discs of fiblets/segments/ends.glsl.
//
// FEATURE_CULL_PYRAMID: a segment behind the farthest depth of the pixels around it is left out (culling/pyramid_lookup.glsl).
//
// FEATURE_SUBSAMPLES: sixteen of the pixels are samples of one of the picture. PLACES tells how far each lies from the middle of its square,
// in these squares: together they are the positions of pvfiblets/engine/effects/sample_positions.py.

#include "fiblets/compute/software_raster/brush_planes.glsl"
#include "fiblets/segments/joint.glsl"
#if FEATURE_LINE_ENDS
#include "fiblets/segments/ends.glsl"
#endif
#if FEATURE_CULL_PYRAMID
#include "culling/pyramid_lookup.glsl"
uniform int tests_segments;      // 0 as long as there is no pyramid

bool segment_hidden(ClippedSegment piece, float r) {
    vec2 low = min(piece.a.xy, piece.b.xy) - r - 1.0, high = max(piece.a.xy, piece.b.xy) + r + 1.0;
    float farthest = farthest_in(ivec2(clamp(low, vec2(0.0), viewport - 1.0)), ivec2(clamp(high, vec2(0.0), viewport - 1.0)));
    return min(piece.a.z, piece.b.z) > farthest + 4e-7;
}
#endif

uniform uvec2 share;  // of every fiblet: first segment, and the one after the last; see pvfiblets/engine/fiblets/pipelines/compute.py

#if FEATURE_SUBSAMPLES
const float ASIDE = 0.57;   // at most
const vec2 PLACES[16] = vec2[](
    vec2(-0.123947, 0.045449), vec2(-0.102468, 0.005378), vec2(-0.086256, -0.100299), vec2(0.037171, -0.035177),
    vec2(0.561390, -0.085308), vec2(0.500000, 0.500000), vec2(-0.021070, -0.165393), vec2(-0.038614, -0.016146),
    vec2(-0.161150, -0.479104), vec2(-0.273790, 0.090791), vec2(0.216017, 0.198177), vec2(0.132082, -0.009444),
    vec2(-0.148137, -0.167483), vec2(-0.201669, 0.100203), vec2(-0.231628, -0.012162), vec2(-0.049409, 0.115960)
);
vec2 sample_aside(ivec2 texel) { return PLACES[4 * (texel.y & 3) + (texel.x & 3)]; }
#else
const float ASIDE = 0.0;
vec2 sample_aside(ivec2 texel) { return vec2(0.0); }
#endif

void cover(Segment segment) {
    if (segment.index < share.x || segment.index >= share.y) return;
    ClippedSegment piece = segment.piece;
    BrushHeights heights = brush_heights(segment.from.local, segment.to.local, piece);
    float r = half_line_width;
#if FEATURE_CULL_PYRAMID
    if (tests_segments != 0 && segment_hidden(piece, r)) return;
#endif
    vec2 d = piece.b.xy - piece.a.xy;
    peel_segment(piece.a.xy, piece.b.xy, r, segment.steps);
    bool steep = abs(d.y) > abs(d.x);
    vec2 from = steep ? piece.a.yx : piece.a.xy, to = steep ? piece.b.yx : piece.b.xy, size = steep ? viewport.yx : viewport;
    vec2 run = to - from;
    float inverse = 1.0 / max(dot(run, run), 1e-12);
    vec2 onward = piece.cap || !segment.goes_on ? vec2(0.0) : onward_at(piece.b, segment.ahead);
    if (steep) onward = onward.yx;
    vec2 left = (steep ? vec2(d.x, -d.y) : vec2(-d.y, d.x)) * sqrt(inverse) / r;
    float slope = abs(run.x) > 1e-6 ? run.y / run.x : 0.0;
    float reach = r * sqrt(1.0 + slope * slope) + ASIDE * (1.0 + abs(slope));  // half the capsule's height over a column
#if FEATURE_LINE_ENDS
    float behind = r;   // a short segment's end reaches beyond its start
#else
    float behind = piece.start ? r : r * min(abs(slope), 1.0);  // before the start
#endif
    float least = piece.start ? -3.0e38 : 0.0;
    vec2 before = run.x < 0.0 ? vec2(r, behind) : vec2(behind, r);
    int column0 = int(max(ceil(min(from.x, to.x) - before.x - 0.5 - ASIDE), 0.0));
    int column1 = int(min(floor(max(from.x, to.x) + before.y - 0.5 + ASIDE), size.x - 1.0));
    for (int column = column0; column <= column1; ++column) {
        float x = float(column) + 0.5;
        float y = from.y + slope * (clamp(x, min(from.x, to.x), max(from.x, to.x)) - from.x);
        int row0 = int(max(ceil(y - reach - 0.5), 0.0)), row1 = int(min(floor(y + reach - 0.5), size.y - 1.0));
        for (int row = row0; row <= row1; ++row) {
            ivec2 texel = steep ? ivec2(row, column) : ivec2(column, row);
            vec2 aside = sample_aside(texel), centre = vec2(x, float(row) + 0.5) + (steep ? aside.yx : aside) - from;
            float foot = dot(centre, run) * inverse;
            precise float s = clamp(foot, 0.0, 1.0);
#if FEATURE_LINE_ENDS
            s = end_at(segment.piece, steep ? centre.yx : centre, d, r);
#endif
            vec2 away = centre - s * run;
            precise float z = piece.a.z + (piece.b.z - piece.a.z) * s;
#if FEATURE_LINE_ENDS
            bool covered = s >= 0.0;
#else
            bool covered = foot >= least && dot(away, away) <= r * r && !(foot > 1.0 && beyond_joint(onward, centre - run));
#endif
            covered = covered && brush_kept(heights, s, steep ? away.yx : away);
            vec3 relief = vec3(clamp(dot(left, centre), -1.0, 1.0), 0.0, 0.0);
            if (covered) put(Fragment(texel, z, s, relief), segment);
        }
    }
}
