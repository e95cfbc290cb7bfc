// Frustum culling (paper: Schertzer et al. 2022, section 3.4.3, equation 5): a fiblet whose bounding sphere lies wholly
// outside one plane of the view volume cannot show. The paper dilates the volume by the sphere and tests a point; the
// signed distance to the planes of the model-view-projection does the same for perspective and for parallel views.
//
// Invariant: never culls a fiblet of which one pixel would be drawn. The sphere (`reach`, rounded up by the encoder)
// holds all points and the joining segment; the planes stand half a line's width and the rounding of this very
// computation further out (pvfiblets/engine/frame.py must agree).
//
// One invocation per 32 fiblets: it writes their word of `shown` and clears their word of `candidates`.

#version 430
layout(local_size_x = {{ group_size }}) in;

#include "decode/record.glsl"

layout(std430, binding = 5) readonly buffer Reach { uint reaches[]; };  // two uint16 a word
layout(std430, binding = 6) writeonly buffer Shown { uint shown[]; };
layout(std430, binding = 7) writeonly buffer Candidates { uint candidates[]; };

bool may_show(uint f) {
    vec3 centre = anchor_local(f);
    if (fiblet_end(anchors[f]) == 0u) centre = 0.5 * (centre + anchor_local(f + 1u));
    float radius = float(bitfieldExtract(reaches[f >> 1], int(f & 1u) * 16, 16)) * anchor_scale.w;
    for (int i = 0; i < 6; ++i) if (dot(planes[i].xyz, centre) + planes[i].w < -radius) return false;
    return true;
}

void main() {
    uint word = group_index() * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
    uint first = word * 32u;
    if (first >= chunk.x) return;
    uint bits = 0u, count = min(32u, chunk.x - first);
    for (uint i = 0u; i < count; ++i) if (may_show(first + i)) bits |= 1u << i;
    shown[word] = bits;
    candidates[word] = 0u;
}
