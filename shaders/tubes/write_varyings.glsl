// From a segment to what its fragments need.

#include "tubes/segment.glsl"
#include "tubes/ray.glsl"
#include "frame/clip_planes.glsl"
#define VARYING flat out
#include "tubes/varyings.glsl"

#if FEATURE_CLIP_PLANES
uniform int drawn_sides;     // 1: segments clear of all planes of the caller's; 2: those that one may cut
#endif

const uint HIDDEN = 4u;      // flag of segments that the caller does not want (pvfiblets/engine/tubes/nodes.py)

// Whether a segment is for this round. Hidden ones and those beyond a plane are for none.
bool has_turn(Segment s) {
    if ((s.ids.y & HIDDEN) != 0u) return false;
#if FEATURE_CLIP_PLANES
    vec4 balls[4] = vec4[4](s.a1, s.a2, s.b2, s.b3);
    int side = 1;
    for (int plane = 0; plane < clip_plane_count; ++plane) {
        float at = clip_height_of(plane, s.centre) / s.size, low = 3e38, high = -3e38;
        for (int k = 0; k < 4; ++k) {
            float height = at + dot(clip_planes[plane].xyz, balls[k].xyz);
            low = min(low, height - balls[k].w);
            high = max(high, height + balls[k].w);
        }
        if (high < -1e-5) return false;
        if (low < 1e-5) side = 2;
    }
    return (drawn_sides & side) != 0;
#else
    return true;
#endif
}

void write_varyings(Segment s, int index, uint halves) {
    varying_centre = vec4(s.centre, s.size);
    Seen seen = seen_centre(s);
    varying_seen = vec4(seen.whole, seen.part);
    varying_depth = seen.depth;
    varying_a1 = s.a1;
    varying_a2 = s.a2;
    varying_b2 = s.b2;
    varying_b3 = s.b3;
    varying_ids = uvec2(uint(index), s.ids.y | halves << 8u);
}
