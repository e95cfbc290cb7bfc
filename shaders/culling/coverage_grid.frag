// The coverage buffer as the next camera sees it; blending keeps the farthest.

#version 430

in float zeta;
flat in float zeta_flat;

out float farthest;

void main() { farthest = max(zeta, zeta_flat); }
