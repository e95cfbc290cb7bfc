// A closed surface for its layers. It is cut at the near plane, since crossings before it have no boundary in the picture and
// their window depths have no digits; beyond the far plane depths are clamped (pvfiblets/engine/regions/surface_crossings.py).

#version 430

in vec3 position;

uniform mat4 clip_from_surface;

invariant gl_Position;

void main() {
    gl_Position = clip_from_surface * vec4(position, 1.0);
    gl_ClipDistance[0] = gl_Position.z + gl_Position.w;
}
