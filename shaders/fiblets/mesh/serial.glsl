// One invocation draws one fiblet, or a share of it, point after point (paper: Schertzer et al. 2022, sections 3.3.1 and
// 4.5.3): the pipeline `mesh-serial`, for comparison with fiblets/mesh/together.glsl.

#include "fiblets/segments/polyline.glsl"
#include "fiblets/attributes/values.glsl"
#include "fiblets/hardware_raster/handed.glsl"
#include "fiblets/mesh/draw_segment.glsl"

void draw_share(uint f, uint share) {
    begin_values(f);
    begin_polyline(f);
    uint first = (SHARES - 1u - share) * SHARE, end = min(polyline.count, first + SHARE);
    if (first >= end) {
        put_counts(0u, 0u);
        return;
    }
    put_counts(vertices_of(end - first), PRIMITIVES * (end - first));
    uint streamline = handed_streamline(f);
    float first_point = handed_first(f);
    vec3 to = walk_point;
    next_point(1u);
    for (uint i = 0u; i < end; ++i) {
        vec3 from = to, delta = walk_delta;
        to = walk_point;
        float before = value_of_point(i);
        vec3 ahead = walk_ahead(i + 1u);
        start_values(i, to, delta, polyline.steps);
        if (i < first) continue;
        Varyings varyings = Varyings(streamline, chunk_first + f, first_point, i, polyline.steps, vec2(before, value_of_point(i + 1u)),
                                     goes_on(i + 1u) ? ahead : vec3(0.0));
        draw_segment(i - first, end - first, varyings, from, to, i == 0u && polyline.begin, i + 1u == polyline.count && polyline.end);
    }
}
