// Measures fiblets (fiblets/attributes/measure.glsl) where there are no compute shaders: one vertex per fiblet of a batch, taken back
// by transform feedback.

#version 430

#include "fiblets/attributes/measure.glsl"

uniform uint batch_first;

out vec4 first;
out vec4 joint;
out vec4 turns;

void main() {
    Measure m = measure_of(batch_first + uint(gl_VertexID));
    first = m.first;
    joint = m.joint;
    turns = m.turns;
}
