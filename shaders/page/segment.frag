// The nearest line of a pixel: the page's G-buffer, one texel of four words a pixel, with the depth beside it.
//
//   streamline, the layer in the upper four bits | tangent (frame/tangent.glsl) | edges (frame/edges.glsl) | value, as a float's bits, or a colour
//
// For wide translucent lines (sum.frag), the place along the line stands beside it.

#version 430

#include "page/segment_value.glsl"

layout(location = 0) out uvec4 out_texel;
#if FEATURE_WIDE_LINES && FEATURE_GATHER_SLICES
layout(location = 1) out uint out_place;
#endif

void write(float s, uint edges, float z) {
    float t = along_segment(s);
    out_texel = uvec4(seg_ids.x, packed_tangent(tangent_between(Tangents(seg_tangent, seg_tangent_to), t), 0u), edges, bits_at(t));
#if FEATURE_WIDE_LINES && FEATURE_GATHER_SLICES
    out_place = seg_place + uint(t * PLACE_STEPS);
#endif
}

#include "page/segment_pixels.glsl"
