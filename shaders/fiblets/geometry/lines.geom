// Pipeline `geometry` (paper: Schertzer et al. 2022, section 4.5), thin lines: a point comes in for a share of a fiblet, a
// strip goes out, decoded while it is emitted. One invocation walks along the fiblet from its first point to the share's
// end. pvfiblets/engine/fiblets/pipelines/geometry.py has the arithmetic of shares.
//
// Consecutive segments share a vertex, unless one of them was cut (fiblets/segments/clipped_segment.glsl): then a new strip begins.

#version 430

layout(points) in;

#if FEATURE_CLIPPING
layout(line_strip, max_vertices = {{ cut_line_vertices }}) out;
const uint SHARE = {{ cut_line_share }}u;
#else
layout(line_strip, max_vertices = {{ line_vertices }}) out;
const uint SHARE = {{ line_share }}u;
#endif

#include "fiblets/segments/polyline.glsl"
#include "fiblets/hardware_raster/thin.glsl"
#include "fiblets/hardware_raster/write_varyings.glsl"
#include "fiblets/attributes/values.glsl"
#include "fiblets/geometry/share.glsl"

void main() {
    uint f, first, end;
    if (!begin_share(f, first, end)) return;
    uint streamline = handed_streamline(f);
    float first_point = handed_first(f);
    bool open = false;
    for (uint i = 1u; i <= end; ++i) {
        vec3 from = walk_point;
        float before = value_of_point(i - 1u);
        next_point(i);
        start_values(i - 1u, walk_point, walk_delta, polyline.steps);
        if (i <= first) continue;
        ClippedSegment piece;
        bool start = i == 1u && polyline.begin, cap = i == polyline.count && polyline.end;
        if (!mask_segment(i - 1u, start, cap) || !piece_of(from, walk_point, start, cap, piece)) {
            open = false;
            continue;
        }
        Varyings varyings = Varyings(streamline, chunk_first + f, first_point, i - 1u, polyline.steps,
                                     vec2(before, value_of_point(i)), vec3(0.0));
        Thin line = thin_line(piece);
        for (int side = open && piece.t0 == 0.0 ? 1 : 0; side < 2; ++side) {
            if (side == 0) EndPrimitive();
            gl_Position = side == 0 ? line.first : line.last;
            write_varyings(varyings, piece, from, walk_point);
            EmitVertex();
        }
        open = !piece.cap;
    }
}
