// A fiblet is seen; see raster/seen.vert.

#version 430

out uint mark;

void main() { mark = 1u; }
