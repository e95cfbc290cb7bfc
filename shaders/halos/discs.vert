// A square that faces the viewer around each point: four vertices, made from the point.
// Paper: Everts et al. 2009, section 3.5. The paper takes the window's axes back to the model to widen the square there; here
// its corners move along them in the window, as far as the width is there.

#version 430

#include "halos/vertices.glsl"
#include "halos/item.glsl"
#include "frame/clip_planes.glsl"
#define HANDED out
#include "halos/handed.glsl"

#if FEATURE_HALO_FILTER
uniform samplerBuffer filter_texels;
#endif
#if FEATURE_CLIP_PLANES
out gl_PerVertex {
    vec4 gl_Position;
    float gl_ClipDistance[{{ max_clip_planes }}];
};
#endif

void main() {
    int point = item_of_vertex();
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
    if (point >= halo_counts.x) return;
    vec2 corner = 2.0 * vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1 & 1)) - 1.0;
    vec3 here = local_place(point);
    vec4 at = window_of(here);
    if (at.w <= 0.0) return;
    vec2 reach = reaches(here, at.w);
    at.xy += reach.y * corner;
    gl_Position = vec4(at.xy / halo_mask.yz, 2.0 * at.z - at.w, at.w);
    handed_strip = vec4(corner.x, corner.y, 0.5, reach.x / reach.y);
    handed_item = uint(point);
#if FEATURE_HALO_FILTER
    handed_filter = vec2(texelFetch(filter_texels, point).x, 0.0);
#endif
#if FEATURE_CLIP_PLANES
    for (int plane = 0; plane < clip_count(); ++plane) gl_ClipDistance[plane] = clip_height_of(plane, here);
#endif
}
