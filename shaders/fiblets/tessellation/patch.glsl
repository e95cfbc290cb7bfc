// What the control stage hands to the evaluation stage of a fiblet: `patch_ids` (streamline; fiblet counted over all chunks;
// segments, and in bits 8 to 15 the steps that each stands for; whether the streamline begins, and ends, here), `patch_first`
// (index of the first point within the streamline) and the points in two halves.

const uint HALF = 31u;  // points of a vertex
