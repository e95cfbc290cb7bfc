// A square that faces the viewer around each point: four vertices, made from the point.
// Paper: Everts et al. 2009, section 3.5. The paper takes the window's axes back to the model to widen the square there; here
// its corners move along them in the window, as far as the width is there.

#version 430

#include "halos/vertices.glsl"
#include "halos/item.glsl"
#include "frame/clip_planes.glsl"
#define VARYING flat out
#include "halos/varyings.glsl"

#if FEATURE_HALO_FILTER
uniform samplerBuffer filter_texels;
#endif
#if FEATURE_HALO_SOME
uniform usamplerBuffer mask_texels;      // not 0 of points that the caller does not want
#endif

void main() {
    int point = item_of_vertex();
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    varying_item = 0u;
    varying_ends = varying_depths = vec4(0.0);
#if FEATURE_HALO_CUE
    varying_cue = vec2(0.0);
#endif
#if FEATURE_HALO_FILTER
    varying_filter = vec4(0.0);
#endif
    if (point >= halo_items) return;
#if FEATURE_HALO_SOME
    if (texelFetch(mask_texels, point).x != 0u) return;
#endif
    vec3 here = local_place(point);
    vec4 at = window_of(here);
    if (!(at.w > 0.0 && at.z >= 0.0 && at.z <= at.w)) return;
#if FEATURE_CLIP_PLANES
    if (clip_height(here) < 0.0) return;
#endif
    float cue = cue_at(here);
    vec2 centre = at.xy / at.w, corner = 2.0 * vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1 & 1)) - 1.0;
    gl_Position = vec4((centre + reaches(cue, at.w).y / at.w * corner) / half_picture, 0.0, 1.0);
    varying_item = uint(point);
    varying_ends = centre.xyxy;
    varying_depths = vec4(1.0 / at.w, 1.0 / at.w, at.z / at.w, at.z / at.w);
#if FEATURE_HALO_CUE
    varying_cue = vec2(cue);
#endif
#if FEATURE_HALO_FILTER
    varying_filter = vec4(vec2(texelFetch(filter_texels, point).x), 0.0, 0.0);
#endif
}
