// Thin lines for OpenGL's own rasteriser, so that it takes the pixels of fiblets/segments/thin_line_rule.glsl: a part of a segment is drawn from
// the centre of the pixel that holds its first point to the centre of the one that holds its last, both moved by
// CELL_SHIFT. The diamond-exit rule then draws the first pixel and leaves out the last, in which the next segment begins.
//
// Where nothing follows, the last pixel is drawn too: the line goes on for EXIT of a pixel in its own direction, a line within
// one pixel to the right. That leaves the diamond of the last pixel, because EXIT - |CELL_SHIFT| > 1/2, and no other one's.
//
// Parts have been clipped: nothing is left for OpenGL to clip or to divide by, and fiblets/hardware_raster/line.frag finds the depth.

#include "fiblets/segments/thin_line_rule.glsl"
#include "fiblets/segments/clipped_segment.glsl"

const float EXIT = 0.6;

struct Thin {
    vec4 first;     // clip coordinates
    vec4 last;
};

vec4 at_pixel(vec2 pixel) { return vec4(2.0 * pixel / viewport - 1.0, 0.0, 1.0); }

Thin thin_line(ClippedSegment piece) {
    vec2 p = pixel_of(piece.a), q = pixel_of(piece.b), run = q - p;
    float n = max(abs(run.x), abs(run.y));
    vec2 more = !piece.cap ? vec2(0.0) : n > 0.0 ? EXIT / n * run : vec2(EXIT, 0.0);
    return Thin(at_pixel(p + 0.5 + CELL_SHIFT), at_pixel(q + 0.5 + CELL_SHIFT + more));
}
