// The evaluation stage's segment, between two points of the patch (fiblets/tessellation/patch.glsl), and which of its ends it is at.

#include "frame/blocks.glsl"
#include "fiblets/tessellation/patch.glsl"
#include "fiblets/data/point_mask.glsl"

layout(isolines, equal_spacing) in;

in Half { HALF_POINT points[HALF]; } halves[];

patch in uvec4 patch_ids;
#if FEATURE_WIDE_LINES
patch in vec3 patch_beyond;
#endif
#if FEATURE_POINT_MASK
patch in uvec4 patch_mask;
#endif

vec3 point_of(uint i) { return halves[i / HALF].points[i % HALF].xyz; }

float value_of(uint i) {
#if FEATURE_VALUES_ARC_LENGTH || FEATURE_VALUES_VOLUME
    return halves[i / HALF].points[i % HALF].w;
#else
    return 0.0;
#endif
}

struct Segment {
    uint index;
    vec3 from;      // local mm
    vec3 to;
    float steps;
    bool start;
    bool cap;
    bool drawn;
};

bool at_start;      // of the segment; else at its end

// Of thin lines: where nothing is cut, one isoline leads through all points, and a vertex ends a segment; the first begins one. Else each
// segment is an isoline of its own, from the last to the first: of two with the same depth the later one stays, as
// in the compute pipeline. Of wide lines one isoline leads from the last point to the first, and a vertex begins a segment; the
// first ends one. So the geometry stage has the segments in that order.
Segment this_segment() {
    uint count = patch_ids.y & 255u;
#if FEATURE_WIDE_LINES
    uint point = count - min(uint(round(gl_TessCoord.x * float(count))), count), index = min(point, count - 1u);
    at_start = point < count;
#else
    bool one = (patch_ids.y & 0x40000u) != 0u;
    uint place = uint(round((one ? gl_TessCoord.x : gl_TessCoord.y) * float(count)));
    uint index = one ? max(place, 1u) - 1u : count - 1u - min(place, count - 1u);
    at_start = one ? place == 0u : gl_TessCoord.x < 0.5;
#endif
    bool start = index == 0u && (patch_ids.y & 0x10000u) != 0u, cap = index == count - 1u && (patch_ids.y & 0x20000u) != 0u;
#if FEATURE_POINT_MASK
    mask_low = patch_mask.x;
    mask_high = patch_mask.y;
    mask_segments = patch_mask.z;
    mask_before = (patch_mask.w & 1u) != 0u;
    mask_joined = (patch_mask.w & 2u) != 0u;
#endif
    bool drawn = mask_segment(index, start, cap);
    return Segment(index, point_of(index), point_of(index + 1u), float((patch_ids.y >> 8u) & 255u), start, cap, drawn);
}
