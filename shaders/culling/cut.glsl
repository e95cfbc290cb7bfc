// How something lies to the caller's region, if there is one, and to the caller's planes (frame/clip_planes.glsl): of a capsule, all points
// within r of the segment a b in local millimetres.

#include "frame/clip_planes.glsl"
#if FEATURE_CLIP_REGION
#include "regions/classify.glsl"

// 1: wholly within the region, 0: undecided, -1: wholly outside; with the brushes of lines in a capsule whose bodies reach `ball` from its middle.
int region_of_lines(vec3 a, vec3 b, float r, float ball) {
    vec3 middle = 0.5 * (a + b);
    float w = window_from_local[3].w + ball * w_per_mm;
    w += window_from_local[0].w * middle.x + window_from_local[1].w * middle.y + window_from_local[2].w * middle.z;
    return region_of_capsule(a, b, r + max(w, 0.0) * line_reach);
}
#endif
