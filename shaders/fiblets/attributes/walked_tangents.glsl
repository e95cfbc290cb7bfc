// Tangents at both ends of the segment that a walk along a fiblet (fiblets/raster/polyline.glsl) has come to.
//
// Use: start_tangents(i, delta) for every segment in order, the walk at its end; then, where they are asked for, tangents().
// What they need of the segment after it is decoded only then: most segments of a picture own no pixel.

#include "fiblets/raster/polyline.glsl"
#include "fiblets/attributes/neighbours.glsl"
#include "fiblets/attributes/tangent.glsl"

vec3 tangents_before;   // the last segment before that has a length
vec3 tangents_here;
uint tangents_segment;
bool tangents_known;
uvec2 tangents_packed;

void start_tangents(uint segment, vec3 delta) {
    if (segment == 0u) tangents_before = vec3(0.0);
    else if (tangents_here != vec3(0.0)) tangents_before = tangents_here;
    tangents_here = delta;
    tangents_segment = segment;
    tangents_known = false;
}

// The next segment that has a length.
vec3 walk_beyond(uint i) {
#if !FEATURE_ONE_SEGMENT
    if (i <= polyline.last && !polyline.whole) {
        vec3 found = walk_ahead(i);
        if (found == vec3(0.0) && !polyline.end) found = polyline.next - walk_point;
        if (found != vec3(0.0)) return found;
    }
#endif
    return direction_after(polyline.fiblet, polyline.whole);
}

// Where a streamline's last fiblet is a single point: the segment that leads to it, of the fiblet before.
vec3 walk_behind() {
#if !FEATURE_ONE_SEGMENT
    uint f = polyline.fiblet;
    if (polyline.steps == 0.0 && !polyline.whole && !polyline.begin && f > 0u) {
        vec3 there = walk_point;
        walk_begin(f - 1u);
        for (uint i = 1u; i <= walk.last; ++i) walk_next(i);
        vec3 joining = there - walk_point;
        walk_point = there;
        return joining;
    }
#endif
    return direction_before(polyline.fiblet, polyline.whole);
}

uvec2 tangents() {
    if (!tangents_known) {
        uint i = tangents_segment + 1u;
        bool leads = !polyline.whole && i == polyline.count && !polyline.end;
        vec3 after = walk_beyond(i), before = tangents_segment == 0u ? walk_behind() : tangents_before;
        tangents_packed = tangents_at_ends(before, tangents_here, after, leads);
        tangents_known = true;
    }
    return tangents_packed;
}
