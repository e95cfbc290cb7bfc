// One invocation draws one fiblet, or a share of it, point after point (paper: Schertzer et al. 2022, sections 3.3.1 and
// 4.5.3): the pipeline `mesh-serial`, for comparison with fiblets/mesh/together.glsl.

#include "fiblets/segments/polyline.glsl"
#include "fiblets/attributes/pixel.glsl"
#include "fiblets/mesh/draw_segment.glsl"

void draw_share(uint f, uint share) {
    begin_pixels(f);
    begin_polyline(f);
    uint first = (SHARES - 1u - share) * SHARE, end = min(polyline.count, first + SHARE);
    if (first >= end) {
        put_count(0u);
        return;
    }
    for (uint i = 0u; i < end; ++i) {
        vec3 from = walk_point;
        float before = value_of_point(i);
        next_point(i + 1u);
        start_segment(i, walk_delta, polyline.steps);
        if (i < first) continue;
        Varyings varyings = Varyings(pixel_ids, chunk_first + f, pixel_first_point, i, pixel_steps, vec2(before, value_of_point(i + 1u)));
        draw_segment(i - first, end - first, varyings, from, walk_point, i == 0u && polyline.begin, i + 1u == polyline.count && polyline.end);
    }
    put_count(PRIMITIVES * (end - first));
}
