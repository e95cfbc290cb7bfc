// Decodes a share of a fiblet, up to SHARE consecutive points, for transform feedback (paper: Schertzer et al. 2022, section
// 3.3.1): a point in local mm, and the line's tangent there. An invocation walks from the fiblet's anchor: of a full fiblet's
// four shares that is 2.5 times the steps of one walk, for no state that passes would have to hand on.
//
// Slots behind the last point hold where the line goes on, for the joints and the segment at the fiblet's end:
//
//   slot     0 .. last   last + 1                             last + 2
//            points      the next fiblet's first point;       one segment further, if the streamline goes on
//                        of an end the last point again
//
// Of fiblets whose points fill their shares these are the next one's first slots (client/src/fiblets.ts). 15 vectors are what
// every device gives to a vertex's outputs: 15 points.

#version 430

#include "fiblets/decode/sequential.glsl"
#include "fiblets/attributes/neighbours.glsl"
#include "fiblets/attributes/tangent.glsl"

layout(location = 0) in uvec2 item;    // fiblet, share
uniform uint share_size;

flat out uvec4 o0; flat out uvec4 o1; flat out uvec4 o2; flat out uvec4 o3; flat out uvec4 o4; flat out uvec4 o5;
flat out uvec4 o6; flat out uvec4 o7; flat out uvec4 o8; flat out uvec4 o9; flat out uvec4 o10; flat out uvec4 o11;
flat out uvec4 o12; flat out uvec4 o13; flat out uvec4 o14;

uvec4 slots[15];

uvec4 slot(vec3 point, vec3 tangent) { return uvec4(floatBitsToUint(point), packed_tangent(tangent, 0u)); }

void main() {
    uint f = item.x, first = item.y * share_size, stop = first + share_size;
    bool end = ends(f);
    walk_begin(f);
    uint last = walk.last;
    vec3 point = walk_point, next = end || f + 1u >= chunk_fiblets ? vec3(0.0) : anchor_local(f + 1u), before = vec3(0.0), tangent;
    for (uint i = 0u; i <= min(last, stop - 1u); ++i) {
        vec3 here = point, run;
        if (i < last) {
            walk_next(i + 1u);
            run = walk_delta;
            point = walk_point;
        } else run = end ? vec3(0.0) : next - here;
        vec3 along = unit_or_none(run);
        tangent = i == 0u ? along : mean_direction(before, along);
        if (i >= first) slots[i - first] = slot(here, tangent);
        if (along != vec3(0.0)) before = along;
    }
    if (last + 1u < stop) {
        vec3 beyond = vec3(0.0);
        if (end) next = point;
        else beyond = direction_after(f, false);
        if (end && last == 0u && !begins(f) && f > 0u) {
            walk_begin(f - 1u);
            for (uint i = 1u; i <= walk.last; ++i) walk_next(i);
            tangent = unit_or_none(next - walk_point);
            if (first == 0u) slots[0] = slot(next, tangent);
        } else if (beyond != vec3(0.0)) tangent = unit_or_none(beyond);
        for (uint i = max(last + 1u, first); i < stop; ++i) slots[i - first] = slot(i == last + 1u ? next : next + beyond, tangent);
    }
    o0 = slots[0]; o1 = slots[1]; o2 = slots[2]; o3 = slots[3]; o4 = slots[4]; o5 = slots[5]; o6 = slots[6]; o7 = slots[7];
    o8 = slots[8]; o9 = slots[9]; o10 = slots[10]; o11 = slots[11]; o12 = slots[12]; o13 = slots[13]; o14 = slots[14];
    gl_Position = vec4(0.0);
}
