// The evaluation stage's segment, between two points of the patch (fiblets/tessellation/patch.glsl), and which of its ends it is at.

#include "frame/blocks.glsl"
#include "fiblets/tessellation/patch.glsl"
#include "codec/layout.glsl"
#include "fiblets/attributes/tangent.glsl"
#include "fiblets/data/point_mask.glsl"

layout(isolines, equal_spacing) in;

in Half { vec4 points[HALF]; } halves[];

patch in uvec4 patch_ids;
patch in float patch_first;
patch in uvec2 patch_around;
#if FEATURE_WIDE_LINES
patch in vec3 patch_beyond;
#endif
#if FEATURE_POINT_MASK
patch in uvec4 patch_mask;
#endif

vec4 point_of(uint i) { return halves[i / HALF].points[i % HALF]; }

struct Segment {
    uint index;
    vec4 from;      // local mm; w: per-point value
    vec4 to;
    uvec2 tangents; // at its start and end
    float steps;
    bool start;
    bool cap;
    bool drawn;
};

bool at_start;      // of the segment; else at its end

vec3 around(uint word) { return word == NO_DIRECTION ? vec3(0.0) : unpacked_tangent(word); }

vec3 delta_of(uint segment) { return point_of(segment + 1u).xyz - point_of(segment).xyz; }

uvec2 tangents_of_segment(uint segment, uint count) {
    vec3 before = around(patch_around.x), after = segment + 1u == count ? around(patch_around.y) : delta_of(segment + 1u);
    for (uint i = segment; i > 0u; --i) {
        before = delta_of(i - 1u);
        if (before != vec3(0.0)) break;
    }
    bool leads = segment + 1u == count && (patch_ids.w & 4u) == 0u;
    return packed_tangents(tangents_of(unit_or_none(before), unit_or_none(delta_of(segment)), unit_or_none(after), leads));
}

// Where segments are never cut, one isoline leads through all points, and a vertex ends a segment; the first begins one.
// Else each segment is an isoline of its own, from the last to the first: of two with the same depth the later one stays, as
// in the compute pipeline.
Segment this_segment() {
    uint count = patch_ids.z & 255u;
#if FEATURE_CLIPPING || FEATURE_WIDE_LINES
    uint index = count - 1u - min(uint(round(gl_TessCoord.y * float(count))), count - 1u);
    at_start = gl_TessCoord.x < 0.5;
#else
    uint point = uint(round(gl_TessCoord.x * float(count))), index = max(point, 1u) - 1u;
    at_start = point == 0u;
#endif
    bool start = index == 0u && (patch_ids.w & 1u) != 0u, cap = index == count - 1u && (patch_ids.w & 2u) != 0u;
#if FEATURE_POINT_MASK
    mask_low = patch_mask.x;
    mask_high = patch_mask.y;
    mask_segments = patch_mask.z;
    mask_before = (patch_mask.w & 1u) != 0u;
    mask_joined = (patch_mask.w & 2u) != 0u;
#endif
    bool drawn = mask_segment(index, start, cap);
    return Segment(index, point_of(index), point_of(index + 1u), tangents_of_segment(index, count),
                   float(patch_ids.z >> 8u), start, cap, drawn);
}
