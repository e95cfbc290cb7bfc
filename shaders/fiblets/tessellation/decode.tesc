// Pipeline `tessellation` (paper: Schertzer et al. 2022, section 4.5): the control stage decodes a fiblet, a patch of one
// vertex, and the evaluation stage draws its segments.
//
// Budget: OpenGL promises 128 components for each vertex that leaves this stage, and 120 for the patch. The 61 points of a
// fiblet and the next one's first, of three components each, four with per-point values, do not fit into either. So two vertices
// leave, each with 31 points, 124 components at most. Each invocation decodes up to the end of its own half: 1.5 times the work
// of one, without a barrier.
//
// A culled fiblet (fiblets/hardware_raster/survivors.vert) gets level 0: nothing leaves for it. Of the others all segments are one isoline, a
// vertex a point; or, of thin lines that may be cut, each is one (fiblets/tessellation/segment.glsl).

#version 430

layout(vertices = 2) out;

#include "fiblets/segments/polyline.glsl"
#include "fiblets/attributes/values.glsl"
#include "fiblets/hardware_raster/handed.glsl"
#include "fiblets/tessellation/patch.glsl"

flat in uint shown[];
#if FEATURE_CLIPPING && !FEATURE_WIDE_LINES
flat in uint uncut[];
#endif

out Half { HALF_POINT points[HALF]; } halves[];

patch out uvec4 patch_ids;
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
    begin_values(f);
    begin_polyline(f);
    uint end = min(polyline.count, first + HALF - 1u);
    for (uint i = 0u; i <= end; ++i) {
        if (i > 0u) {
            next_point(i);
            start_values(i - 1u, walk_point, walk_delta, polyline.steps);
        }
        if (i < first) continue;
        halves[gl_InvocationID].points[i - first] = HALF_POINT(vec4(walk_point, value_of_point(i)));
    }
#if FEATURE_CLIPPING && !FEATURE_WIDE_LINES
    bool one = uncut[0] != 0u;
#else
    bool one = true;
#endif
    patch_ids = uvec4(chunk_first + f, polyline.count | (uint(polyline.steps) << 8u) | (polyline.begin ? 0x10000u : 0u)
                      | (polyline.end ? 0x20000u : 0u) | (one ? 0x40000u : 0u), handed_streamline(f), floatBitsToUint(handed_first(f)));
#if FEATURE_WIDE_LINES
    patch_beyond = polyline.on ? direction_after(f, polyline.whole) : vec3(0.0);
#endif
#if FEATURE_POINT_MASK
    patch_mask = uvec4(mask_low, mask_high, mask_segments, (mask_before ? 1u : 0u) | (mask_joined ? 2u : 0u));
#endif
    gl_TessLevelOuter[0] = one ? 1.0 : float(polyline.count);
    gl_TessLevelOuter[1] = one ? float(polyline.count) : 1.0;
}
