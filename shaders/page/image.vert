// A slice of an image: four corners.

#version 430

uniform mat4 clip_from_data;
uniform vec3 corner;
uniform vec3 across;
uniform vec3 up;
out vec2 at;

void main() {
    at = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    gl_Position = clip_from_data * vec4(corner + at.x * across + at.y * up, 1.0);
}
