// What a fiblet's record says (paper: Schertzer et al. 2022, section 3.2.2). The bit fields come from
// pvfiblets/codec/layout.py by way of "codec/layout.glsl", so that a shader cannot disagree with the encoder.
//
// `f` is an index within the chunk. A chunk holds whole pages, and at its end the anchor of the fiblet that follows.

#include "codec/layout.glsl"
#include "frame/blocks.glsl"

layout(std430, binding = 0) readonly buffer Anchors { uvec2 anchors[]; };
layout(std430, binding = 4) readonly buffer Pages { uvec4 pages[]; };  // x: rank, y: code, z: point of a page's first
#if FEATURE_RANK_TO_ID
// Streamlines by rank stand behind the pages, four a row.
uint id_of_rank(uint rank) {
    uint index = rank - chunk_bases.x;
    return pages[chunk_bases.z + (index >> 2)][index & 3u];
}
#endif
#if FEATURE_ANCHORS_LOW
layout(std430, binding = 6) readonly buffer AnchorsLow { uint anchors_low[]; };  // three uint16 a fiblet
uint anchor_low(uint index) { return bitfieldExtract(anchors_low[index >> 1], int(index & 1u) * 16, 16); }
#endif

float difference(uint a, uint b) { return a >= b ? float(a - b) : -float(b - a); }

// First point of fiblet f, in local millimetres.
vec3 anchor_local(uint f) {
    uvec2 words = anchors[f];
    uvec3 q = uvec3(fiblet_anchor_x(words), fiblet_anchor_y(words), fiblet_anchor_z(words));
#if FEATURE_ANCHORS_LOW
    q = (q << 16u) | uvec3(anchor_low(3u * f), anchor_low(3u * f + 1u), anchor_low(3u * f + 2u));
    vec3 d = vec3(difference(q.x, reference.x), difference(q.y, reference.y), difference(q.z, reference.z));
#else
    vec3 d = vec3(ivec3(q) - ivec3(reference.xyz));
#endif
    precise vec3 p = d * anchor_scale.xyz;
    return p;
}

uint rank_of(uint f) { return pages[f >> FIBLET_PAGE_BITS].x + fiblet_rank(anchors[f]); }
