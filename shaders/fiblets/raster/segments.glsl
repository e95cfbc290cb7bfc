// Draws one fiblet's polyline into pixels, segment by segment.
//
// The including pass defines
//   void plot(ivec2 pixel, float z, float s, uint segment)
//                z: window depth; s: position along the *clipped* segment in the window (along() corrects it)
//   void start_segment(uint segment, vec3 delta, float steps)   called before the pixels of a segment; steps from point
//                to point that it stands for: 1, or 0 for a single point, or all of a far fiblet's
//
// Thin lines (one pixel): the pixels of fiblets/raster/cells.glsl.
//
// Wide lines. All pixels whose centre is at most half the width from the segment: a capsule, whose round ends join
// segments without notches. The round end at a segment's start is left out where another segment ends: it is that one's.
//
// Clipping is as costly as all else together, so that three programs share the fiblets, as the cull pass found them:
//   inside all planes                  no clipping
//   inside the near and far planes     FEATURE_CLIPPING: in the window, where it takes four products
//   the others                         FEATURE_CLIPPING and FEATURE_CLIPPING_DEPTH: in homogeneous coordinates,
//                                      and with FEATURE_CLIP_PLANES against the planes of the caller's
//
// At a plane of the caller's a thin line ends in the pixel of the cut. A wide line ends in a round brush, of which the
// pixels are left out that lie beyond a plane at the depth that they show: a cut seen from the side is a straight edge,
// and a line cut head-on shows the whole brush.
//
// Depth is interpolated in the window, where it is linear; everything else is corrected for perspective.
//
// Tubes (FEATURE_TUBES): the pixels and depths of fiblets/raster/tube.glsl, which needs no clipping: s is then the position along the
// segment in space.
//
// With FEATURE_CROSS_LINE the including pass finds in `across_here` (wide lines) or `normal_here` (tubes) what the G-buffer's
// texture `across` says of the pixel that it plots (pvfiblets/engine/gbuffer.py).

#include "fiblets/decode/sequential.glsl"
#include "frame/project.glsl"
#include "fiblets/raster/cells.glsl"
#include "culling/bounds.glsl"
#include "frame/clip_planes.glsl"

#include "fiblets/data/point_mask.glsl"
#include "fiblets/raster/peel.glsl"
#if FEATURE_TUBES
#include "fiblets/raster/tube.glsl"
#endif

#if FEATURE_CROSS_LINE
#if FEATURE_TUBES
vec3 normal_here;
#else
float across_here;
#endif
#endif

void plot(ivec2 pixel, float z, float s, uint segment);
void start_segment(uint segment, vec3 delta, float steps);

// Plots a pixel, unless it does not lie behind the layers drawn so far. Whether the caller's region cuts it away is for
// fiblets/compute/depth.comp to ask, and only of what would show: the later passes look for depths that were kept.
void put(ivec2 pixel, float z, float s, uint segment) {
#if FEATURE_PEEL
    if (!behind_layers(pixel, depth_key(z))) return;
#endif
    plot(pixel, z, s, segment);
}

// The segment being drawn, for along(): clip w at both ends, and what was left of it by clipping.
vec4 clipped = vec4(1.0, 1.0, 0.0, 1.0);

float along(float s) {
#if FEATURE_TUBES
    return s;
#else
#if FEATURE_CLIPPING && !FEATURE_CLIPPING_DEPTH
    s = mix(clipped.z, clipped.w, s);  // clipped in the window, before perspective is corrected
#endif
    float u = clamp(s * clipped.x / max((1.0 - s) * clipped.y + s * clipped.x, 1e-30), 0.0, 1.0);
#if FEATURE_CLIPPING_DEPTH
    u = mix(clipped.z, clipped.w, u);  // clipped in space
#endif
    return u;
#endif
}

#if FEATURE_CLIP_PLANES && FEATURE_WIDE_LINES
// h / w above every plane at both ends of the segment being drawn. It is linear in the window, so that no division is
// left to do at a pixel.
vec2 clip_heights[{{ max_clip_planes }}];

void start_heights(vec3 a, vec3 b, vec4 e0, vec4 e1, float t0, float t1) {
    for (int plane = 0; plane < clip_count(); ++plane) {
        precise float ha = clip_height_of(plane, a), hb = clip_height_of(plane, b);
        precise vec2 h = vec2(ha + t0 * (hb - ha), ha + t1 * (hb - ha)) / max(vec2(e0.w, e1.w), vec2(1e-30));
        clip_heights[plane] = max(h, vec2(0.0));
    }
}

// Whether a pixel, `away` from the point s of the segment, is on the kept side of all planes.
bool brush_kept(float s, vec2 away) {
    for (int plane = 0; plane < clip_count(); ++plane) {
        precise float h = clip_heights[plane].x + s * (clip_heights[plane].y - clip_heights[plane].x);
        precise float there = h + dot(clip_tilts[plane].xy, away);
        if (there < 0.0) return false;
    }
    return true;
}
#endif

#if FEATURE_WIDE_LINES && !FEATURE_TUBES
uniform uvec2 share;  // of every fiblet: first segment, and the one after the last; see pipelines/compute.py
#endif

