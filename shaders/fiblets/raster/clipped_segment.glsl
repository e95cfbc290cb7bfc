// The part of a segment that is drawn: inside the view volume and on the kept side of the caller's planes, in the window.
// fiblets/raster/segments.glsl clips the same way for the compute pipeline and must agree: where a line is cut decides which pixels
// it takes.
//
// Symbols
//   a, b         ends of the part: x, y in pixels, z depth, w clip w
//   t0, t1       where they lie on the segment
//   start, cap   the line starts at a, ends at b: nothing is drawn before or after that this part would be joined to

//
// Tubes are not clipped: what their outline (fiblets/raster/tube.glsl) reaches is looked at pixel by pixel, and a, b are the ends of the
// part of the axis that it is around.

#include "frame/project.glsl"
#include "frame/clip_planes.glsl"
#if FEATURE_TUBES
#include "fiblets/raster/tube.glsl"
#endif

struct Piece {
    vec4 a;
    vec4 b;
    float t0;
    float t1;
    bool start;
    bool cap;
#if FEATURE_TUBES
    float reach;    // pixels away from a b
#endif
};

// False if nothing is left.
bool piece_of(vec3 from, vec3 to, bool start, bool cap, out Piece piece) {
    precise vec4 c0 = to_homogeneous(from), c1 = to_homogeneous(to);
#if FEATURE_TUBES
    Outline outline;
    bool any = outline_of(c0, c1, outline);
    piece = Piece(outline.a, outline.b, 0.0, 1.0, start, cap, outline.reach);
    return any;
#else
    piece = Piece(to_window(c0), to_window(c1), 0.0, 1.0, start, cap);
#if FEATURE_CLIPPING
    bool inside = in_volume(c0) && in_volume(c1);
#if FEATURE_CLIP_PLANES
    inside = inside && clip_height(from) >= 0.0 && clip_height(to) >= 0.0;
#endif
    if (inside) return true;
    float t0, t1;
    if (!clip_segment(c0, c1, t0, t1)) return false;
#if FEATURE_CLIP_PLANES
    if (!clip_by_planes(from, to, t0, t1)) return false;
#endif
    if (t0 > 0.0) piece.a = to_window(c0 + t0 * (c1 - c0));
    if (t1 < 1.0) piece.b = to_window(c0 + t1 * (c1 - c0));
    piece = Piece(piece.a, piece.b, t0, t1, start || t0 > 0.0, cap || t1 < 1.0);
#endif
    return true;
#endif
}
