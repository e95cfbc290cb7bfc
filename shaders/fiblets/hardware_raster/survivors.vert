// Vertex stage of the pipelines that OpenGL's rasteriser draws for (`tessellation`, `geometry`): decides which fiblets are
// drawn. There is no vertex data; a vertex stands for a fiblet, or for one of the shares that a fiblet is drawn in.
//
// Culling stands here and not in the stages that decode, because vertices fill the lanes of a GPU whatever becomes of
// them, and because those stages then are the same program with and without culling: no compiler can round a point of
// one picture otherwise than in another.

#version 430

#include "fiblets/hardware_raster/cull.glsl"

uniform uint shares;   // vertices per fiblet

flat out uint shown;   // 0: nothing; else one more than the vertex

void main() {
    uint vertex = uint(gl_VertexID);
    shown = survives(vertex / shares) ? vertex + 1u : 0u;
    gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
}