#if FEATURE_TUBES
void draw_tube(vec3 from, vec3 to, vec4 c0, vec4 c1, uint segment, bool start) {
    Outline outline;
    if (!outline_of(c0, c1, outline)) return;
    Tube body = tube_of(from, to, c0, start);
    float r = outline.reach;
    vec2 run = outline.b.xy - outline.a.xy;
#if FEATURE_PEEL
    peel_segment(outline.a.xy, outline.b.xy, r, peel_steps);
#endif
    bool steep = abs(run.y) > abs(run.x);
    vec2 a = steep ? outline.a.yx : outline.a.xy, b = steep ? outline.b.yx : outline.b.xy;
    vec2 size = steep ? viewport.yx : viewport.xy;
    float slope = abs(b.x - a.x) > 1e-6 ? (b.y - a.y) / (b.x - a.x) : 0.0, height = r * sqrt(1.0 + slope * slope);
    vec2 ends = vec2(min(a.x, b.x), max(a.x, b.x));
    int column0 = int(max(ceil(ends.x - r - 0.5), 0.0)), column1 = int(min(floor(ends.y + r - 0.5), size.x - 1.0));
    for (int column = column0; column <= column1; ++column) {
        float x = float(column) + 0.5, y = a.y + slope * (clamp(x, ends.x, ends.y) - a.x);
        int row0 = int(max(ceil(y - height - 0.5), 0.0)), row1 = int(min(floor(y + height - 0.5), size.y - 1.0));
        for (int row = row0; row <= row1; ++row) {
            ivec2 pixel = steep ? ivec2(row, column) : ivec2(column, row);
            Hit hit;
            if (tube_at(body, c0, outline, vec2(pixel) + 0.5, hit)) {
#if FEATURE_CROSS_LINE
                normal_here = hit.normal;
#endif
                put(pixel, hit.z, hit.t, segment);
            }
        }
    }
}
#elif FEATURE_WIDE_LINES
void draw_window(vec4 a, vec4 b, uint segment, bool start, bool cap) {
    if (segment < share.x || segment >= share.y) return;
    float r = viewport.z;
    vec2 d = b.xy - a.xy;
#if FEATURE_PEEL
    peel_segment(a.xy, b.xy, r, peel_steps);
#endif
    bool steep = abs(d.y) > abs(d.x);
    vec2 from = steep ? a.yx : a.xy, to = steep ? b.yx : b.xy, size = steep ? viewport.yx : viewport.xy;
    vec2 run = to - from;
    float inverse = 1.0 / max(dot(run, run), 1e-12);
#if FEATURE_CROSS_LINE
    vec2 left = (steep ? vec2(d.x, -d.y) : vec2(-d.y, d.x)) * sqrt(inverse) / r;
#endif
    float slope = abs(run.x) > 1e-6 ? run.y / run.x : 0.0;
    float reach = r * sqrt(1.0 + slope * slope);  // half the capsule's height over a column
    float behind = start ? r : r * min(abs(slope), 1.0), least = start ? -3.0e38 : 0.0;  // columns before the start
    vec2 before = run.x < 0.0 ? vec2(r, behind) : vec2(behind, r);
    int column0 = int(max(ceil(min(from.x, to.x) - before.x - 0.5), 0.0));
    int column1 = int(min(floor(max(from.x, to.x) + before.y - 0.5), size.x - 1.0));
    for (int column = column0; column <= column1; ++column) {
        float x = float(column) + 0.5;
        float y = from.y + slope * (clamp(x, min(from.x, to.x), max(from.x, to.x)) - from.x);
        int row0 = int(max(ceil(y - reach - 0.5), 0.0)), row1 = int(min(floor(y + reach - 0.5), size.y - 1.0));
        for (int row = row0; row <= row1; ++row) {
            vec2 centre = vec2(x, float(row) + 0.5) - from;
            float foot = dot(centre, run) * inverse;
            precise float s = clamp(foot, 0.0, 1.0);
            vec2 away = centre - s * run;
            precise float z = a.z + (b.z - a.z) * s;
            bool covered = foot >= least && dot(away, away) <= r * r;
#if FEATURE_CLIP_PLANES
            covered = covered && brush_kept(s, steep ? away.yx : away);
#endif
#if FEATURE_CROSS_LINE
            across_here = clamp(dot(left, centre), -1.0, 1.0);
#endif
            if (covered) put(steep ? ivec2(row, column) : ivec2(column, row), z, s, segment);
        }
    }
}
#else
void draw_window(vec4 a, vec4 b, uint segment, bool start, bool cap) {
#if FEATURE_CLIPPING
    // A point on the right or upper edge belongs to the last pixel.
    vec2 top = viewport.xy - 0.01;
    ivec2 p = ivec2(clamp(a.xy, vec2(0.0), top)), q = ivec2(clamp(b.xy, vec2(0.0), top));
#else
    ivec2 p = ivec2(a.xy), q = ivec2(b.xy);
#endif
    Cells cells = cells_between(p, q);
    precise vec2 slope = cells.square * (b.z - a.z) * cells.run;
    precise float base = a.z - dot(CELL_SHIFT, slope);
    vec2 per = cells.run * cells.inverse, begin = 0.5 + CELL_SHIFT - cells.shift * per;
    for (int i = 0; i < cells.count; ++i) {
        precise vec2 at = floor(begin + float(i) * per);
        precise float z = base + dot(at, slope);
        put(p + ivec2(at), z, dot(at - CELL_SHIFT, cells.run) * cells.square, segment);
    }
    if (cap) put(q, b.z, 1.0, segment);
}
#endif

