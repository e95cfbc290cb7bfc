// All lines behind the nearest of a pixel, added up in slices by how far behind it they are: the page's counterpart of
// fiblets/hardware_raster/add_to_sums.glsl, of the same sums (pvfiblets/engine/fiblets/gather/gathering.py). What is opaque hides lines by
// the depth test.
//
// Symbols
//   c            1 - depth
//   d            distance along the view, (p + q c) / (r + s c) (fiblets/gather/slice_keys.frag)

#version 430

#include "page/segment_value.glsl"
#include "colour/rows.glsl"
#include "fiblets/gather/paint.glsl"

uniform highp usampler2D texels;       // of the nearest lines, as segment.frag leaves them
uniform highp sampler2D depths;
uniform vec4 slice_distances;          // p, q, r, s
uniform float slice_far;               // d of the far end
uniform vec3 slice_edges;
uniform float sum_unit;                // scale of the sums; less than 1 where sums are of half precision
#if FEATURE_WIDE_LINES && FEATURE_GATHER_SLICES
uniform highp usampler2D places;
const float WIDTHS = 2.0;
#endif

layout(location = 0) out vec4 out_slice0;
layout(location = 1) out vec4 out_slice1;
layout(location = 2) out vec4 out_slice2;
layout(location = 3) out vec4 out_slice3;

float distance_at(float z) {
    float c = 1.0 - z;
    return (slice_distances.x + slice_distances.y * c) / (slice_distances.z + slice_distances.w * c);
}

void write(float s, uint edges, float z) {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uint streamline = seg_ids.x & 0x0FFFFFFFu;
    float first = texelFetch(depths, pixel, 0).r, t = along_segment(s);
    bool same = (texelFetch(texels, pixel, 0).x & 0x0FFFFFFFu) == streamline;
#if FEATURE_WIDE_LINES
    // Once a pixel: by the segment beside it.
    if (s >= 1.0 && (seg_ids.y & 2u) == 0u || s <= 0.0 && (seg_ids.y & 1u) == 0u) discard;
#endif
#if FEATURE_WIDE_LINES && FEATURE_GATHER_SLICES
    if (same) {  // not what belongs to the nearest (fiblets/segments/peel.glsl)
        float from = float(int(seg_place - texelFetch(places, pixel, 0).x)) / PLACE_STEPS;
#if FEATURE_LINE_ENDS
        float reach = 0.0;
#else
        float reach = 2.0 * WIDTHS * half_line_width / max(length(seg_end.xy - seg_start.xy), 1e-3);
#endif
        if (max(from, -1.0 - from) <= reach) discard;
    }
#else
    if (same && abs(z - first) < 4e-7) discard;
#endif
    float near = distance_at(first), far = max(slice_far, near), d = distance_at(z);
    int slice = int(dot(vec3(greaterThanEqual(vec3(d - near), (far - near) * slice_edges)), vec3(1.0)));
    vec3 tangent = normalize(seg_tangent + seg_tangent_to + 1e-6);
    vec4 adds = sum_unit * painted(streamline, tangent, uintBitsToFloat(bits_at(t)));
    out_slice0 = slice == 0 ? adds : vec4(0.0);
    out_slice1 = slice == 1 ? adds : vec4(0.0);
    out_slice2 = slice == 2 ? adds : vec4(0.0);
    out_slice3 = slice == 3 ? adds : vec4(0.0);
}

#include "page/segment_pixels.glsl"
