// Adds what a fragment shows to one of its pixel's sums, where OpenGL blends: the attachments of
// pvfiblets/engine/fiblets/gather/gathering.py. A wide line or a tube adds once to a pixel (fiblets/compute/gather.comp).

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

// s: position along the part in the window, beyond 0..1 in a wide line's caps; t: along the segment, of so many steps.
void write_fragment(float s, uint key, uint segment, float t, float steps) {
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
