// Pipeline `geometry`, wide lines: a point comes in for a share of a fiblet, a rectangle goes out for each of its segments.
// pvfiblets/engine/fiblets/pipelines/geometry.py has the arithmetic of shares.

#version 430

layout(points) in;

#if FEATURE_CLIP_PLANES
layout(triangle_strip, max_vertices = {{ cut_capsule_vertices }}) out;
const uint SHARE = {{ cut_capsule_share }}u;
#else
layout(triangle_strip, max_vertices = {{ capsule_vertices }}) out;
const uint SHARE = {{ capsule_share }}u;
#endif

#include "fiblets/segments/polyline.glsl"
#include "fiblets/hardware_raster/wide.glsl"
#include "fiblets/hardware_raster/write_varyings.glsl"
#include "fiblets/attributes/pixel.glsl"
#include "fiblets/geometry/share.glsl"

vec3 points[SHARE + 1u];
uint tangents[SHARE];
vec2 values[SHARE];

void main() {
    uint f, first;
    if (!begin_share(f, first)) return;
    uint end = min(polyline.count, first + SHARE);
    points[0] = walk_point;
    for (uint i = 0u; i < end; ++i) {
        float before = value_of_point(i);
        next_point(i + 1u);
        start_segment(i, walk_delta, polyline.steps);
        if (i + 1u >= first) points[i + 1u - first] = walk_point;
        if (i < first) continue;
        tangents[i - first] = pixel_ids.y;
        values[i - first] = vec2(before, value_of_point(i + 1u));
    }
    // Backwards, as shares are: of two segments with the same depth the later one stays, as with the compute pipeline.
    for (uint i = end; i > first; --i) {
        uint segment = i - 1u, k = segment - first;
        ClippedSegment piece;
        bool start = segment == 0u && polyline.begin, cap = i == polyline.count && polyline.end;
        if (!mask_segment(segment, start, cap) || !piece_of(points[k], points[k + 1u], start, cap, piece)) continue;
        Varyings varyings = Varyings(uvec2(pixel_ids.x, tangents[k]), chunk_first + f, pixel_first_point, segment, pixel_steps, values[k]);
        for (int corner = 0; corner < 4; ++corner) {
            gl_Position = corner_of(piece, corner);
            write_varyings(varyings, piece, points[k], points[k + 1u]);
            EmitVertex();
        }
        EndPrimitive();
    }
}
