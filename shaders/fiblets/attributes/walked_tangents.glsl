// Tangents at both ends of the segments of a fiblet that is walked along (fiblets/segments/polyline.glsl), one after the other.
//
// Use: begin_tangents(f) before begin_polyline(f); then start_tangents() for every segment in order, which sets `tangents`
// for both of its ends.

#include "fiblets/segments/polyline.glsl"
#include "fiblets/attributes/tangent.glsl"

vec3 tangent_before;   // u of the last segment before that has one
vec3 tangent_next;     // and of the next segment
Tangents tangents;

void begin_tangents(uint f) {
    tangent_before = vec3(0.0);
#if !FEATURE_ONE_SEGMENT
    // Where a streamline's last fiblet is a single point, the segment that leads to it is the fiblet before's.
    if (f > 0u && ends(f) && !begins(f) && fiblet_last(decoding_words(f)) == 0u) {
        walk_begin(f - 1u);
        for (uint i = 1u; i <= walk.last; ++i) walk_next(i);
        tangent_before = unit_or_none(anchor_local(f) - walk_point);
    }
#endif
}

// ahead: the next segment, none after the last.
void start_tangents(uint segment, vec3 delta, vec3 ahead) {
    if (segment == 0u && polyline.whole) tangent_before = unit_or_none(direction_before(polyline.fiblet, true));
    vec3 here = segment > 0u ? tangent_next : unit_or_none(delta);
    tangent_next = unit_or_none(ahead);
#if FEATURE_SUBSAMPLES
    bool leads = !polyline.whole && segment + uint(max(polyline.steps, 1.0)) == polyline.count;
    Tangents found = tangents_of(tangent_before, here, tangent_next, leads);
    if (!polyline.whole && polyline.steps > 1.0) {
        here = unit_or_none(polyline.last_run);
        found.end = tangents_of(here, here, tangent_next, leads).end;
    }
#else
    Tangents found = tangents_of(tangent_before, here, tangent_next, !polyline.whole && segment + 1u == polyline.count);
#endif
    if (segment > 0u) found.start = tangents.end;
    tangents = found;
    if (here != vec3(0.0)) tangent_before = here;
}
