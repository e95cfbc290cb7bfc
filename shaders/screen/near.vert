// One triangle that covers the whole target at depth 0. With a depth buffer that is 0 at empty pixels, and a test of
// "less", empty pixels stay empty.

#version 430

void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    gl_Position = vec4(corner, -1.0, 1.0);
}
