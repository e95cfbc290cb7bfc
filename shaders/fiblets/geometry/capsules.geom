// Pipeline `geometry`, wide lines: a point comes in for a share of a fiblet, a rectangle goes out for each of its segments.
// pvfiblets/engine/fiblets/pipelines/geometry.py has the arithmetic of shares.

#version 430

layout(points) in;

#if FEATURE_CLIP_PLANES
layout(triangle_strip, max_vertices = {{ cut_capsule_vertices }}) out;
const uint SHARE = {{ cut_capsule_share }}u;
#else
#if FEATURE_PAINTED
layout(triangle_strip, max_vertices = {{ painted_capsule_vertices }}) out;
const uint SHARE = {{ painted_capsule_share }}u;
#else
layout(triangle_strip, max_vertices = {{ capsule_vertices }}) out;
const uint SHARE = {{ capsule_share }}u;
#endif
#endif

#include "fiblets/segments/polyline.glsl"
#include "fiblets/hardware_raster/wide.glsl"
#include "fiblets/hardware_raster/write_varyings.glsl"
#include "fiblets/attributes/values.glsl"
#include "fiblets/geometry/share.glsl"

vec3 points[SHARE + 1u];
vec2 values[SHARE];
vec3 aheads[SHARE];

void main() {
    uint f, first, end;
    if (!begin_share(f, first, end)) return;
    uint streamline = handed_streamline(f);
    float first_point = handed_first(f);
    points[0] = walk_point;
    next_point(1u);
    for (uint i = 0u; i < end; ++i) {
        float before = value_of_point(i);
        vec3 to = walk_point, delta = walk_delta, ahead = walk_ahead(i + 1u);
        start_values(i, to, delta, polyline.steps);
        if (i + 1u >= first) points[i + 1u - first] = to;
        if (i < first) continue;
        aheads[i - first] = goes_on(i + 1u) ? ahead : vec3(0.0);
        values[i - first] = vec2(before, value_of_point(i + 1u));
    }
    // Backwards, as shares are: of two segments with the same depth the later one stays, as with the compute pipeline.
    for (uint i = end; i > first; --i) {
        uint segment = i - 1u, k = segment - first;
        ClippedSegment piece;
        bool start = segment == 0u && polyline.begin, cap = i == polyline.count && polyline.end;
        if (!mask_segment(segment, start, cap) || !piece_of(points[k], points[k + 1u], start, cap, piece)) continue;
        Varyings varyings = Varyings(streamline, chunk_first + f, first_point, segment, polyline.steps, values[k], aheads[k]);
        for (int corner = 0; corner < 4; ++corner) {
            gl_Position = corner_of(piece, corner);
            write_varyings(varyings, piece, points[k], points[k + 1u]);
            EmitVertex();
        }
        EndPrimitive();
    }
}
