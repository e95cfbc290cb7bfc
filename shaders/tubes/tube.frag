// A pixel of a spline tube: which segment its ray meets, where on it, and the depth there. All else is found once for each
// pixel of the picture, not for each fragment (tubes/attributes.frag).
//
// Output
//   shown.x      segment
//   shown.y      bits 0-23: t of its half in 2^-24; 24: which half; 25, 26: kind of hit (tubes/solver.glsl);
//                27-30: of a cut, the plane, or REGION

#version 430

#include "frame/blocks.glsl"
#include "frame/clip_planes.glsl"
#include "tubes/block.glsl"
#include "tubes/segment.glsl"
#include "tubes/ray.glsl"
#define VARYING flat in
#include "tubes/varyings.glsl"
#include "tubes/orthonormal_basis.glsl"
#include "tubes/functions.glsl"
#if FEATURE_TUBE_CHAIN
#include "tubes/solver.glsl"
#else
#include "tubes/quick.glsl"
#endif
#if FEATURE_CLIP_REGION
#include "regions/boundaries.glsl"
#endif

layout(location = 0) out uvec2 shown;

const uint REGION = 15u;     // in place of a plane's number

#if FEATURE_CLIP_REGION
// Where on the ray a window depth is, within first..last.
float place_of_depth(Ray ray, float z, float first, float last) {
    float far = 1.0 - z, rise = ray.rise.x - far * ray.rise.y;
    if (z <= 0.0 || z >= 1.0 || rise == 0.0) return z >= 1.0 ? last : first;
    return clamp((far * ray.depth.y - ray.depth.x) / rise, first, last);
}
#endif

void main() {
#if FEATURE_TUBE_DISCARD
    discard;
#else
    Ray ray = ray_through(gl_FragCoord.xy, varying_centre.xyz, varying_centre.w,
                          Seen(varying_seen.xy, varying_seen.zw, varying_depth));
    float first = -3e38, last = 3e38;
    narrow(ray.depth.y - ray.depth.x, ray.rise.y - ray.rise.x, first, last);      // from the near plane
    narrow(ray.depth.x, ray.rise.x, first, last);                                 // to the far plane
    narrow(ray.depth.y, ray.rise.y, first, last);
    bool cut = false;
    uint by = 0u;
#if FEATURE_CLIP_PLANES && FEATURE_TUBE_CHAIN
    for (int plane = 0; plane < clip_plane_count; ++plane) {
        vec3 normal = clip_planes[plane].xyz;
        float height = clip_height_of(plane, varying_centre.xyz) / varying_centre.w + dot(normal, ray.o), before = first;
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
    vec4 k0 = in_ray_space(varying_a1, ray.o, ray.d, y_axis, z_axis), k1 = in_ray_space(varying_a2, ray.o, ray.d, y_axis, z_axis),
         k3 = in_ray_space(varying_b2, ray.o, ray.d, y_axis, z_axis), k4 = in_ray_space(varying_b3, ray.o, ray.d, y_axis, z_axis);
    vec4 k2 = 0.5 * (k1 + k3);
    bool in_first = (varying_ids.y & 0x100u) != 0u && may_meet(k0, k1, k2);
    bool in_second = (varying_ids.y & 0x200u) != 0u && may_meet(k2, k3, k4);
    uint half_hit = 0u;
    // One half after the other; but where the ray can meet only one, that one at once: neighbours then search together. The
    // loop is left at its end, as some processors go through all of a body that any of their lanes has entered.
    if (!in_first && !in_second) discard;
#if FEATURE_CLIP_REGION
    // What the region holds of the ray, stretch by stretch, until one shows something.
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float begin = first, end = last;
    bool plane_cut = cut;
    uint plane = by;
    for (int k = 0; best.kind == MISS; k += 2) {
        float enter = region_boundary(pixel, k);
        if (enter > 1.0) break;
        first = place_of_depth(ray, enter, begin, end);
        last = place_of_depth(ray, region_boundary(pixel, k + 1), begin, end);
        if (first > last || last <= begin) continue;
        cut = plane_cut || first > begin;
        by = first > begin ? REGION : plane;
        best.l = last;
#endif
    bool again = in_first && in_second;
    bool second = !in_first;
    for (;;) {
        float before = best.l;
        meet_half(second ? k2 : k0, second ? k3 : k1, second ? k4 : k2, first, cut,
                  bvec2(second || (varying_ids.y & 1u) != 0u, !second || (varying_ids.y & 2u) != 0u), best);
        if (best.l < before) half_hit = uint(second);
        if (!again) break;
        again = false;
        second = true;
    }
#if FEATURE_CLIP_REGION
    }
#endif
    if (best.kind == MISS) discard;
    float far = reversed_depth_along(ray, best.l);
    if (!(far > 0.0 && far <= 1.0)) discard;
    gl_FragDepth = far;                      // the other way round: float32 is fine where much of the picture is, far away
    uint t = min(uint(clamp(best.t, 0.0, 1.0) * 16777216.0), 0xFFFFFFu);
    shown = uvec2(varying_ids.x, t | half_hit << 24u | uint(best.kind) << 25u | by << 27u);
#endif
}
