// A strip that faces the viewer around each segment of a line: four vertices, made from the line's own.
// Paper: Everts et al. 2009, "Depth-Dependent Halos: Illustrative Rendering of Dense Line Data", section 3.2, equation (1).
//
// Symbols
//   D, V         direction of the line and of the view; the strip widens along V x D. In the window that is the direction across
//                (X_D W - X W_D, Y_D W - Y W_D), which is the same all along a segment, behind the eye as well
//   n            unit vector across a segment in the window, to its left
//
//                 n      a corner's bits: 1 for the segment's end, 2 for its right side
//            0 ---^--- 1
//        a  ------|------> b
//            2 ------- 3
//
// Algorithm
// The paper widens a vertex along the mean direction of its two segments. Here its corners lie where the edges of the two meet
// in the window, so that strips keep their width in bends. Where a line turns by more than 60 degrees in the window, runs at
// the viewer or stands still, both strips end in half discs around the vertex instead: they are lengthened by half a width,
// and fragments know how far beyond the vertex they are.

#version 430

#include "halos/vertices.glsl"
#include "halos/item.glsl"
#include "frame/clip_planes.glsl"
#define HANDED out
#include "halos/handed.glsl"

#if FEATURE_HALO_FILTER
uniform samplerBuffer filter_texels;

// How much the number changes per mm along a segment; x: that, y: 1, or both 0 where it is not known.
vec2 slope(float from, float to, vec3 way) {
    float s = abs(to - from) / length(way);
    return s < 3e38 ? vec2(s, 1.0) : vec2(0.0);
}
#endif
#if FEATURE_CLIP_PLANES
out gl_PerVertex {
    vec4 gl_Position;
    float gl_ClipDistance[{{ max_clip_planes }}];
};
#endif

vec2 unit(vec2 v) {
    float size = max(abs(v.x), abs(v.y));
    return size > 0.0 ? normalize(v / size) : vec2(0.0);
}

// Across the window by the way from a place whose window is p: the direction times W, times the length on the screen.
vec2 turn(vec4 p, vec3 way) {
    vec4 d = vec4(way, 0.0) * halo_rows;
    return d.xy * p.w - p.xy * d.w;
}

void main() {
    int segment = item_of_vertex();
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    handed_strip = vec4(0.0);
    handed_item = 0u;
    handed_length = 0.0;
#if FEATURE_HALO_FILTER
    handed_filter = vec2(0.0);
#endif
#if FEATURE_CLIP_PLANES
    for (int plane = 0; plane < {{ max_clip_planes }}; ++plane) gl_ClipDistance[plane] = 0.0;
#endif
    if (segment >= halo_counts.x || is_last(segment)) return;
    int end = gl_VertexID & 1, vertex = segment + end;
    float side = (gl_VertexID & 2) == 0 ? 1.0 : -1.0;
    bool alone = end == 0 ? segment == 0 || is_last(segment - 1) : is_last(vertex);       // no segment beyond this vertex
    int beyond = alone ? vertex : segment + 3 * end - 1;
    vec3 here = local_place(vertex), other = local_place(segment + 1 - end), next = local_place(beyond);
    vec4 at = window_of(here), there = window_of(other);
    vec2 reach = reaches(here, at.w), reach_there = reaches(other, there.w);
    float forward = end == 0 ? 1.0 : -1.0;
    vec2 own = turn(at, forward * (other - here)), along = unit(own), along_next = unit(turn(at, forward * (here - next)));

    bool seen = at.w > 0.0 && there.w > 0.0;
    float span = seen ? length(own) / (inversesqrt(at.w * there.w) * at.w * there.w) / (0.5 * (reach.y + reach_there.y)) : 1e6;
    if (span == 0.0) return;           // its neighbours end in half discs, which are all there is to see
    float straight = dot(along, along_next);
    vec2 corner = vec2(-along.y, along.x);
    float past = 0.0;
    if (!alone && straight >= 0.5) corner = (corner + vec2(-along_next.y, along_next.x)) / (1.0 + straight);
    else if (!alone && seen) past = 1.0;
    corner = side * corner - past * forward * along;
    at.xy += reach.y * corner;
    gl_Position = vec4(at.xy / halo_mask.yz, 2.0 * at.z - at.w, at.w);
    float place = float(texelFetch(mask_texels, vertex).x) / float(LAST);
    handed_strip = vec4(side, end == 0 ? -past : span + past, place, reach.x / reach.y);
    handed_item = uint(segment);
    handed_length = span;
#if FEATURE_HALO_FILTER
    float a = texelFetch(filter_texels, vertex).x;
    vec2 slopes = slope(a, texelFetch(filter_texels, segment + 1 - end).x, other - here);
    if (!alone) slopes += slope(a, texelFetch(filter_texels, beyond).x, next - here);
    handed_filter = vec2(a, slopes.x / max(slopes.y, 1.0));
#endif
#if FEATURE_CLIP_PLANES
    for (int plane = 0; plane < clip_count(); ++plane) gl_ClipDistance[plane] = clip_height_of(plane, here);
#endif
}
