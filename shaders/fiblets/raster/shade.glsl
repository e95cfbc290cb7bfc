// What a fragment says of its pixel: the attachments of pvfiblets/engine/fiblets/pipelines/raster.py.
//
// Ties (equal depth in one pixel) go to the fiblet with the smallest index, as in the compute pipeline: OpenGL draws in
// order, and a later fragment must be nearer. In the second round of two-phase culling it may also be as near as the first
// round's, whose depth stands in the depth buffer moved up by its last digit; then the smaller index takes the pixel.

#include "frame/blocks.glsl"
#include "frame/project.glsl"
#if FEATURE_CLIP_REGION
#include "regions/boundaries.glsl"
#endif
#if FEATURE_PER_PRIMITIVE
#define HANDED flat perprimitiveNV in
#else
#define HANDED flat in
#endif
#include "fiblets/raster/varyings.glsl"
#include "fiblets/raster/peel.glsl"
#if FEATURE_VALUES_STORED || FEATURE_VALUES_CURVATURE || FEATURE_VALUES_VOLUME
#include "fiblets/decode/sequential.glsl"
#include "fiblets/attributes/place.glsl"
#include "fiblets/attributes/values.glsl"
#endif

layout(location = 0) out uint shown_depth;
layout(location = 1) out uint shown_owner;
layout(location = 2) out uvec2 shown_ids;
layout(location = 3) out vec2 shown_position;
#if FEATURE_CROSS_LINE
#if FEATURE_TUBES
layout(location = 4) out uint shown_across;
#else
layout(location = 4) out float shown_across;
#endif
#endif

#if FEATURE_SECOND_ROUND
uniform usampler2D first_round;  // depth key and owner
#endif

const float NEARLY_ONE = 0.99999988;  // the largest depth drawn: that of an empty pixel is 1

// The per-point value; a segment that stands for a whole fiblet finds it step by step.
float value_at(uint segment, float t, float steps) {
    float at = t * steps, whole = floor(clamp(at, 0.0, max(steps - 1.0, 0.0)));
#if FEATURE_VALUES_STORED
    begin_values(handed_ids.z - chunk.y);
    return value_along(segment, t, uint(whole), at - whole);
#elif FEATURE_VALUES_CURVATURE
    if (steps > 1.0) {
        begin_values(handed_ids.z - chunk.y);
        return value_along(segment, t, uint(whole), at - whole);
    }
    return mix(handed_values.x, handed_values.y, at);  // a single point has one value, though its pixel is an end
#elif FEATURE_VALUES_VOLUME
    if (steps > 1.0) return value_along_capsule(handed_ids.z - chunk.y, steps, uint(whole), at - whole);
    return value_between(handed_values.x, handed_values.y, at);
#elif FEATURE_VALUES_ARC_LENGTH
    return mix(handed_values.x, handed_values.y, t);
#else
    return 0.0;
#endif
}

// s: position along the part in the window, where depth is linear; ratio: clip w at its start over that at its end.
void shade(float s, float ratio, float depth) {
    float z = clamp(depth, 0.0, NEARLY_ONE);
#if FEATURE_CLIP_REGION
    if (!region_keeps(ivec2(gl_FragCoord.xy), z)) discard;
#endif
    uint key = depth_key(z), segment = handed_ids.w & 255u;
    gl_FragDepth = float(key >> 1u) / 2147483648.0;  // as coarse as the key, also below 2^-8 where float32 is finer
#if FEATURE_SECOND_ROUND
    uvec2 before = texelFetch(first_round, ivec2(gl_FragCoord.xy), 0).xy;
    if (key == before.x && handed_ids.z > before.y) discard;
#endif
    float t = clamp(s * ratio / max(1.0 - s + s * ratio, 1e-30), 0.0, 1.0), steps = float((handed_ids.w >> 8u) & 255u);
#if FEATURE_PEEL
    begin_peel(handed_ids.x, handed_first);
#if FEATURE_WIDE_LINES && !FEATURE_TUBES
    peel_segment(handed_start.xy, handed_end.xy, viewport.z, steps);
#endif
    if (!behind_layers(ivec2(gl_FragCoord.xy), key) || !new_surface(ivec2(gl_FragCoord.xy), segment)) discard;
#endif
#if FEATURE_CLIPPING && !FEATURE_TUBES
    t = mix(float(handed_part & 0xFFFFu), float(handed_part >> 16u), t) / 65535.0;
#endif
    shown_depth = key;
    shown_owner = handed_ids.z;
    shown_ids = handed_ids.xy;
    shown_position = vec2(handed_first + float(segment) + t * steps, value_at(segment, t, steps));
}
