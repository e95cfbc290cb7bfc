// The background: one colour, or from one at the bottom to one at the top.

#version 430

uniform vec3 bottom;
uniform vec3 top;
uniform float height;
layout(location = 0) out vec4 colour;

void main() { colour = vec4(mix(bottom, top, gl_FragCoord.y / height), 1.0); }
