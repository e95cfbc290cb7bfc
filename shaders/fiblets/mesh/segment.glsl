// One segment's part of a mesh: a line, or for wide lines the two triangles of a rectangle.
//
// Thin lines that nothing cuts share vertices, as in a strip; others have their own. Of a segment that is cut away whole the
// vertices lie beyond the edge of the picture.
//
//       uncut      0 ----- 1 ----- 2 ..        segment k: a line from vertex k to k + 1
//       cut        0 ----- 1   2 ----- 3 ..    segment k: a line from vertex 2k to 2k + 1
//       wide       1---3   5---7
//                  | \ |   | \ |   ..          segment k: two triangles of vertices 4k to 4k + 3
//                  0---2   4---6
//
// Primitives are in the opposite order, and so are shares: of two segments with the same depth in a pixel the one drawn first
// stays, and that is to be the later one, as in the compute pipeline.

#include "fiblets/segments/clipped_segment.glsl"
#include "fiblets/mesh/shares.glsl"
#if FEATURE_WIDE_LINES
#include "fiblets/hardware_raster/wide.glsl"
const uint PRIMITIVES = 2u;  // of a segment
#else
#include "fiblets/hardware_raster/thin.glsl"
const uint PRIMITIVES = 1u;
#endif

uint vertices_of(uint segments) {
#if FEATURE_WIDE_LINES
    return 4u * segments;
#elif FEATURE_CLIPPING
    return 2u * segments;
#else
    return segments + 1u;
#endif
}

const vec4 NOWHERE = vec4(2.0, 2.0, 2.0, 1.0);
