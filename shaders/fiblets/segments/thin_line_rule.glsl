// Pixels of a thin segment. All pipelines follow this rule, so that all of them draw the same picture.
//
// A segment is drawn from the centre of the pixel that holds its first point to the centre of the one that holds its last:
// n = max(|dx|, |dy|) pixels, without the last, in which the next segment begins. Joints are neither doubled nor open,
// whatever the segments' length, and segments within one pixel cost nothing. Where nothing follows (the end of a
// streamline, or the edge of the view volume) the last pixel is drawn too, so that a one-point streamline shows as a dot.
//
//       first segment        second
//      # . . . . . . .      # drawn by the first
//      . # # . . . . o      o drawn by the second, which begins in the last pixel of the first
//      . . . # # o o .
//
// This is what OpenGL's diamond-exit rule makes of a line between these two points, on any driver: both lie well inside
// their pixels' diamonds. CELL_SHIFT = e, a multiple of OpenGL's finest subpixel (1/256), decides what would be ties: with this
// one no line of 64 pixels or fewer passes through a pixel's corner, and Mesa rounds one of 20 or fewer nowhere to the
// other side. With p, q the two pixels and run = q - p:
//
//   pixel i      floor(p + 1/2 + e + s run), s = (i - sign(run_major) e_major) / n: on the major axis p_major +- i
//   depth        linear in t = (pixel - p - e) . run / (run . run), OpenGL's own formula
//
// A pixel drawn is therefore at most one pixel away from the true line, and has its depth within one pixel.

#include "frame/project.glsl"

// The pixel that holds a point of the window; one on the right or upper edge belongs to the last pixel.
vec2 in_picture(vec4 window) {
#if FEATURE_CLIPPING
    return clamp(window.xy, vec2(0.0), viewport - 0.01);
#else
    return window.xy;
#endif
}

vec2 pixel_of(vec4 window) { return floor(in_picture(window)); }

struct Cells {
    ivec2 first;
    vec2 run;
    int count;      // pixels before the last one
    float shift;    // signed e on the major axis
    float inverse;  // 1 / n
    float square;   // 1 / (run . run)
};

Cells cells_between(ivec2 p, ivec2 q) {
    ivec2 run = q - p, size = abs(run);
    int n = max(size.x, size.y);
    bool steep = size.y > size.x;
    float shift = steep ? (run.y < 0 ? -CELL_SHIFT.y : CELL_SHIFT.y) : (run.x < 0 ? -CELL_SHIFT.x : CELL_SHIFT.x);
    vec2 way = vec2(run);
    return Cells(p, way, n, shift, 1.0 / float(max(n, 1)), 1.0 / max(dot(way, way), 1.0));
}
