// One triangle that covers the whole target, as deep as anything can be: with a depth test of "greater", a pixel in which
// nothing has been drawn takes none of it.

#version 430

void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    gl_Position = vec4(corner, 1.0, 1.0);
}
