// Measures fiblets (fiblets/attributes/measure.glsl) where there are no compute shaders: one vertex per fiblet of a batch, taken back
// by transform feedback.

#version 430

#include "fiblets/attributes/measure.glsl"

uniform uint batch_first;

out float fiblet_length;

void main() { fiblet_length = length_of(batch_first + uint(gl_VertexID)); }
