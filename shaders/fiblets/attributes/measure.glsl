// Lengths of fiblets, for arc length, which runs on from fiblet to fiblet: pvfiblets/engine/fiblets/data/point_values.py adds lengths up.

#include "fiblets/decode/sequential.glsl"

// Length of all segments, the one that joins the next fiblet included.
float length_of(uint f) {
    float sum = 0.0;
    walk_begin(f);
    for (uint i = 1u; i <= walk.last; ++i) {
        walk_next(i);
        sum += length(walk_delta);
    }
    return ends(f) ? sum : sum + distance(anchor_local(f + 1u), walk_point);
}
