// The criteria that cull fiblets, besides occlusion: the view volume (culling/frustum.glsl), and the caller's
// choice. Culled are fiblets without an end of their streamline where only ends are drawn, fiblets of hidden streamlines, fiblets without a visible segment, and fiblets wholly
// beyond the caller's planes or outside the caller's region. All pipelines cull by these two functions: a new criterion is a
// line of fails_criteria(), under a feature of its own.
//
// Invariant: a culled fiblet has no visible pixel.

#include "culling/frustum.glsl"
#include "culling/cut.glsl"
#include "fiblets/data/streamline_mask.glsl"
#include "fiblets/data/point_mask.glsl"

float ball_of(Capsule c) { return 0.5 * distance(c.a, c.b) + body_of(c); }

#if FEATURE_CLIP_PLANES
// Whether a fiblet lies wholly beyond one of the caller's planes, by the ball around its capsule.
bool beyond_clip_planes(Capsule c) { return clip_height(0.5 * (c.a + c.b)) + clip_rounding < -ball_of(c); }
#endif

// Whether the caller's choice culls a fiblet; `partly`: whether the rest of it may need to be cut.
bool fails_criteria(uint f, Capsule c, out bool partly) {
    partly = false;
#if FEATURE_LINE_ENDS
    if (!begins(f) && !ends(f)) return true;
#endif
#if FEATURE_STREAMLINE_MASK
    if (!streamline_shown(f)) return true;
#endif
#if FEATURE_POINT_MASK
    begin_point_mask(f);
    if (!any_point_shown()) return true;
    partly = !all_points_shown() || cut_beside(f);
#endif
#if FEATURE_CLIP_PLANES
    if (beyond_clip_planes(c)) return true;
    partly = partly || clip_touches(0.5 * (c.a + c.b), ball_of(c));
#endif
#if FEATURE_CLIP_REGION
    int state = region_of_lines(c.a, c.b, body_of(c), ball_of(c));
    if (state < 0) return true;
    partly = partly || state == 0;
#endif
    return false;
}

// Whether nothing of a fiblet lies in the view volume, or the caller's criteria cull it.
bool outside_view(uint f, Capsule c) {
    bool outside = false, partly;
    above_planes(c, 0, 6, outside);
    return outside || fails_criteria(f, c, partly);
}
