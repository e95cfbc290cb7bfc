// Frustum culling (paper: Schertzer et al. 2022, section 3.4.3, equation 5): a fiblet whose bounds lie wholly outside one
// plane of the view volume cannot show. The paper dilates the volume by a sphere and tests a point; the signed distances
// of a capsule's two ends to the planes of the model-view-projection do the same for perspective and for parallel views.
//
// Invariant: never culls a fiblet of which one pixel would be drawn. The capsule (`bounds`, rounded up by the encoder) holds
// all points and the joining segment; the planes stand half a line's width and the rounding of this very computation
// further out (pvfiblets/engine/frame.py must agree).

#include "culling/bounds.glsl"
#include "frame/clip_planes.glsl"

float ball_of(Capsule c) { return 0.5 * distance(c.a, c.b) + c.r; }

// Least signed distance of either end to planes first..last-1, and whether both are outside one of them.
float above_planes(Capsule c, int first, int last, inout bool outside) {
    float least = 3.0e38;
    for (int side = first; side < last; ++side) {
        float a = dot(planes[side].xyz, c.a) + planes[side].w, b = dot(planes[side].xyz, c.b) + planes[side].w;
        least = min(least, min(a, b));
        outside = outside || max(a, b) < -c.r;
    }
    return least;
}

#if FEATURE_CLIP_PLANES
// Whether a fiblet lies wholly beyond one of the caller's planes, by the ball around its capsule.
bool beyond_clip_planes(Capsule c) { return clip_height(0.5 * (c.a + c.b)) + clip_info.y < -ball_of(c); }
#endif

// Whether nothing of a fiblet lies in the view volume and on the kept side of the caller's planes.
bool outside_view(Capsule c) {
    bool outside = false;
    above_planes(c, 0, 6, outside);
#if FEATURE_CLIP_PLANES
    outside = outside || beyond_clip_planes(c);
#endif
    return outside;
}
