// The points that a fiblet is drawn by, one after the other: its own and the next fiblet's first, or, from far enough
// (is_one_segment() of culling/bounds.glsl), the ends of its capsule. FEATURE_ONE_SEGMENT: it is known that it is far enough,
// and nothing is decoded.
//
// Use: begin_polyline(f); then next_point(i) for i = 1 .. polyline.count; after each, walk_point and walk_delta hold
// the end and the run of segment i - 1. A segment's pixels depend on the next one, too: walk_ahead(i) goes to point i + 1,
// and returns the run of segment i; past the last one it returns the next fiblet's first.

#include "fiblets/decode/sequential.glsl"
#include "culling/bounds.glsl"
#include "fiblets/attributes/neighbours.glsl"
#include "fiblets/data/point_mask.glsl"

struct Polyline {
    uint fiblet;
    uint last;     // points up to this one are decoded, the one after it is `next`
    uint count;    // segments; a single point is a segment of no length
    float steps;   // from point to point that a segment stands for: 1, or 0 for a single point, or all of a far fiblet's
    bool begin;    // the streamline begins here
    bool end;      // and ends here
    bool whole;    // one segment stands for the fiblet
    bool on;       // of wide lines: the next fiblet is drawn as this one is
    vec3 next;
#if FEATURE_SUBSAMPLES
    vec3 last_run;   // of segments merged into one, the last's
    float run;       // and the length of all, mm
#endif
};

Polyline polyline;

// One segment, numbered 0, between the ends of the capsule.
void begin_one_segment(uint f, Capsule capsule) {
    walk_point = capsule.a;
    polyline.last = 0u;
    polyline.count = 1u;
    polyline.whole = true;
    polyline.steps = float(fiblet_last(decoding_words(f)) + (polyline.end ? 0u : 1u));
    polyline.next = capsule.b;
}

void begin_points(uint f) {
    begin_point_mask(f);
    polyline.fiblet = f;
    polyline.whole = false;
    polyline.begin = begins(f);
    polyline.end = ends(f);
#if FEATURE_ONE_SEGMENT
    begin_one_segment(f, capsule_of(f));
#else
#if FEATURE_LEVEL_OF_DETAIL
    Capsule capsule = capsule_of(f);
    if (is_one_segment(capsule) && all_points_shown()) {
        begin_one_segment(f, capsule);
        return;
    }
#endif
    walk_begin(f);
    polyline.last = walk.last;
    polyline.count = walk.last + (polyline.end && walk.last > 0u ? 0u : 1u);
    polyline.steps = polyline.end && walk.last == 0u ? 0.0 : 1.0;
    polyline.next = polyline.end ? walk_anchor : anchor_local(f + 1u);
#endif
}

void begin_polyline(uint f) {
    begin_points(f);
#if FEATURE_WIDE_LINES
    polyline.on = alike_after(f, polyline.whole);
#endif
}

void next_point(uint i) {
#if !FEATURE_ONE_SEGMENT
    if (i <= polyline.last) {
        walk_next(i);
        return;
    }
#endif
    walk_delta = polyline.next - walk_point;
    walk_point = polyline.next;
}

// Whether the line goes on after point i as walk_ahead(i) says.
bool goes_on(uint i) { return i < polyline.count || polyline.on; }

vec3 walk_ahead(uint i) {
    if (i >= polyline.count) return direction_after(polyline.fiblet, polyline.whole);
    next_point(i + 1u);
    return walk_delta;
}
