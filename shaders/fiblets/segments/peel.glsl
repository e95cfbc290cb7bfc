// Layers: of every pixel only the part behind the layers drawn so far (pvfiblets/engine/fiblets/gather/depth_peeling.py). Layer k shows the
// nearest depth key behind that of layer k - 1; of several fiblets at the same key a pixel shows one.
//
// A wide line or a tube covers a pixel by many segments, one after the other, each at a depth of its own: they are one
// surface, and a pixel blends its nearest part only. The place along the line decides whether a segment belongs to an earlier layer's surface:
//
//   place        of a streamline, in points: segment k stands for the places first + k ... first + k + steps
//   reach        points that two widths of the line take, by the pixels that this segment takes. Half a width away on
//                either side a straight line covers the pixel still, a bent one for longer. A line seen end on has no
//                pixels to a point: all of it is one surface.
//
// Use: begin_peel() for a fiblet, peel_segment() for a segment, then behind_layers() and new_surface() for every pixel.
// Bounds, not places, are compared: all passes find the same.
//
// Where lines are added up in slices (fiblets/gather/slices.glsl), the only layer is the picture of the nearest.

#if FEATURE_PEEL
#if FEATURE_TEXTURE_DATA
uniform usampler2DArray peeled_depth;
#else
layout(binding = {{ unit_peeled_depth }}) uniform usampler2DArray peeled_depth;
#endif
uniform int peeled_layers;  // so far
#if FEATURE_WIDE_LINES
#if FEATURE_TEXTURE_DATA
uniform usampler2DArray peeled_ids;
uniform sampler2DArray peeled_position;
#else
layout(binding = {{ unit_peeled_ids }}) uniform usampler2DArray peeled_ids;
layout(binding = {{ unit_peeled_position }}) uniform sampler2DArray peeled_position;
#endif
#endif
#elif FEATURE_GATHER_SLICES && FEATURE_WIDE_LINES
uniform usampler2D nearest_ids;
uniform sampler2D nearest_position;
#endif

#if FEATURE_PEEL || FEATURE_GATHER_SLICES
const float WIDTHS = 2.0;

uint peel_streamline;
float peel_first;      // place of the fiblet's first point
float peel_steps;      // of the segment, from point to point
float peel_reach;
#if __VERSION__ >= 400
precise peel_reach;
#endif

void begin_peel(uint streamline, float first_point) {
    peel_streamline = streamline;
    peel_first = first_point;
}

// a, b: its ends in the window; r: half the width.
void peel_segment(vec2 a, vec2 b, float r, float steps) {
    precise vec2 run = b - a;
    peel_steps = steps;
#if FEATURE_LINE_ENDS
    peel_reach = 0.0;   // discs do not join
#else
    peel_reach = 2.0 * WIDTHS * r * max(steps, 1.0) / max(length(run), 1e-3);
#endif
}

#else
void begin_peel(uint streamline, float first_point) {}
void peel_segment(vec2 a, vec2 b, float r, float steps) {}
#endif

#if FEATURE_PEEL
bool behind_layers(ivec2 pixel, uint key) {
    return key > texelFetch(peeled_depth, ivec3(pixel, peeled_layers - 1), 0).x;
}
#else
bool behind_layers(ivec2 pixel, uint key) { return true; }
#endif

// Whether the segment is no part of an earlier layer's surface. This test is the last before a pixel shows.
bool new_surface(ivec2 pixel, uint segment) {
#if FEATURE_PEEL && FEATURE_WIDE_LINES
    precise float from = peel_first + float(segment), to = from + peel_steps;
    for (int layer = 0; layer < peeled_layers; ++layer) {
        if (texelFetch(peeled_ids, ivec3(pixel, layer), 0).x != peel_streamline) continue;
        float there = texelFetch(peeled_position, ivec3(pixel, layer), 0).x;
        if (max(from - there, there - to) <= peel_reach) return false;
    }
#elif FEATURE_GATHER_SLICES && FEATURE_WIDE_LINES
    if (texelFetch(nearest_ids, pixel, 0).x != peel_streamline) return true;
    precise float from = peel_first + float(segment), to = from + peel_steps;
    float there = texelFetch(nearest_position, pixel, 0).x;
    return max(from - there, there - to) > peel_reach;
#endif
    return true;
}
