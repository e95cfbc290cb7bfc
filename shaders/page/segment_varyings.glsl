// Outputs of a segment's rectangle to its fragments; equal at all corners.

#ifndef VARYING
#define VARYING flat out
#endif

VARYING uvec2 seg_ids;     // streamline and layer; 1: the line starts here, 2: it ends here
VARYING vec3 seg_tangent;  // at the start
VARYING vec3 seg_tangent_to;
VARYING vec4 seg_start;    // of the part that is drawn: window x, y; depth; clip w
VARYING vec4 seg_end;
VARYING vec4 seg_along;    // t at both ends; values at the points
#if FEATURE_VALUES_COLOUR
VARYING uvec2 seg_colours; // at the points
#endif
#if FEATURE_WIDE_LINES
VARYING vec2 seg_onward;   // fiblets/segments/joint.glsl
#if FEATURE_GATHER_SLICES
VARYING uint seg_place;    // of the first point along all lines, PLACE_STEPS to a segment; compared as differences alone
const float PLACE_STEPS = 64.0;
#endif
#if FEATURE_CLIP_PLANES
VARYING vec3 seg_from;
VARYING vec3 seg_to;
#endif
#endif
