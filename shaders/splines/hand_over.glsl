// From a segment to what its fragments need.

#include "splines/segment.glsl"
#include "splines/ray.glsl"
#define HANDED flat out
#include "splines/handed.glsl"

void hand_over(Segment s, int index, uint halves) {
    handed_centre = vec4(s.centre, s.size);
    handed_seen = seen_centre(s.centre);
    handed_a1 = s.a1;
    handed_a2 = s.a2;
    handed_b2 = s.b2;
    handed_b3 = s.b3;
    handed_ids = uvec2(uint(index), s.ids.y | halves << 8u);
}
