// Pipeline `tessellation` (paper: Schertzer et al. 2022, section 4.5): the control stage decodes a fiblet, a patch of one
// vertex, and the evaluation stage draws its segments.
//
// Budget: OpenGL promises 128 components for each vertex that leaves this stage, and 120 for the patch. The 61 points of a
// fiblet and the next one's first, of four components each (w: per-point value), do not fit into either. So two vertices leave,
// each with 31 points, 124 components. Each invocation decodes up to the end of its own half: 1.5 times the work
// of one, without a barrier.
//
// A culled fiblet (fiblets/hardware_raster/survivors.vert) gets level 0: nothing leaves for it. Of the others all segments are one isoline, or
// each is one, where they may be cut (fiblets/tessellation/segment.glsl).

#version 430

layout(vertices = 2) out;

#include "fiblets/segments/polyline.glsl"
#include "fiblets/attributes/pixel.glsl"
#include "fiblets/tessellation/patch.glsl"

flat in uint shown[];

out Half { vec4 points[HALF]; } halves[];

patch out uvec4 patch_ids;
patch out float patch_first;
patch out uvec2 patch_around;
#if FEATURE_WIDE_LINES
patch out vec3 patch_beyond;
#endif
#if FEATURE_POINT_MASK
patch out uvec4 patch_mask;
#endif

void main() {
    gl_TessLevelOuter[0] = gl_TessLevelOuter[1] = 0.0;
    if (shown[0] == 0u) return;
    uint f = shown[0] - 1u, first = uint(gl_InvocationID) * HALF;
    begin_pixels(f);
    begin_polyline(f);
    uint end = min(polyline.count, first + HALF - 1u);
    for (uint i = 0u; i <= end; ++i) {
        if (i > 0u) {
            next_point(i);
            start_values(i - 1u, walk_point, walk_delta, polyline.steps);
        }
        if (i >= first) halves[gl_InvocationID].points[i - first] = vec4(walk_point, value_of_point(i));
    }
    patch_ids = uvec4(pixel_streamline, chunk_first + f, polyline.count | (uint(polyline.steps) << 8u),
                      (polyline.begin ? 1u : 0u) | (polyline.end ? 2u : 0u) | (polyline.whole ? 4u : 0u));
    patch_first = pixel_first_point;
    vec3 before = polyline.whole ? direction_before(f, true) : tangent_before, after = direction_after(f, polyline.whole);
    patch_around = uvec2(packed_tangent(before, NO_DIRECTION), packed_tangent(after, NO_DIRECTION));
#if FEATURE_WIDE_LINES
    patch_beyond = polyline.on ? after : vec3(0.0);
#endif
#if FEATURE_POINT_MASK
    patch_mask = uvec4(mask_low, mask_high, mask_segments, (mask_before ? 1u : 0u) | (mask_joined ? 2u : 0u));
#endif
#if FEATURE_CLIPPING || FEATURE_WIDE_LINES
    gl_TessLevelOuter[0] = float(polyline.count);
    gl_TessLevelOuter[1] = 1.0;
#else
    gl_TessLevelOuter[0] = 1.0;
    gl_TessLevelOuter[1] = float(polyline.count);
#endif
}
