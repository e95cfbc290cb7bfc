// Which fragments of a line count, and where along it they are; what they say of their pixel is in write_nearest.glsl, or
// add_to_sums.glsl where all lines of a pixel are added up.
//
// Ties (equal depth in one pixel) go to the fiblet with the smallest index, as in the compute pipeline: OpenGL draws in
// order, and a later fragment must be nearer. In the second round of two-phase culling it may also be as near as the first
// round's, whose depth stands in the depth buffer moved up by its last digit; then the smaller index takes the pixel.

#include "frame/blocks.glsl"
#include "frame/project.glsl"
#if FEATURE_CLIP_REGION
#include "regions/boundaries.glsl"
#endif
#if FEATURE_MESH_EXT  // Mesa wants them without `flat` (pvfiblets/engine/gl/mesh_program.py)
#define VARYING flat perprimitiveEXT in
#elif FEATURE_PER_PRIMITIVE
#define VARYING flat perprimitiveNV in
#else
#define VARYING flat in
#endif
#include "fiblets/hardware_raster/varyings.glsl"
#include "fiblets/segments/peel.glsl"

#if FEATURE_GATHER
#include "fiblets/hardware_raster/add_to_sums.glsl"
#else
#include "fiblets/hardware_raster/write_nearest.glsl"
#endif

#if FEATURE_SECOND_ROUND
uniform usampler2D first_round;  // depth key and owner
#endif

const float NEARLY_ONE = 0.99999988;  // the largest depth drawn: that of an empty pixel is 1

// s: position along the part in the window, where depth is linear; ratio: clip w at its start over that at its end.
void shade(float s, float ratio, float depth) {
    float z = clamp(depth, 0.0, NEARLY_ONE);
#if FEATURE_CLIP_REGION
    if (!region_keeps(ivec2(gl_FragCoord.xy), z)) discard;
#endif
    uint key = depth_key(z), segment = varying_ids.y & 255u;
#if FEATURE_SECOND_ROUND
    uvec2 before = texelFetch(first_round, ivec2(gl_FragCoord.xy), 0).xy;
    if (key == before.x && varying_ids.x > before.y) discard;
#endif
#if FEATURE_WIDE_LINES && (FEATURE_PEEL || FEATURE_GATHER_SLICES)
    begin_peel(varying_streamline, varying_first);
#if !FEATURE_TUBES
    peel_segment(varying_start.xy, varying_end.xy, half_line_width, float((varying_ids.y >> 8u) & 255u));
#endif
#endif
    if (!behind_layers(ivec2(gl_FragCoord.xy), key) || !new_surface(ivec2(gl_FragCoord.xy), segment)) discard;
    write_fragment(s, ratio, key, segment);
}
