// Frustum culling (paper: Schertzer et al. 2022, section 3.4.3, equation 5): a fiblet whose bounds lie wholly outside one
// plane of the view volume cannot show. The paper dilates the volume by a sphere and tests a point; the signed distances
// of a capsule's two ends to the planes of the model-view-projection do the same for perspective and for parallel views.
//
// Invariant: a culled fiblet has no visible pixel. The capsule (`bounds`, rounded up by the encoder) holds
// all points and the joining segment; the planes stand half a line's width, the radius of tubes and the rounding of this very computation
// further out (pvfiblets/engine/frame.py must agree).

#include "culling/bounds.glsl"

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
