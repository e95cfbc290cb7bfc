// Counts fiblets in the view volume (culling/criteria.glsl) where there are no compute shaders: each that is in it covers a
// pixel, and a query counts those.

#version 430

#include "culling/criteria.glsl"

void main() {
    bool outside = outside_view(uint(gl_VertexID), capsule_of(uint(gl_VertexID)));
    gl_Position = outside ? vec4(2.0, 2.0, 2.0, 1.0) : vec4(0.0, 0.0, 0.0, 1.0);
}
