// Whether a fiblet can show, by the view volume and the caller's criteria, and the class of programs that draws it.

#include "culling/criteria.glsl"

// `which`: 0 inside all planes; 1 crossing the sides of the view volume; 2 more than that; 3 inside, and drawn as one segment.
bool can_show(uint f, Capsule c, out uint which) {
    bool outside = false, partly = false;
    float edges = above_planes(c, 0, 4, outside), depths = above_planes(c, 4, 6, outside), inside = c.r + plane_rounding;
    bool fails = outside || fails_criteria(f, c, partly);
#if FEATURE_ONE_CLASS
    which = 0u;
#else
    which = partly || depths < inside ? 2u : edges < inside ? 1u : 0u;
#if FEATURE_LEVEL_OF_DETAIL
    if (which == 0u && is_one_segment(c)) which = 3u;
#endif
#endif
    return !fails;
}
