// What each pixel shows of the segment that won it: the textures of pvfiblets/engine/gbuffer.py.
// Paper: Russig et al. 2020, section 3.2, "Shading": the normal is that of the sphere at t.
//
// Pixels that show nothing do not come here (screen/near.vert).
//
// The ray and the half are made once more, for the pixel's own segment; t is known. Of a cut, t is that whose sphere holds the
// cut's point deepest: looked for among sixteen, then between the neighbours of the best.

#version 430

#include "frame/blocks.glsl"
#include "frame/clip_planes.glsl"
#include "tubes/segment.glsl"
#include "tubes/ray.glsl"
#include "codec/layout.glsl"
#include "frame/tangent.glsl"
#include "tubes/node_values.glsl"
#if FEATURE_EDGES
#include "frame/pixel_derivative.glsl"
#include "frame/edges.glsl"
#endif

uniform usampler2D hits;
#if FEATURE_CLIP_REGION
uniform sampler2D depths;
#endif

const uint REGION = 15u;     // of tubes/tube.frag

layout(location = 0) out uint out_depth;
layout(location = 1) out uint out_owner;
layout(location = 2) out uvec2 out_ids;
layout(location = 3) out vec2 out_position;
layout(location = 4) out uint out_normal;
#if FEATURE_TUBE_COLOURS
layout(location = 5) out vec4 out_colour;
#endif
#if FEATURE_EDGES && FEATURE_TUBE_COLOURS
layout(location = 6) out uint out_edges;
#elif FEATURE_EDGES
layout(location = 5) out uint out_edges;
#endif

float inside(vec4 p0, vec4 p1, vec4 p2, vec3 at, float t) {
    vec4 p = quadratic(p0, p1, p2, t);
    return distance(p.xyz, at) - p.w;
}

float deepest(vec4 p0, vec4 p1, vec4 p2, vec3 at) {
    int best = 0;
    float least = 3e38;
    for (int k = 0; k <= 16; ++k) {
        float depth = inside(p0, p1, p2, at, float(k) / 16.0);
        if (depth < least) {
            least = depth;
            best = k;
        }
    }
    float lo = max(float(best - 1) / 16.0, 0.0), hi = min(float(best + 1) / 16.0, 1.0);
    for (int k = 0; k < 12; ++k) {
        float a = mix(lo, hi, 0.382), b = mix(lo, hi, 0.618);
        if (inside(p0, p1, p2, at, a) < inside(p0, p1, p2, at, b)) hi = b;
        else lo = a;
    }
    return 0.5 * (lo + hi);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uvec2 hit = texelFetch(hits, pixel, 0).xy;
    Segment s = segment_of(int(hit.x));
    bool second = (hit.y >> 24u & 1u) != 0u;
    uint kind = hit.y >> 25u & 3u;
    vec4 p0 = second ? junction(s) : s.a1, p1 = second ? s.b2 : s.a2, p2 = second ? s.b3 : junction(s);
    Seen seen = seen_centre(s);
    Ray ray = ray_through(gl_FragCoord.xy, s.centre, s.size, seen);
    float t = (float(hit.y & 0xFFFFFFu) + 0.5) / 16777216.0;
    vec3 normal = -ray.d;
    float l = 0.0;
#if FEATURE_CLIP_REGION
    if (kind == 3u && hit.y >> 27u == REGION) {
        // Of a region only its depth is known here: its face is lit as one that faces the viewer.
        float far = texelFetch(depths, pixel, 0).x;
        l = (far * ray.depth.y - ray.depth.x) / (ray.rise.x - far * ray.rise.y);
        t = deepest(p0, p1, p2, ray.o + l * ray.d);
    }
#endif
#if FEATURE_CLIP_PLANES
    if (kind == 3u && hit.y >> 27u != REGION) {
        vec3 plane = clip_planes[hit.y >> 27u].xyz;
        float height = clip_height_of(int(hit.y >> 27u), s.centre) / s.size + dot(plane, ray.o);
        l = -height / dot(plane, ray.d);
        t = deepest(p0, p1, p2, ray.o + l * ray.d);
        normal = -plane;
    }
#endif
    vec4 p = quadratic(p0, p1, p2, t);
    vec3 tangent = mix(p1.xyz - p0.xyz, p2.xyz - p1.xyz, t);
    if (dot(tangent, tangent) < 1e-16) tangent = p2.xyz - p0.xyz;
    if (dot(tangent, tangent) < 1e-16) tangent = s.b3.xyz - s.a1.xyz;
    if (kind != 3u) {
        vec3 v = ray.o - p.xyz;
        float along = dot(ray.d, v);
        vec3 beside = v - along * ray.d;                           // from the axis to the ray, across it
        float s2 = sqrt(max(p.w * p.w - dot(beside, beside), 0.0));
        l = -along + (kind == 2u ? s2 : -s2);
        vec3 out_of = beside + (kind == 2u ? s2 : -s2) * ray.d;    // to the point that shows: r long
        float r = length(out_of);
        if (r > 0.0) normal = out_of / r;
        if (kind == 2u) normal = -normal;                          // the wall from inside
#if FEATURE_EDGES
        // The silhouette is where the ray passes the axis as far away as the sphere is wide.
        // Beside a tube that is slanted to the view the nearest sphere's middle lies farther along it, by its slope; farther
        // still only at its round ends.
        vec3 onward = normalize(tangent), aside = cross(ray.d, onward);
        float slope = dot(ray.d, onward), flat_on = length(aside), off = dot(beside, aside) / max(flat_on, 1e-6);
        float ahead = sqrt(max(dot(beside, beside) - off * off, 0.0)), least = abs(slope) * sqrt(max(p.w * p.w - off * off, 0.0));
        if (flat_on > 0.1 && ahead < least + 0.1 * p.w) beside = (abs(off) > 1e-3 * p.w ? off : 1e-3 * p.w) / flat_on * aside;
        float passed = length(beside);
        vec3 outwards = passed > 1e-4 * p.w ? beside / passed : normalize(tube_ray_x);
        vec2 way = vec2(dot(window_gradient(0), outwards), dot(window_gradient(1), outwards))
                 - gl_FragCoord.xy * dot(window_gradient(3), outwards);
        float pixels = length(way), per_size = pixels * s.size / max(ray.depth.y + l * ray.rise.y, 1e-30);
        float own = p.w;
        if (tube_own_least_over_w < tube_least_over_w) {
            vec4 by = widened_by(int(hit.x), s);
            float middle = 0.5 * (by.y + by.z);
            own -= quadratic(vec4(second ? middle : by.x), vec4(second ? by.z : by.y), vec4(second ? by.w : middle), t).x;
        }
        out_edges = packed_edges(pixels > 0.0 ? way / pixels : vec2(1.0, 0.0), (own - passed) * per_size, 2.0 * own * per_size, 0u);
#endif
    }
#if FEATURE_EDGES
    else out_edges = packed_edges(vec2(1.0, 0.0), 4.0, 8.0, 0u);      // within a cut
#endif
    out_depth = key_along(ray, s, seen, l);
    out_owner = hit.x;
    out_ids = uvec2(s.ids.x, packed_tangent(tangent, 0u));
    out_position.x = 0.5 * (t + (second ? 1.0 : 0.0));
    out_normal = packed_direction(normal);
    Nodes nodes = nodes_of(hit.x, s, second, t);
    out_position.y = value_of(nodes);
#if FEATURE_TUBE_COLOURS
    out_colour = colour_of(nodes);
#endif
}
