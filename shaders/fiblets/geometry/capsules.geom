// Pipeline `geometry`, wide lines: a point comes in for a share of a fiblet, a rectangle goes out for each of its segments.
// pvfiblets/engine/fiblets/pipelines/geometry.py has the arithmetic of shares.

#version 430

layout(points) in;

#if FEATURE_CLIP_PLANES
layout(triangle_strip, max_vertices = {{ cut_capsule_vertices }}) out;
const uint SHARE = {{ cut_capsule_share }}u;
#else
#if FEATURE_VALUES_ARC_LENGTH || FEATURE_VALUES_VOLUME
layout(triangle_strip, max_vertices = {{ valued_capsule_vertices }}) out;
const uint SHARE = {{ valued_capsule_share }}u;
#else
layout(triangle_strip, max_vertices = {{ capsule_vertices }}) out;
const uint SHARE = {{ capsule_share }}u;
#endif
#endif

#include "fiblets/segments/polyline.glsl"
#include "fiblets/hardware_raster/wide.glsl"
#include "fiblets/hardware_raster/write_varyings.glsl"
#include "fiblets/attributes/pixel.glsl"
#include "fiblets/geometry/share.glsl"

vec3 points[SHARE + 1u];
uvec2 at_ends[SHARE];
vec2 values[SHARE];
vec3 aheads[SHARE];

void main() {
    uint f, first;
    if (!begin_share(f, first)) return;
    uint end = min(polyline.count, first + SHARE);
    points[0] = walk_point;
    next_point(1u);
    for (uint i = 0u; i < end; ++i) {
        float before = value_of_point(i);
        vec3 to = walk_point, delta = walk_delta, ahead = walk_ahead(i + 1u);
        start_segment(i, to, delta, ahead);
        if (i + 1u >= first) points[i + 1u - first] = to;
        if (i < first) continue;
        at_ends[i - first] = packed_tangents(tangents);
        aheads[i - first] = goes_on(i + 1u) ? ahead : vec3(0.0);
        values[i - first] = vec2(before, value_of_point(i + 1u));
    }
    // Backwards, as shares are: of two segments with the same depth the later one stays, as with the compute pipeline.
    for (uint i = end; i > first; --i) {
        uint segment = i - 1u, k = segment - first;
        ClippedSegment piece;
        bool start = segment == 0u && polyline.begin, cap = i == polyline.count && polyline.end;
        if (!mask_segment(segment, start, cap) || !piece_of(points[k], points[k + 1u], start, cap, piece)) continue;
        Varyings varyings = Varyings(pixel_streamline, at_ends[k], chunk_first + f, pixel_first_point, segment, polyline.steps, values[k],
                                     aheads[k]);
        for (int corner = 0; corner < 4; ++corner) {
            gl_Position = corner_of(piece, corner);
            write_varyings(varyings, piece, points[k], points[k + 1u]);
            EmitVertex();
        }
        EndPrimitive();
    }
}
