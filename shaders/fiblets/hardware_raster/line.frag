// A pixel of a thin line: depth and place as fiblets/compute/software_raster/segments.glsl computes them for the compute pipeline (fiblets/segments/thin_line_rule.glsl has
// the rule), to the last bit where a compiler does not fuse operations.

#version 430
#if FEATURE_PER_PRIMITIVE
#include "fiblets/mesh/fragment_extension.glsl"
#endif

#include "fiblets/hardware_raster/shade.glsl"
#if FEATURE_EDGES
#include "fiblets/segments/thin_line_rule.glsl"
#include "fiblets/segments/clipped_segment.glsl"
#include "fiblets/segments/edges.glsl"
#endif

void main() {
    ivec2 p = ivec2(varying_cells.x & 0xFFFFu, varying_cells.x >> 16u), q = ivec2(varying_cells.y & 0xFFFFu, varying_cells.y >> 16u);
    vec2 run = vec2(q - p), at = floor(gl_FragCoord.xy) - vec2(p);
#if FEATURE_EDGES
    out_edges = thin_edges(p, q, at, unpacked_parts(varying_parts), (varying_ids.w & 0x10000u) != 0u, (varying_ids.w & 0x20000u) != 0u);
#endif
    if (at == run) {  // drawn only where the line ends
        shade(1.0, varying_ratio, varying_depths.y);
        return;
    }
    float square = 1.0 / max(dot(run, run), 1.0);
    precise vec2 slope = square * (varying_depths.y - varying_depths.x) * run;
    precise float depth = varying_depths.x - dot(CELL_SHIFT, slope) + dot(at, slope);
    shade(dot(at - CELL_SHIFT, run) * square, varying_ratio, depth);
}
