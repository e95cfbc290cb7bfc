// What the stages before the fragments hand over of a segment; VARYING is "flat out" or "flat in".

VARYING vec4 varying_centre;     // xyz: local mm; w: size (mm)
VARYING vec4 varying_seen;       // the centre as it is seen, see tubes/ray.glsl
VARYING vec2 varying_depth;
VARYING vec4 varying_a1;         // control points, see tubes/segment.glsl
VARYING vec4 varying_a2;
VARYING vec4 varying_b2;
VARYING vec4 varying_b3;
VARYING uvec2 varying_ids;       // segment; flags, and in bits 8 and 9 which halves