// Steps from point to point of a fiblet and the segment that joins it to the next.
float steps_of(uint f) { return float(fiblet_last(decoding_words(f)) + (ends(f) ? 0u : 1u)); }

// Draws fiblet f and the segment that joins it to the next. From far enough (is_one_segment() of culling/bounds.glsl) it is
// one segment, numbered 0, between the ends of its capsule; FEATURE_ONE_SEGMENT: it is known that it is.
void draw_fiblet(uint f) {
    begin_point_mask(f);
#if FEATURE_PEEL && FEATURE_WIDE_LINES
    begin_peel(streamline_of(f), float(points_before(f)));
#endif
#if FEATURE_ONE_SEGMENT || FEATURE_LEVEL_OF_DETAIL
    Capsule capsule = capsule_of(f);
#endif
#if FEATURE_ONE_SEGMENT
    bool begin = begins(f), end = ends(f);
    uint count = 1u, last = 0u;
    float steps = steps_of(f);
    precise vec3 next = capsule.b;
    walk_point = capsule.a;
#else
    walk_begin(f);
    bool begin = begins(f), end = ends(f);
    precise vec3 next = anchor_local(end ? f : f + 1u);
    uint last = walk.last, count = last + (end && last > 0u ? 0u : 1u);  // a single point is a segment of no length
    float steps = end && last == 0u ? 0.0 : 1.0;
#if FEATURE_LEVEL_OF_DETAIL
    if (is_one_segment(capsule) && all_points_shown()) {
        next = capsule.b;
        last = 0u;
        count = 1u;
        steps = steps_of(f);
    }
#endif
#endif
    precise vec4 c0 = to_homogeneous(walk_point);
    precise vec4 s0 = to_window(c0);
#if FEATURE_CLIPPING_DEPTH
    bool inside0 = in_volume(c0);
#if FEATURE_CLIP_PLANES
    inside0 = inside0 && clip_height(walk_point) >= 0.0;
#endif
#endif
    for (uint i = 1u; i <= count; ++i) {
        precise vec3 from = walk_point;
#if !FEATURE_ONE_SEGMENT
        if (i <= last) {
            walk_next(i);
        } else
#endif
        {
            walk_point = next;
            walk_delta = next - from;
        }
        precise vec4 c1 = to_homogeneous(walk_point);
        precise vec4 s1 = to_window(c1);
        bool start = i == 1u && begin, cap = end && i == count;
        bool drawn = mask_segment(i - 1u, start, cap);
        start_segment(i - 1u, walk_delta, steps);
#if FEATURE_PEEL
        peel_steps = steps;
#endif
#if FEATURE_TUBES
        if (drawn) draw_tube(from, walk_point, c0, c1, i - 1u, start);
        c0 = c1;
#elif FEATURE_CLIPPING_DEPTH
        bool inside1 = in_volume(c1);
#if FEATURE_CLIP_PLANES
        inside1 = inside1 && clip_height(walk_point) >= 0.0;
#endif
        float t0 = 0.0, t1 = 1.0;
        precise vec4 e0 = s0, e1 = s1;
        bool any = true;
        if (!(inside0 && inside1)) {
            any = clip_segment(c0, c1, t0, t1);
#if FEATURE_CLIP_PLANES
            any = any && clip_by_planes(from, walk_point, t0, t1);
#endif
            if (t0 > 0.0) e0 = to_window(c0 + t0 * (c1 - c0));
            if (t1 < 1.0) e1 = to_window(c0 + t1 * (c1 - c0));
        }
        clipped = vec4(e0.w, e1.w, t0, t1);
#if FEATURE_CLIP_PLANES && FEATURE_WIDE_LINES
        if (any && drawn) start_heights(from, walk_point, e0, e1, t0, t1);
#endif
        if (any && drawn) draw_window(e0, e1, i - 1u, start || t0 > 0.0, cap || t1 < 1.0);
        inside0 = inside1;
        c0 = c1;
#elif FEATURE_CLIPPING
        float t0, t1;
        bool any = clip_window(s0.xy, s1.xy, t0, t1);
        precise vec4 run = s1 - s0, e0 = s0 + t0 * run, e1 = t1 < 1.0 ? s0 + t1 * run : s1;
        clipped = vec4(s0.w, s1.w, t0, t1);
        if (any) draw_window(e0, e1, i - 1u, start || t0 > 0.0, cap || t1 < 1.0);
#else
        clipped = vec4(s0.w, s1.w, 0.0, 1.0);
        draw_window(s0, s1, i - 1u, start, cap);
#endif
        s0 = s1;
    }
}
