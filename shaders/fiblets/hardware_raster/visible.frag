// A fiblet is seen; see fiblets/hardware_raster/visible.vert.

#version 430

out uint mark;

void main() { mark = 1u; }
