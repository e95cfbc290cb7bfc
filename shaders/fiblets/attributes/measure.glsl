// What lies between the anchors, for per-point values that run on from fiblet to fiblet: lengths and turns.
// pvfiblets/engine/fiblets/data/point_values.py turns the measures of consecutive fiblets into arc length and curvature at every anchor.

#include "fiblets/decode/sequential.glsl"
#include "fiblets/attributes/turn.glsl"

struct Measure {
    vec4 first;   // xyz: first segment; w: length of all, the joining segment included
    vec4 joint;   // xyz: joining segment (or the last, at the end of a streamline); w: turn at the last point
    vec4 turns;   // x, y: least and greatest turn between the first and the last point; z: the first of them
};

Measure measure_of(uint f) {
    bool end = ends(f);
    walk_begin(f);
    Measure m = Measure(vec4(0.0), vec4(0.0), vec4(3.0e38, -3.0e38, 0.0, 0.0));
    vec3 before = vec3(0.0);
    uint segments = walk.last + (end ? 0u : 1u);
    for (uint i = 1u; i <= segments; ++i) {
        vec3 from = walk_point, delta;
        if (i <= walk.last) {
            walk_next(i);
            delta = walk_delta;
        } else {
            delta = anchor_local(f + 1u) - from;
        }
        m.first.w += length(delta);
        if (i == 1u) {
            m.first.xyz = delta;
        } else {
            m.joint.w = turn(before, delta);
            m.turns.x = min(m.turns.x, m.joint.w);
            m.turns.y = max(m.turns.y, m.joint.w);
            if (i == 2u) m.turns.z = m.joint.w;
        }
        before = delta;
    }
    m.joint.xyz = before;
    return m;
}
