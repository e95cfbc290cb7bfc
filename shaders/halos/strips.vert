// A strip that faces the viewer around each segment of a line: four vertices, made from the line's own.
// Paper: Everts et al. 2009, "Depth-Dependent Halos: Illustrative Rendering of Dense Line Data", section 3.2, equation (1).
//
// Symbols
//   D, V         direction of the line and of the view; the strip widens along V x D. In the window that is the direction across
//                (X_D W - X W_D, Y_D W - Y W_D), which is the same all along a segment, behind the eye as well
//   along        unit vector along a segment in the window
//
//            2 ------- 3       a corner's bits: 1 for the segment's end, 2 for its left side
//        a  -----------> b
//            0 ------- 1
//
// Algorithm
// The paper widens a vertex along the mean direction of its two segments, so that strips become thinner in bends. Here a strip
// is all that is within half its width of the line in the window, and four corners bound it. Those of neighbours meet where
// their edges do, on the bend's bisector; where a line turns by more than 60 degrees in the window, or runs at the viewer, both
// are lengthened by half a width instead. Lines end square. What lies before the near plane, beyond the far one, far beside the
// picture or beyond planes of the caller's is cut off the segment first: all that is handed on is finite, and exact to a
// fraction of a pixel. Where nothing of the data can lie there, there is no code for it (HALO_CUT).
//
// Both segments at a bend find its corners by the same sums of the same numbers, so that there are no holes between. Where a
// bend is so sharp for the width that its strip's corners cross, one of the two triangles is turned over, and not drawn.

#version 430

#include "halos/vertices.glsl"
#include "halos/item.glsl"
#include "frame/clip_planes.glsl"
#define VARYING flat out
#include "halos/varyings.glsl"
#include "halos/cut_strip.glsl"
#include "halos/strip_varyings.glsl"

const float SHARPEST = 0.5;    // cosine of the sharpest bend whose corners meet on the bisector
const float STEEPEST = 0.5;    // pixels by which half a strip widens per pixel along it, up to which they do

// A way in the window from a place whose window is p. xy: its direction; z: pixels by which half a strip widens per pixel.
vec3 course(vec4 p, vec3 way) {
    vec4 d = vec4(way, 0.0) * halo_window_rows;
    vec2 v = d.xy * p.w - p.xy * d.w;          // W W times the way on the screen
    float size = max(abs(v.x), abs(v.y));
    if (!(size > 0.0)) return vec3(0.0);
    v /= size;
    float straight = inversesqrt(dot(v, v));
    return vec3(v * straight, -(halo_line_reach + halo_border_reach) * d.w / size * straight);
}

void main() {
    int segment = item_of_vertex();
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    varying_item = 0u;
    varying_ends = varying_depths = vec4(0.0);
    clear_optional_varyings();
    if (segment >= halo_items || is_last(segment)) return;
    vec3 start = local_place(segment), stop = local_place(segment + 1), way = stop - start;
    vec4 a = window_of(start), b = window_of(stop);
    vec2 cue = vec2(cue_at(start), cue_at(stop));
    vec2 part = vec2(0.0, 1.0);
    vec4 first = a, last = b;
    if (!cut_strip(start, stop, a, b, cue, part, first, last)) return;
    if (min(first.w, last.w) <= 0.0) return;
    vec4 ends = vec4(first.xy / first.w, last.xy / last.w);

    int end = gl_VertexID & 1;
    float side = (gl_VertexID & 2) == 0 ? 1.0 : -1.0, forward = end == 0 ? 1.0 : -1.0;
    bool before = segment > 0 && !is_last(segment - 1), after = !is_last(segment + 1);      // segments that go on
    bvec2 free = bvec2(!before || part.x > 0.0, !after || part.y < 1.0);
    vec2 cut_cue = cut(cue.x, cue.y, part);
    vec2 widths = vec2(reaches(cut_cue.x, first.w).y / first.w, reaches(cut_cue.y, last.w).y / last.w);
    float width = end == 0 ? widths.x : widths.y, past = 0.0;
    vec4 here = end == 0 ? a : b;
    vec3 own = course(here, way);       // 0, and so no area, without length: neighbours' ends draw such a segment
    vec2 corner = vec2(own.y, -own.x);
    if (end == 0 ? !free.x : !free.y) {
        vec3 beside = local_place(segment + 3 * end - 1), next = course(here, forward * ((end == 0 ? start : stop) - beside));
        float straight = dot(own.xy, next.xy), steep = max(abs(own.z), abs(next.z));
        if (straight >= SHARPEST && steep <= STEEPEST) {
            // Where strips widen, their edges meet the bisector farther out.
            width /= 1.0 + straight - steep * sqrt(max(1.0 - straight * straight, 0.0));
            corner += vec2(next.y, -next.x);
        } else {
            past = width;
            width *= 1.0 + max(-forward * own.z, 0.0);
        }
    }
    if (abs(own.z) > STEEPEST) width = max(widths.x, widths.y);
    vec2 pixel = (end == 0 ? ends.xy : ends.zw) + width * side * corner - past * forward * own.xy;
    gl_Position = vec4(pixel / half_picture, 0.0, 1.0);

    varying_item = uint(segment) | (free.x ? FREE_START : 0u) | (free.y ? FREE_END : 0u);
    varying_ends = ends;
    varying_depths = vec4(1.0 / first.w, 1.0 / last.w, first.z / first.w, last.z / last.w);
    write_optional_varyings(segment, start, stop, part, cut_cue, before, after);
}
