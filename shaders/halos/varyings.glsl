// What the vertex stage hands to the fragments of a strip or a disc, the same for all of them; VARYING is "flat out" or "flat in".
// Everything else is found at the foot of each pixel on the axis: interpolated over triangles it would bend where they meet.

const uint FREE_START = 1u << 30, FREE_END = 1u << 31;

VARYING uint varying_item;         // segment or point; which ends of a segment nothing goes on beyond
VARYING vec4 varying_ends;         // pixels from the picture's middle: of the axis' start, of its end
VARYING vec4 varying_depths;       // 1 / W of both; 1 - depth of both
#if FEATURE_HALO_CUT
VARYING vec2 varying_part;         // where on the segment both are, 0..1: planes and the picture's edges may have cut it
#endif
#if FEATURE_HALO_TAPER
VARYING vec2 varying_mask;         // u of the mask of both
#endif
#if FEATURE_HALO_CUE
VARYING vec2 varying_cue;          // share by which depth cueing makes the line narrower at both
#endif
#if FEATURE_HALO_FILTER
VARYING vec4 varying_filter;       // the number that filters at both, and how much it changes per mm at both
#endif
