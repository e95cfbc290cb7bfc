// What a fragment says of its pixel: the attachments of pvfiblets/engine/fiblets/pipelines/hardware_raster.py.
//
// Ties (equal depth in one pixel) go to the fiblet with the smallest index, as in the compute pipeline: OpenGL draws in
// order, and a later fragment must be nearer. In the second round of two-phase culling it may also be as near as the first
// round's, whose depth stands in the depth buffer moved up by its last digit; then the smaller index takes the pixel.

#include "frame/blocks.glsl"
#include "frame/project.glsl"
#if FEATURE_CLIP_REGION
#include "regions/boundaries.glsl"
#endif
#if FEATURE_MESH_EXT
#define VARYING perprimitiveEXT in
#elif FEATURE_PER_PRIMITIVE
#define VARYING flat perprimitiveNV in
#else
#define VARYING flat in
#endif
#include "fiblets/hardware_raster/varyings.glsl"
#include "fiblets/segments/peel.glsl"
#include "fiblets/attributes/tangent.glsl"
#include "fiblets/attributes/fragment_value.glsl"

#if FEATURE_GATHER
#include "fiblets/gather/slices.glsl"
#if FEATURE_PAINTED
#include "fiblets/gather/paint.glsl"
#endif

layout(location = 0) out vec4 out_slice0;
#if FEATURE_GATHER_SLICES
layout(location = 1) out vec4 out_slice1;
layout(location = 2) out vec4 out_slice2;
layout(location = 3) out vec4 out_slice3;
#endif
#else
layout(location = 0) out uint out_depth;
layout(location = 1) out uint out_owner;
layout(location = 2) out uvec2 out_ids;
layout(location = 3) out vec2 out_position;
#if FEATURE_CROSS_LINE && FEATURE_TUBES
layout(location = 4) out uint out_across;
#elif FEATURE_CROSS_LINE
layout(location = 4) out float out_across;
#endif

#if FEATURE_EDGES && FEATURE_CROSS_LINE
layout(location = 5) out uint out_edges;
#elif FEATURE_EDGES
layout(location = 4) out uint out_edges;
#endif

#endif

#if FEATURE_SECOND_ROUND
uniform usampler2D first_round;  // depth key and owner
#endif

const float NEARLY_ONE = 0.99999988;  // the largest depth drawn: that of an empty pixel is 1

Tangents varying_tangents() { return unpacked_tangents(uvec2(varying_ids.y, varying_tangent)); }

#if FEATURE_GATHER
// Adds to one of the sums, where OpenGL blends; a wide line or a tube once to a pixel (fiblets/compute/gather.comp).
void add(float s, uint key, uint segment, float t, float steps) {
#if FEATURE_WIDE_LINES
    bool start = (varying_ids.w & 0x10000u) != 0u, cap = (varying_ids.w & 0x20000u) != 0u;
    if (s >= 1.0 && !cap || s <= 0.0 && !start) discard;
#endif
    int slice = slice_of(ivec2(gl_FragCoord.xy), key, varying_ids.z);
    if (slice < 0) discard;
#if FEATURE_PAINTED
    vec4 adds = painted(varying_ids.x, unpacked_tangent(varying_tangent), value_at(segment, t, steps));
#else
    vec4 adds = vec4(0.0, 0.0, 0.0, 1.0);
#endif
    out_slice0 = slice == 0 ? adds : vec4(0.0);
#if FEATURE_GATHER_SLICES
    out_slice1 = slice == 1 ? adds : vec4(0.0);
    out_slice2 = slice == 2 ? adds : vec4(0.0);
    out_slice3 = slice == 3 ? adds : vec4(0.0);
#endif
}
#endif

// s: position along the part in the window, where depth is linear; ratio: clip w at its start over that at its end.
void shade(float s, float ratio, float depth) {
    float z = clamp(depth, 0.0, NEARLY_ONE);
#if FEATURE_CLIP_REGION
    if (!region_keeps(ivec2(gl_FragCoord.xy), z)) discard;
#endif
    uint key = depth_key(z), segment = varying_ids.w & 255u;
#if !FEATURE_GATHER
    gl_FragDepth = float(key >> 1u) / 2147483648.0;  // as coarse as the key, also below 2^-8 where float32 is finer
#endif
#if FEATURE_SECOND_ROUND
    uvec2 before = texelFetch(first_round, ivec2(gl_FragCoord.xy), 0).xy;
    if (key == before.x && varying_ids.z > before.y) discard;
#endif
    float t = clamp(s * ratio / max(1.0 - s + s * ratio, 1e-30), 0.0, 1.0), steps = float((varying_ids.w >> 8u) & 255u);
    begin_peel(varying_ids.x, varying_first);
#if FEATURE_WIDE_LINES && !FEATURE_TUBES
    peel_segment(varying_start.xy, varying_end.xy, half_line_width, steps);
#endif
    if (!behind_layers(ivec2(gl_FragCoord.xy), key) || !new_surface(ivec2(gl_FragCoord.xy), segment)) discard;
#if FEATURE_CLIPPING && !FEATURE_TUBES
    t = mix(float(varying_part & 0xFFFFu), float(varying_part >> 16u), t) / 65535.0;
#endif
#if FEATURE_GATHER
    add(s, key, segment, t, steps);
#else
    out_depth = key;
    out_owner = varying_ids.z;
    out_ids = uvec2(varying_ids.x, packed_tangent(tangent_between(varying_tangents(), t), 0u));
    out_position = vec2(varying_first + float(segment) + t * steps, value_at(segment, t, steps));
#endif
}
