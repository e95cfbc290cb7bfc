// Adds what a fragment shows to one of its pixel's sums, where OpenGL blends: the attachments of
// pvfiblets/engine/fiblets/gather/gathering.py. A wide line or a tube adds once to a pixel (fiblets/compute/gather.comp).

#include "fiblets/gather/slices.glsl"
#if FEATURE_PAINTED
#include "fiblets/gather/paint.glsl"
#include "fiblets/attributes/tangent.glsl"
#include "fiblets/attributes/fragment_value.glsl"
#endif

layout(location = 0) out vec4 out_slice0;
#if FEATURE_GATHER_SLICES
layout(location = 1) out vec4 out_slice1;
layout(location = 2) out vec4 out_slice2;
layout(location = 3) out vec4 out_slice3;
#endif

// s: position along the part in the window, beyond 0..1 in a wide line's caps; ratio: clip w at its start over that at its end.
void write_fragment(float s, float ratio, uint key, uint segment) {
#if FEATURE_WIDE_LINES
    bool start = (varying_ids.y & 0x10000u) != 0u, cap = (varying_ids.y & 0x20000u) != 0u;
    if (s >= 1.0 && !cap || s <= 0.0 && !start) discard;
#endif
    int slice = slice_of(ivec2(gl_FragCoord.xy), key, varying_ids.x);
    if (slice < 0) discard;
#if FEATURE_PAINTED
    float t = clamp(s * ratio / max(1.0 - s + s * ratio, 1e-30), 0.0, 1.0);
#if FEATURE_CLIPPING && !FEATURE_TUBES
    t = mix(float(varying_part & 0xFFFFu), float(varying_part >> 16u), t) / 65535.0;
#endif
    float steps = float((varying_ids.y >> 8u) & 255u);
    vec4 adds = painted(varying_streamline, unpacked_tangent(varying_tangent), value_at(segment, t, steps));
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
