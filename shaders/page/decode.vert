// Decodes a share of a fiblet, SHARE consecutive points, for transform feedback (paper: Schertzer et al. 2022, section 3.3.1). An
// invocation walks from the fiblet's anchor: of a full fiblet's three shares that is twice the steps of one walk, for no state
// that passes would have to hand on.
//
// Slots behind the last point hold where the line goes on, for the joints and tangents at the fiblet's end:
//
//   slot     0 .. last   last + 1                             last + 2
//            points      the next fiblet's first point;       one segment further, if the streamline goes on;
//                        of an end the last point again       of a single point the direction that it was reached by
//
// Of fiblets whose points fill their shares these are the next one's first slots (client/src/items.ts). 15 vectors are what every
// device gives to a vertex's outputs: 20 points.

#version 430

#include "fiblets/decode/sequential.glsl"
#include "fiblets/attributes/neighbours.glsl"

const uint SHARE = 20u;

layout(location = 0) in uvec2 item;    // fiblet, share

out vec4 o0; out vec4 o1; out vec4 o2; out vec4 o3; out vec4 o4; out vec4 o5; out vec4 o6; out vec4 o7;
out vec4 o8; out vec4 o9; out vec4 o10; out vec4 o11; out vec4 o12; out vec4 o13; out vec4 o14;

vec3 points[SHARE];

void main() {
    uint f = item.x, first = item.y * SHARE, stop = first + SHARE;
    walk_begin(f);
    uint last = walk.last;
    vec3 point = walk_point;
    if (first == 0u) points[0] = point;
    for (uint i = 1u; i <= min(last, stop - 1u); ++i) {
        walk_next(i);
        if (i >= first) points[i - first] = walk_point;
    }
    if (last + 1u < stop) {
        bool end = ends(f);
        vec3 next = end || f + 1u >= chunk_fiblets ? walk_point : anchor_local(f + 1u), after = next;
        if (!end) after = next + direction_after(f, false);
        else if (last == 0u && !begins(f) && f > 0u) {
            walk_begin(f - 1u);
            for (uint i = 1u; i <= walk.last; ++i) walk_next(i);
            after = next + (next - walk_point);
        }
        for (uint i = max(last + 1u, first); i < stop; ++i) points[i - first] = i == last + 1u ? next : after;
    }
    o0 = vec4(points[0], points[1].x);      o1 = vec4(points[1].yz, points[2].xy);    o2 = vec4(points[2].z, points[3]);
    o3 = vec4(points[4], points[5].x);      o4 = vec4(points[5].yz, points[6].xy);    o5 = vec4(points[6].z, points[7]);
    o6 = vec4(points[8], points[9].x);      o7 = vec4(points[9].yz, points[10].xy);   o8 = vec4(points[10].z, points[11]);
    o9 = vec4(points[12], points[13].x);    o10 = vec4(points[13].yz, points[14].xy); o11 = vec4(points[14].z, points[15]);
    o12 = vec4(points[16], points[17].x);   o13 = vec4(points[17].yz, points[18].xy); o14 = vec4(points[18].z, points[19]);
    gl_Position = vec4(0.0);
}
