// Pipeline `geometry` (paper: Schertzer et al. 2022, section 4.5), thin lines: a point comes in for a share of a fiblet, a
// strip goes out, decoded while it is emitted. One invocation walks along the fiblet from its first point to the share's
// end. pvfiblets/engine/fiblets/pipelines/geometry.py has the arithmetic of shares.
//
// Consecutive segments share a vertex, unless one of them was cut (fiblets/segments/clipped_segment.glsl): then a new strip begins.

#version 430

layout(points) in;

#if FEATURE_VALUES_ARC_LENGTH || FEATURE_VALUES_VOLUME
#if FEATURE_CLIPPING
layout(line_strip, max_vertices = {{ cut_valued_line_vertices }}) out;
const uint SHARE = {{ cut_valued_line_share }}u;
#else
layout(line_strip, max_vertices = {{ valued_line_vertices }}) out;
const uint SHARE = {{ valued_line_share }}u;
#endif
#else
#if FEATURE_CLIPPING
layout(line_strip, max_vertices = {{ cut_line_vertices }}) out;
const uint SHARE = {{ cut_line_share }}u;
#else
layout(line_strip, max_vertices = {{ line_vertices }}) out;
const uint SHARE = {{ line_share }}u;
#endif
#endif

#include "fiblets/segments/polyline.glsl"
#include "fiblets/hardware_raster/thin.glsl"
#include "fiblets/hardware_raster/write_varyings.glsl"
#include "fiblets/attributes/pixel.glsl"
#include "fiblets/geometry/share.glsl"

void main() {
    uint f, first;
    if (!begin_share(f, first)) return;
    bool open = false;
    vec3 to = walk_point;
    next_point(1u);
    uint end = min(polyline.count, first + SHARE);
    for (uint i = 1u; i <= end; ++i) {
        vec3 from = to, delta = walk_delta;
        to = walk_point;
        float before = value_of_point(i - 1u);
        start_segment(i - 1u, to, delta, walk_ahead(i));
        if (i <= first) continue;
        ClippedSegment piece;
        bool start = i == 1u && polyline.begin, cap = i == polyline.count && polyline.end;
        if (!mask_segment(i - 1u, start, cap) || !piece_of(from, to, start, cap, piece)) {
            open = false;
            continue;
        }
        Varyings varyings = Varyings(pixel_streamline, packed_tangents(tangents), chunk_first + f, pixel_first_point, i - 1u, polyline.steps,
                                     vec2(before, value_of_point(i)), vec3(0.0));
        Thin line = thin_line(piece);
        for (int side = open && piece.t0 == 0.0 ? 1 : 0; side < 2; ++side) {
            if (side == 0) EndPrimitive();
            gl_Position = side == 0 ? line.first : line.last;
            write_varyings(varyings, piece, from, to);
            EmitVertex();
        }
        open = !piece.cap;
    }
}
