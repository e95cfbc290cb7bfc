// The edges (frame/edges.glsl) of a pixel of a line: for thin lines a band one pixel wide between the true ends of the
// segment, however its pixels were chosen; for wide lines the capsule's outline; for tubes their silhouette.

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
// The same of a tube thinner than a pixel. Where the line goes on, its segments do not end: of short ones a pixel shows the nearest to
// the eye, not the one beside it.
uint thin_tube_edges(Tube t, vec2 centre, vec2 run, float r) {
    float square = dot(run, run), foot = dot(centre, run) / max(square, 1e-12);
    foot = square > 1e-6 ? clamp(foot, t.start ? 0.0 : -1e6, t.cap ? 1.0 : 1e6) : clamp(foot, 0.0, 1.0);
    vec2 away = centre - foot * run;
    float size = length(away);
    vec2 n = size > 1e-4 ? away / size : vec2(-run.y, run.x) / max(length(run), 1e-6);
    return packed_edges(n, r - size, 2.0 * r, 0u);
}

// hit: what the pixel shows; c0, c1: homogeneous window coordinates of the segment's ends.
//
// The ray passes the axis nearer than r by what `beside`, the part of the normal across the ray, is shorter than 1; where the
// body is a cylinder, across the axis as well. Tubes thinner than a pixel are lines, drawn wider than their edges are apart.
uint tube_edges(Tube t, vec4 c0, vec4 c1, vec2 pixel, Hit hit) {
    vec3 d = normalize(tube_ray + tube_perspective * (pixel.x * tube_ray_x + pixel.y * tube_ray_y)), face = d;
    if (hit.t > 0.0 && hit.t < 1.0) {
        vec3 across = d - dot(d, t.axis) * t.axis;
        if (dot(across, across) > 1e-4) face = normalize(across);
    }
    vec3 beside = hit.normal - dot(hit.normal, face) * face;
    float share = length(beside);
    vec3 out_of = share > 1e-4 ? beside / share : normalize(tube_ray_x);
    vec3 at = hit.t * t.size * t.axis + tube_radius * hit.normal;
    vec2 way = vec2(dot(window_gradient(0), out_of), dot(window_gradient(1), out_of)) - pixel * dot(window_gradient(3), out_of);
    float pixels = length(way), r = tube_radius * pixels / max(c0.w + dot(window_gradient(3), at), 1e-30);
    Outline outline;
    if (r < half_line_width && outline_of(c0, c1, outline)) return thin_tube_edges(t, pixel - outline.a.xy, outline.b.xy - outline.a.xy, r);
    return packed_edges(pixels > 0.0 ? way / pixels : vec2(1.0, 0.0), (1.0 - share) * r, 2.0 * r, 0u);
}
#endif

#if !(FEATURE_TUBES || FEATURE_WIDE_LINES)
// Where in their pixels the ends of a segment lie, rounded so that pages find the same (shaders/page/segment_pixels.glsl).
vec4 parts_of(ClippedSegment piece) {
    vec4 at = vec4(in_picture(piece.a), in_picture(piece.b));
    return floor((at - floor(at)) * 256.0) / 256.0;
}

// first, last: pixels of the segment's ends; at: this one, from the first; parts: where in their pixels the ends lie. No branch: it
// would cost as much as all the rest.
uint thin_edges(ivec2 first, ivec2 last, vec2 at, vec4 parts, bool start, bool cap) {
    vec2 run = vec2(last - first), a = parts.xy - 0.5 - at, d = run + parts.zw - parts.xy;
    float square = dot(d, d), shrink = inversesqrt(max(square, 1e-6));
    vec2 along = square > 1e-6 ? d : vec2(1.0, 0.0);
    float left = (along.y * a.x - along.x * a.y) * shrink;      // of the axis the pixel lies
    bool turned = left < 0.0, begins = start && at == vec2(0.0), ends = cap && at == run;
    float stop = dot(along, begins ? a : a + d) * shrink;
    uint third = uint(int(2.5 + clamp(turned ? 3.0 * stop : -3.0 * stop, -1.0, 1.0)));
    uint end = begins && ends ? 7u : begins || ends ? (turned == ends ? third : third + 3u) : 0u;
    return packed_edges(turned ? vec2(along.y, -along.x) : vec2(-along.y, along.x), 0.5 - abs(left), 1.0, end);
}
#endif
