// Vertices of lines or points with halos, as pvfiblets/engine/halos/vertices.py stores them.

#include "frame/blocks.glsl"
#include "halos/block.glsl"

uniform usamplerBuffer place_texels;     // three integers of each vertex
#if !FEATURE_HALO_POINTS
uniform usamplerBuffer mask_texels;      // u of each vertex, times LAST; no other than a line's last one has LAST
const uint LAST = 65535u;

bool is_last(int vertex) { return texelFetch(mask_texels, vertex).x == LAST; }
#endif

vec3 local_place(int vertex) {
    int at = 3 * vertex;
    ivec3 place = ivec3(uvec3(texelFetch(place_texels, at).x, texelFetch(place_texels, at + 1).x,
                              texelFetch(place_texels, at + 2).x));
    return vec3(place - ivec3(reference)) * halo_place_scale;
}

vec4 window_of(vec3 p) { return vec4(p, 1.0) * halo_window_rows; }

// Share by which depth cueing makes a line narrower at a place.
float cue_at(vec3 p) {
#if FEATURE_HALO_CUE
    return clamp(dot(halo_cue.xyz, p) + halo_cue.w, 0.0, halo_cue_most);
#else
    return 0.0;
#endif
}

#include "halos/widths.glsl"
