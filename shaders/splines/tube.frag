// A pixel of a spline tube: which segment its ray meets, where on it, and the depth there. All else is found once for each
// pixel of the picture, not for each fragment (splines/attributes.frag).
//
// Output
//   shown.x      segment
//   shown.y      bits 0-23: t of its half in 2^-24; 24: which half; 25, 26: kind of hit (splines/solver.glsl);
//                27-30: of a cut, the plane

#version 430

#include "frame/blocks.glsl"
#include "frame/clip_planes.glsl"
#include "splines/block.glsl"
#include "splines/ray.glsl"
#define HANDED flat in
#include "splines/handed.glsl"
#include "splines/across.glsl"
#include "splines/functions.glsl"
#if FEATURE_SPLINE_CHAIN
#include "splines/solver.glsl"
#else
#include "splines/quick.glsl"
#endif

layout(location = 0) out uvec2 shown;

void main() {
#if FEATURE_SPLINE_DISCARD
    discard;
#else
    Ray ray = ray_through(gl_FragCoord.xy, handed_centre.xyz, handed_centre.w, handed_seen);
    float first = -3e38, last = 3e38;
    narrow(ray.depth.x, ray.rise.x, first, last);
    narrow(ray.depth.y - ray.depth.x, ray.rise.y - ray.rise.x, first, last);
    narrow(ray.depth.y, ray.rise.y, first, last);
    bool cut = false;
    uint by = 0u;
#if FEATURE_CLIP_PLANES && FEATURE_SPLINE_CHAIN
    for (int plane = 0; plane < clip_count(); ++plane) {
        vec3 normal = clip_planes[plane].xyz;
        float height = clip_height_of(plane, handed_centre.xyz) / handed_centre.w + dot(normal, ray.o), before = first;
        narrow(height, dot(normal, ray.d), first, last);
        if (first > before) {
            cut = true;
            by = uint(plane);
        }
    }
#endif
    if (first > last) discard;
    vec3 y_axis, z_axis;
    across(ray.d, y_axis, z_axis);
    Found best = Found(last, 0.0, MISS);
    vec4 middle = 0.5 * (handed_a2 + handed_b2);
    uint half_hit = 0u;
    if ((handed_ids.y & 0x100u) != 0u) {
        meet_half(handed_a1, handed_a2, middle, ray.o, ray.d, y_axis, z_axis, first, cut,
                  bvec2((handed_ids.y & 1u) != 0u, true), best);
    }
    if ((handed_ids.y & 0x200u) != 0u) {
        float before = best.l;
        meet_half(middle, handed_b2, handed_b3, ray.o, ray.d, y_axis, z_axis, first, cut,
                  bvec2(true, (handed_ids.y & 2u) != 0u), best);
        if (best.l < before) half_hit = 1u;
    }
    if (best.kind == MISS) discard;
    float z = depth_along(ray, best.l);
    if (!(z >= 0.0 && z <= 1.0)) discard;
    gl_FragDepth = min(z, 0.99999988);       // that of an empty pixel is 1
    uint t = min(uint(clamp(best.t, 0.0, 1.0) * 16777216.0), 0xFFFFFFu);
    shown = uvec2(handed_ids.x, t | half_hit << 24u | uint(best.kind) << 25u | by << 27u);
#endif
}
