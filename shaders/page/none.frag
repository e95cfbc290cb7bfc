// Fragment stage of transform feedback: nothing is drawn.

#version 430

out vec4 colour;

void main() { colour = vec4(0.0); }
