// The edges (frame/edges.glsl) of a pixel of a line: of thin lines those of a line one pixel wide between the true ends of the
// segment, however its pixels were chosen; of wide lines those of the capsule; of tubes their silhouette.

#include "frame/edges.glsl"

#if FEATURE_TUBES || FEATURE_WIDE_LINES
// centre: the pixel's, from the segment's start; run: from there to its end; r: half the width.
uint capsule_edges(vec2 centre, vec2 run, float r) {
    vec2 away = centre - clamp(dot(centre, run) / max(dot(run, run), 1e-12), 0.0, 1.0) * run;
    float size = length(away);
    vec2 n = size > 1e-4 ? away / size : vec2(-run.y, run.x) / max(length(run), 1e-6);
    return packed_edges(n, r - size, 2.0 * r, 0u);
}
#endif

#if FEATURE_TUBES
// hit: what the pixel shows; c0, c1: homogeneous window coordinates of the segment's ends.
//
// The ray passes the axis nearer than r by what `beside`, the part of the normal across the ray, is shorter than 1; where the
// body is a cylinder, across the axis as well. Tubes thinner than a pixel are lines of that width.
uint tube_edges(Tube t, vec4 c0, vec4 c1, vec2 pixel, Hit hit) {
    vec3 d = normalize(tube_ray.xyz + tube.w * (pixel.x * tube_ray_x.xyz + pixel.y * tube_ray_y.xyz)), face = d;
    if (hit.t > 0.0 && hit.t < 1.0) {
        vec3 across = d - dot(d, t.axis) * t.axis;
        if (dot(across, across) > 1e-4) face = normalize(across);
    }
    vec3 beside = hit.normal - dot(hit.normal, face) * face;
    float share = length(beside);
    vec3 out_of = share > 1e-4 ? beside / share : normalize(tube_ray_x.xyz);
    vec3 at = hit.t * t.size * t.axis + tube.x * hit.normal;
    vec2 way = vec2(dot(window_gradient(0), out_of), dot(window_gradient(1), out_of)) - pixel * dot(window_gradient(3), out_of);
    float pixels = length(way), r = tube.x * pixels / max(c0.w + dot(window_gradient(3), at), 1e-30);
    Outline outline;
    if (r < viewport.z && outline_of(c0, c1, outline)) return capsule_edges(pixel - outline.a.xy, outline.b.xy - outline.a.xy, viewport.z);
    return packed_edges(pixels > 0.0 ? way / pixels : vec2(1.0, 0.0), (1.0 - share) * r, 2.0 * r, 0u);
}
#endif

#if !(FEATURE_TUBES || FEATURE_WIDE_LINES)
// Where in their pixels the ends of a segment lie, each of the four in 8 bits.
uint packed_parts(ClippedSegment piece) {
    vec4 at = vec4(in_picture(piece.a), in_picture(piece.b));
    uvec4 parts = uvec4((at - floor(at)) * 256.0);
    return parts.x | (parts.y << 8u) | (parts.z << 16u) | (parts.w << 24u);
}

// Ends that a picture's edge has cut off are none.
bool within_picture(vec2 at) { return all(greaterThan(at, vec2(0.05))) && all(lessThan(at, viewport.xy - 0.05)); }

// first, last: pixels of the segment's ends; at: this one, from the first; parts: as packed above.
uint thin_edges(ivec2 first, ivec2 last, vec2 at, uint parts, bool start, bool cap) {
    vec4 part = (vec4((uvec4(parts) >> uvec4(0u, 8u, 16u, 24u)) & 255u) + 0.5) / 256.0;
    vec2 run = vec2(last - first), a = part.xy - 0.5 - at, b = part.zw - 0.5 + run - at, d = b - a;
    float size = length(d);
    vec2 along = size > 1e-3 ? d / size : vec2(1.0, 0.0), n = vec2(-along.y, along.x);
    float side = -dot(n, a);
    if (side < 0.0) n = -n;
    bool begins = start && at == vec2(0.0) && within_picture(vec2(first) + part.xy);
    bool ends = cap && at == run && within_picture(vec2(last) + part.zw);
    uint end = 0u;
    if (begins && ends) end = 7u;
    else if (begins || ends) {
        vec2 s = vec2(-n.y, n.x), stop = begins ? a : b;
        bool up_to = (dot(s, along) > 0.0) == ends;
        end = uint(2 + int(clamp(round(3.0 * dot(s, stop)), -1.0, 1.0))) + (up_to ? 0u : 3u);
    }
    return packed_edges(n, 0.5 - abs(side), 1.0, end);
}
#endif
