// What the stages before the fragments hand over of a segment; HANDED is "flat out" or "flat in".

HANDED vec4 handed_centre;     // xyz: local mm; w: size (mm)
HANDED vec4 handed_seen;       // the centre as it is seen, see tubes/ray.glsl
HANDED vec2 handed_depth;
HANDED vec4 handed_a1;         // control points, see tubes/segment.glsl
HANDED vec4 handed_a2;
HANDED vec4 handed_b2;
HANDED vec4 handed_b3;
HANDED uvec2 handed_ids;       // segment; flags, and in bits 8 and 9 which halves
