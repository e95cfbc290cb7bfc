// Fills fiblets/hardware_raster/varyings.glsl for one vertex of the part of a segment that is drawn. TO(name) is where a variable is handed
// over: itself, or with a mesh stage an element of an array.

#include "fiblets/segments/clipped_segment.glsl"
#include "fiblets/segments/joint.glsl"
#if FEATURE_PAINTED
#include "codec/layout.glsl"
#include "frame/tangent.glsl"
#include "fiblets/gather/run.glsl"
#endif
#ifndef VARYING
#define VARYING flat out
#define TO(name) name
#endif
#include "fiblets/hardware_raster/varyings.glsl"

struct Varyings {
    uint streamline;
    uint owner;     // fiblet counted over all chunks
    float first;    // index of its first point within the streamline
    uint segment;
    float steps;    // from point to point that the segment stands for
    vec2 values;    // per-point value at its ends, where colours that are added up read it and fragments do not look it up
    vec3 ahead;     // of wide lines and tubes: fiblets/segments/joint.glsl
};

void write_varyings(Varyings varyings, ClippedSegment piece, vec3 from, vec3 to) {
    uint flags = varyings.segment | (uint(varyings.steps) << 8u) | (piece.start ? 0x10000u : 0u) | (piece.cap ? 0x20000u : 0u);
    TO(varying_ids) = uvec2(varyings.owner, flags);
#if FEATURE_TUBES
    TO(varying_from) = from;
    TO(varying_to) = to;
#if FEATURE_CLIP_REGION
    TO(varying_ahead) = piece.cap ? vec3(0.0) : varyings.ahead;
#endif
#else
#if FEATURE_WIDE_LINES
    TO(varying_start) = piece.a;
    TO(varying_end) = piece.b;
    TO(varying_onward) = packed_onward(piece.cap ? vec2(0.0) : onward_at(piece.b, varyings.ahead));
#else
    uvec2 p = uvec2(pixel_of(piece.a)), q = uvec2(pixel_of(piece.b));
    TO(varying_cells) = uvec2(p.x | (p.y << 16u), q.x | (q.y << 16u));
    TO(varying_depths) = vec2(piece.a.z, piece.b.z);
#endif
#if FEATURE_WIDE_LINES && FEATURE_CLIP_PLANES
    TO(varying_from) = mix(from, to, piece.t0);
    TO(varying_to) = mix(from, to, piece.t1);
#endif
#endif
#if FEATURE_PAINTED || FEATURE_WIDE_LINES && (FEATURE_PEEL || FEATURE_GATHER_SLICES)
    TO(varying_streamline) = varyings.streamline;
#endif
#if FEATURE_WIDE_LINES && (FEATURE_PEEL || FEATURE_GATHER_SLICES)
    TO(varying_first) = varyings.first;
#endif
#if FEATURE_PAINTED
    TO(varying_tangent) = packed_tangent(run_direction(to - from), 0u);
#if !FEATURE_WIDE_LINES
    TO(varying_ratio) = piece.a.w / piece.b.w;
#endif
#if FEATURE_CLIPPING && !FEATURE_TUBES
    TO(varying_part) = uint(ceil(65535.0 * piece.t0)) | (uint(65535.0 * piece.t1) << 16u);
#endif
#if FEATURE_VALUES_ARC_LENGTH || FEATURE_VALUES_VOLUME
    TO(varying_values) = varyings.values;
#endif
#endif
}
