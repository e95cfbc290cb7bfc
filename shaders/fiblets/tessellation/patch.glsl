// What the control stage hands to the evaluation stage of a fiblet: the points in two halves, and `patch_ids`: fiblet counted over all
// chunks; segments, in bits 8 to 15 the steps that each stands for, and in bits 16 to 18 whether the streamline begins and ends here, and
// whether all segments are one isoline; streamline; bits of the index of the first point within the streamline
// (fiblets/hardware_raster/handed.glsl). For joints of wide lines `patch_beyond` is the run of the next segment.

const uint HALF = 31u;  // points of a vertex

#if FEATURE_VALUES_ARC_LENGTH || FEATURE_VALUES_VOLUME
#define HALF_POINT vec4  // w: per-point value
#else
#define HALF_POINT vec3
#endif
