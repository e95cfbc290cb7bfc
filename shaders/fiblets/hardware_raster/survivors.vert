// Vertex stage of the pipelines that OpenGL's rasteriser draws for (`tessellation`, `geometry`): decides which fiblets are
// drawn. There is no vertex data; a vertex stands for a fiblet, or for one of the shares that a fiblet is drawn in.
//
// Culling stands here and not in the stages that decode, because vertices fill the lanes of a GPU whatever becomes of
// them, and because those stages then are the same program with and without culling: no compiler can round a point of
// one picture otherwise than in another.

#version 430

#include "fiblets/hardware_raster/cull.glsl"
#if FEATURE_CLIPPING && !FEATURE_WIDE_LINES
#include "fiblets/compute/classes.glsl"
#endif

uniform uint shares;   // vertices per fiblet

flat out uint shown;   // 0: nothing; else one more than the vertex
#if FEATURE_CLIPPING && !FEATURE_WIDE_LINES
flat out uint uncut;   // whether none of its segments can be cut
#endif

void main() {
    uint vertex = uint(gl_VertexID);
    shown = survives(vertex / shares) ? vertex + 1u : 0u;
#if FEATURE_CLIPPING && !FEATURE_WIDE_LINES
    uint which = 2u;
    bool inside = shown != 0u && can_show(vertex / shares, capsule_of(vertex / shares), which) && (which == 0u || which == 3u);
    uncut = inside ? 1u : 0u;
#endif
    gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
}
