// What the control stage hands to the evaluation stage of a fiblet: `patch_ids` (streamline; fiblet counted over all chunks;
// segments, and in bits 8 to 15 the steps that each stands for; whether the streamline begins, and ends, here), `patch_first`
// (index of the first point within the streamline), the points in two halves, and `patch_around`: which way the streamline comes
// from before the fiblet, and goes after it (fiblets/attributes/neighbours.glsl), packed, or NO_DIRECTION; and, for joints of wide
// lines, `patch_beyond`, the run of the next segment.

const uint HALF = 31u;  // points of a vertex
const uint NO_DIRECTION = 0x80008000u;  // as no direction is packed
