// A pixel of a thin line: depth and place as fiblets/compute/software_raster/cover_thin.glsl computes them for the compute pipeline
// (fiblets/segments/thin_line_rule.glsl has the rule), to the last bit where a compiler does not fuse operations.

#version 430
#if FEATURE_PER_PRIMITIVE
#include "fiblets/mesh/fragment_extension.glsl"
#endif

#include "fiblets/hardware_raster/shade.glsl"

void main() {
    ivec2 p = ivec2(varying_cells.x & 0xFFFFu, varying_cells.x >> 16u), q = ivec2(varying_cells.y & 0xFFFFu, varying_cells.y >> 16u);
    vec2 run = vec2(q - p), at = floor(gl_FragCoord.xy) - vec2(p);
#if FEATURE_PAINTED
    float ratio = varying_ratio;
#else
    float ratio = 1.0;
#endif
    if (at == run) {  // drawn only where the line ends
        shade(1.0, ratio, varying_depths.y);
        return;
    }
    float square = 1.0 / max(dot(run, run), 1.0);
    precise vec2 slope = square * (varying_depths.y - varying_depths.x) * run;
    precise float depth = varying_depths.x - dot(CELL_SHIFT, slope) + dot(at, slope);
    shade(dot(at - CELL_SHIFT, run) * square, ratio, depth);
}
