// Hands the number of a segment to the geometry stage, which fetches the rest.

#version 430

uniform int first_segment;

flat out int passed_segment;

void main() {
    passed_segment = first_segment + gl_VertexID;
    gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
}
