// Draws one fiblet's polyline into pixels, segment by segment, without OpenGL's rasteriser.
//
// The including pass defines
//   void plot(Fragment fragment)                                called for each pixel that a segment covers
//   void start_segment(uint segment, vec3 to, vec3 delta, vec3 ahead)   called before the pixels of a segment, with its end,
//                its run and that of the next one
//   vec3 shown_normal(Hit hit)                                   of tubes, the normal that a pixel is given
//
// The included file of cover() decides which pixels are covered:
//   thin lines   fiblets/compute/software_raster/cover_thin.glsl: the pixels of fiblets/segments/thin_line_rule.glsl
//   wide lines   fiblets/compute/software_raster/cover_wide.glsl: capsules in the window
//   tubes        fiblets/compute/software_raster/cover_tube.glsl: where rays through pixels meet capsules in space
//
// At a plane of the caller's a thin line ends in the pixel of the cut. A wide line ends in a round brush, without the
// pixels that lie beyond a plane at the depth that they show: a cut seen from the side is a straight edge,
// and a line cut head-on shows the whole brush.
//
// FEATURE_SUBSAMPLES: segments that run straight on are merged into one. Points deviate by less than a sample from the drawn line.
//
// Depth is interpolated in the window, where it is linear; everything else is corrected for perspective (along()).

#include "fiblets/segments/polyline.glsl"
#include "fiblets/segments/drawn_segment.glsl"
#include "fiblets/segments/peel.glsl"

// A segment's hit in a pixel.
struct Fragment {
    ivec2 pixel;
    float z;         // window depth
    float s;         // position along the segment's piece in the window
    vec3 relief;     // with FEATURE_CROSS_LINE: the cross-line coordinate in x (wide lines), or the normal (tubes)
};

void plot(Fragment fragment, Segment segment);
void start_segment(uint segment, vec3 to, vec3 delta, vec3 ahead);
#if FEATURE_TUBES
vec3 shown_normal(Hit hit);
#endif

// Plots a pixel, unless it does not lie behind the layers drawn so far. Whether the caller's region cuts it away is for
// fiblets/compute/depth.comp to ask, and only of what would show: the later passes look for depths that were kept.
void put(Fragment fragment, Segment segment) {
    if (behind_layers(fragment.pixel, depth_key(fragment.z))) plot(fragment, segment);
}

// Place of a pixel on the segment.
float along(Fragment fragment, Segment segment) {
    return along_segment(segment.from, segment.to, segment.piece, fragment.s);
}

#if FEATURE_TUBES
#include "fiblets/compute/software_raster/cover_tube.glsl"
#elif FEATURE_WIDE_LINES
#include "fiblets/compute/software_raster/cover_wide.glsl"
#else
#include "fiblets/compute/software_raster/cover_thin.glsl"
#endif

#if FEATURE_SUBSAMPLES
const float MERGED_DEVIATION = 0.25;   // samples; a pixel has four along each axis

// Whether the line from a vertex to a point goes on to the next one as it began, in `direction`.
bool goes_straight(Vertex from, vec3 direction, vec3 here, vec3 next) {
    vec3 run = next - from.local;
    return dot(direction, next - here) > 0.0 && length(cross(direction, run)) * most_pixels_per_mm <= MERGED_DEVIATION * from.clip.w;
}
#endif

#ifndef COVER_APART
void take(Segment segment) { cover(segment); }
#else
void take(Segment segment);    // fiblets/compute/software_raster/cover_apart.glsl
#endif

Vertex pen;       // up to here a fiblet is drawn
uint pen_at;      // so many segments

void begin_drawing(uint f) {
    begin_polyline(f);
#if FEATURE_WIDE_LINES && (FEATURE_PEEL || FEATURE_GATHER_SLICES)
    begin_peel(streamline_of(f), float(points_before(f)));
#endif
    pen = vertex_of(walk_point);
    pen_at = 0u;
    next_point(1u);
}

// Draws on, up to so many segments.
void draw_until(uint end) {
    Vertex from = pen;
    uint i = pen_at + 1u;
    for (; i <= min(end, polyline.count); ++i) {
        uint first = i - 1u;
        vec3 here = walk_point, delta = walk_delta, ahead = walk_ahead(i);
#if FEATURE_SUBSAMPLES
        polyline.run = length(delta);
        vec3 direction = delta / max(polyline.run, 1e-30);
        while (i < polyline.count && all_points_shown() && goes_straight(from, direction, here, walk_point)) {
            here = walk_point;
            polyline.last_run = ahead;
            polyline.run += length(ahead);
            ahead = walk_ahead(++i);
        }
        if (polyline.count > 1u) polyline.steps = float(i - first);
#endif
        Vertex to = vertex_of(here);
        bool start = first == 0u && polyline.begin, cap = i == polyline.count && polyline.end;
        bool drawn = mask_segment(first, start, cap);
        start_segment(first, to.local, delta, ahead);
        ClippedSegment piece;
        bool any_part = piece_of(from, to, start, cap, piece);
        if (any_part && drawn) take(Segment(first, from, to, piece, polyline.steps, ahead, goes_on(i)));
        from = to;
    }
    pen = from;
    pen_at = i - 1u;
}

// Draws fiblet f and the segment that joins it to the next.
void draw_fiblet(uint f) {
    begin_drawing(f);
#if FEATURE_LINE_ENDS
    draw_until(polyline.end ? polyline.count : 1u);   // all that lies before the line's end is only decoded
#else
    draw_until(polyline.count);
#endif
}
