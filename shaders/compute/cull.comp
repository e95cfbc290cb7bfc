// Frustum culling (paper: Schertzer et al. 2022, section 3.4.3, equation 5): a fiblet whose bounding sphere lies wholly
// outside one plane of the view volume cannot show. The paper dilates the volume by the sphere and tests a point; the
// signed distance to the planes of the model-view-projection does the same for perspective and for parallel views.
//
// Invariants
//   - Never culls a fiblet of which one pixel would be drawn. The sphere (`reach`, rounded up by the encoder) holds all
//     points and the joining segment; the planes stand half a line's width and the rounding of this very computation
//     further out (pvfiblets/engine/frame.py must agree).
//   - A fiblet of class 0 lies inside all planes, by `guard.z` and its sphere: its segments need no clipping. One of
//     class 1 lies so between the near and the far plane, hence in front of the camera. Class 2 are all others, and
//     those that the caller's planes may touch.
//
// One invocation per 32 fiblets. What it writes is the plan of the drawing passes: which fiblets were seen in the last
// picture (drawn first, so that most others lose at their first look at the depth image), and which need clipping.

#version 430
layout(local_size_x = {{ group_size }}) in;

#include "decode/record.glsl"
#include "frame/clip_planes.glsl"

layout(std430, binding = 2) readonly buffer Reach { uint reaches[]; };  // two uint16 a word
#include "compute/marks.glsl"

void main() {
    uint word = group_index() * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
    uint first = word * 32u;
    if (first >= chunk.x) return;
    uint shown = 0u, crossing = 0u, crossing_depth = 0u, count = min(32u, chunk.x - first);
    for (uint i = 0u; i < count; ++i) {
        uint f = first + i;
        vec3 centre = anchor_local(f);
        if (fiblet_end(anchors[f]) == 0u) centre = 0.5 * (centre + anchor_local(f + 1u));
        float radius = float(bitfieldExtract(reaches[f >> 1], int(f & 1u) * 16, 16)) * anchor_scale.w;
        float edges = dot(planes[0].xyz, centre) + planes[0].w;
        for (int side = 1; side < 4; ++side) edges = min(edges, dot(planes[side].xyz, centre) + planes[side].w);
        float depths = min(dot(planes[4].xyz, centre) + planes[4].w, dot(planes[5].xyz, centre) + planes[5].w);
#if FEATURE_CLIP_PLANES
        depths = min(depths, clip_height(centre) + clip_info.y);
        if (clip_touches(centre, radius)) crossing_depth |= 1u << i;
#endif
        if (min(edges, depths) >= -radius) shown |= 1u << i;
        if (edges < radius + guard.z) crossing |= 1u << i;
        if (depths < radius + guard.z) crossing_depth |= 1u << i;
    }
    word = ((chunk.y >> 5u) + word) * 8u;
    uint before = marks[word + SEEN];
    for (uint part = 0u; part < 6u; part += 3u) {
        uint these = shown & (part == 0u ? before : ~before);
        marks[word + part] = these & ~crossing & ~crossing_depth;
        marks[word + part + 1u] = these & crossing & ~crossing_depth;
        marks[word + part + 2u] = these & crossing_depth;
    }
    marks[word + CANDIDATES] = 0u;
    marks[word + SEEN] = 0u;
}
