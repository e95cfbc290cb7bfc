// The part of a segment that is drawn: inside the view volume and on the kept side of the caller's planes, in the window.
// All pipelines clip by this file: where a line is cut decides which pixels it takes.
//
// Clipping is as costly as all else together, so that the compute pipeline has three programs, for the classes of fiblets
// that the cull pass tells apart:
//   inside all planes                  no clipping
//   inside the near and far planes     FEATURE_CLIPPING: in the window, where it takes four products
//   the others                         FEATURE_CLIPPING and FEATURE_CLIPPING_DEPTH: in homogeneous coordinates,
//                                      and with FEATURE_CLIP_PLANES against the planes of the caller's
//
// Symbols
//   a, b         ends of the part: x, y in pixels, z depth, w clip w
//   t0, t1       where they lie on the segment
//   start, cap   the line starts at a, ends at b: nothing is drawn before or after that this part would be joined to; with
//                FEATURE_LINE_ENDS: a, or b, is an end of the streamline, and not cut away
//   s, u         positions along the part in the window, where depth is linear, and along the segment in space
//
// Tubes are not clipped: every pixel of their outline (fiblets/segments/line_tube.glsl) is tested. Their a, b, t0 and t1 are
// the ends of the axis within the outline.

#include "frame/project.glsl"
#include "frame/clip_planes.glsl"
#if FEATURE_TUBES
#include "fiblets/segments/line_tube.glsl"
#endif

// A point of a polyline on its way to pixels.
struct Vertex {
    vec3 local;      // mm
    vec4 clip;       // homogeneous window coordinates
    vec4 window;
    bool inside;     // nothing is cut away there
};

struct ClippedSegment {
    vec4 a;
    vec4 b;
    float t0;
    float t1;
    bool start;
    bool cap;
    float reach;    // of tubes: pixels away from a b
    bool thin;      // tubes that may be thinner than a pixel
};

Vertex vertex_of(vec3 p) {
    precise vec4 clip = to_homogeneous(p);
    precise vec4 window = to_window(clip);
    bool inside = true;
#if FEATURE_CLIPPING_DEPTH
    inside = in_volume(clip) && on_kept_side(p);
#endif
    return Vertex(p, clip, window, inside);
}

// Whether a part begins, or ends, as its segment does, or where it is cut.
bool end_of_part(bool end, bool is_cut) {
#if FEATURE_LINE_ENDS
    return end && !is_cut;
#else
    return end || is_cut;
#endif
}

ClippedSegment cut_piece(vec4 a, vec4 b, float t0, float t1, ClippedSegment whole) {
    return ClippedSegment(a, b, t0, t1, end_of_part(whole.start, t0 > 0.0), end_of_part(whole.cap, t1 < 1.0), 0.0, false);
}

// Each of the next returns false if nothing of the segment is left.

bool clip_in_space(Vertex from, Vertex to, inout ClippedSegment piece) {
    if (from.inside && to.inside) return true;
    float t0, t1;
    if (!clip_segment(from.clip, to.clip, t0, t1)) return false;
    if (!clip_by_planes(from.local, to.local, t0, t1)) return false;
    if (t0 > 0.0) piece.a = to_window(from.clip + t0 * (to.clip - from.clip));
    if (t1 < 1.0) piece.b = to_window(from.clip + t1 * (to.clip - from.clip));
    piece = cut_piece(piece.a, piece.b, t0, t1, piece);
    return true;
}

bool clip_in_window(Vertex from, Vertex to, inout ClippedSegment piece) {
    float t0, t1;
    bool any_part = clip_window(from.window.xy, to.window.xy, t0, t1);
    precise vec4 run = to.window - from.window, a = from.window + t0 * run, b = t1 < 1.0 ? from.window + t1 * run : to.window;
    piece = cut_piece(a, b, t0, t1, piece);
    return any_part;
}

bool piece_of(Vertex from, Vertex to, bool start, bool cap, out ClippedSegment piece) {
    piece = ClippedSegment(from.window, to.window, 0.0, 1.0, start, cap, 0.0, false);
#if FEATURE_TUBES
    Outline outline;
    bool any_part = outline_of(from.clip, to.clip, outline);
    piece = ClippedSegment(outline.a, outline.b, outline.t0, outline.t1, start, cap, outline.reach, outline.thin);
    return any_part;
#elif FEATURE_CLIPPING_DEPTH
    return clip_in_space(from, to, piece);
#elif FEATURE_CLIPPING
    return clip_in_window(from, to, piece);
#else
    return true;
#endif
}

bool piece_of(vec3 from, vec3 to, bool start, bool cap, out ClippedSegment piece) {
    return piece_of(vertex_of(from), vertex_of(to), start, cap, piece);
}

// From s to u; w: clip w at both ends of what s runs along.
float corrected(float s, vec2 w) {
    return clamp(s * w.x / max((1.0 - s) * w.y + s * w.x, 1e-30), 0.0, 1.0);
}

float along_segment(Vertex from, Vertex to, ClippedSegment piece, float s) {
#if FEATURE_TUBES
    return s;
#elif FEATURE_CLIPPING_DEPTH
    return mix(piece.t0, piece.t1, corrected(s, vec2(piece.a.w, piece.b.w)));
#elif FEATURE_CLIPPING
    return corrected(mix(piece.t0, piece.t1, s), vec2(from.window.w, to.window.w));
#else
    return corrected(s, vec2(piece.a.w, piece.b.w));
#endif
}
