// Frustum culling (paper: Schertzer et al. 2022, section 3.4.3, equation 5): a fiblet whose bounds lie wholly outside one
// plane of the view volume cannot show. The paper dilates the volume by a sphere and tests a point; the signed distances
// of a capsule's two ends to the planes of the model-view-projection do the same for perspective and for parallel views.
//
// Invariant: never culls a fiblet of which one pixel would be drawn. The capsule (`bounds`, rounded up by the encoder) holds
// all points and the joining segment; the planes stand half a line's width, the radius of tubes and the rounding of this very computation
// further out (pvfiblets/engine/frame.py must agree).
//
// Streamlines that are not to be shown, fiblets no segment of which is, and those that lie wholly beyond the caller's planes or
// outside the caller's region are left out by the way.

#include "culling/bounds.glsl"
#include "frame/clip_planes.glsl"
#include "fiblets/data/streamline_mask.glsl"
#include "fiblets/data/point_mask.glsl"
#if FEATURE_CLIP_REGION
#include "regions/classify.glsl"
#endif

float ball_of(Capsule c) { return 0.5 * distance(c.a, c.b) + body_of(c); }

// Least signed distance of either end to planes first..last-1, and whether both are outside one of them.
float above_planes(Capsule c, int first, int last, inout bool outside) {
    float least = 3.0e38;
    for (int side = first; side < last; ++side) {
        float a = dot(view_planes[side].xyz, c.a) + view_planes[side].w, b = dot(view_planes[side].xyz, c.b) + view_planes[side].w;
        least = min(least, min(a, b));
        outside = outside || max(a, b) < -c.r;
    }
    return least;
}

#if FEATURE_CLIP_PLANES
// Whether a fiblet lies wholly beyond one of the caller's planes, by the ball around its capsule.
bool beyond_clip_planes(Capsule c) { return clip_height(0.5 * (c.a + c.b)) + clip_rounding < -ball_of(c); }
#endif

#if FEATURE_CLIP_REGION
// 1: wholly within the caller's region, its brush included; -1: wholly outside; 0: who knows.
int region_of_fiblet(Capsule c) {
    vec3 middle = 0.5 * (c.a + c.b);
    float ball = ball_of(c), w = window_from_local[3].w + ball * w_per_mm;
    w += window_from_local[0].w * middle.x + window_from_local[1].w * middle.y + window_from_local[2].w * middle.z;
    return region_of_capsule(c.a, c.b, c.r + max(w, 0.0) * line_reach);
}
#endif

// Whether a fiblet is left out by what the caller chose; `partly`: whether what is left of it may need to be cut.
bool left_out(uint f, Capsule c, out bool partly) {
    partly = false;
#if FEATURE_STREAMLINE_MASK
    if (!streamline_shown(f)) return true;
#endif
#if FEATURE_POINT_MASK
    begin_point_mask(f);
    if (!any_point_shown()) return true;
    partly = !all_points_shown();
#endif
#if FEATURE_CLIP_PLANES
    if (beyond_clip_planes(c)) return true;
    partly = partly || clip_touches(0.5 * (c.a + c.b), ball_of(c));
#endif
#if FEATURE_CLIP_REGION
    int state = region_of_fiblet(c);
    if (state < 0) return true;
    partly = partly || state == 0;
#endif
    return false;
}

// Whether nothing of a fiblet lies in the view volume, or the caller left it out.
bool outside_view(uint f, Capsule c) {
    bool outside = false, partly;
    above_planes(c, 0, 6, outside);
    return outside || left_out(f, c, partly);
}
