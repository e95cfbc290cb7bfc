// Pixels of a segment, and their depths: main(), which hands each to write(s, edges, z).
//
// The pixels of thin lines: fiblets/segments/thin_line_rule.glsl. Those of wide lines: fiblets/hardware_raster/capsule.frag.

#if FEATURE_WIDE_LINES
#if FEATURE_LINE_ENDS
#include "fiblets/segments/ends.glsl"
#endif
#if FEATURE_CLIP_PLANES
bool brush_kept(float s, vec2 away) {
    for (int plane = 0; plane < clip_plane_count; ++plane) {
        vec2 heights = vec2(clip_height_of(plane, seg_from), clip_height_of(plane, seg_to));
        vec2 h = max(heights / max(vec2(seg_start.w, seg_end.w), vec2(1e-30)), vec2(0.0));
        if (h.x + s * (h.y - h.x) + dot(clip_tilts[plane], away) < 0.0) return false;
    }
    return true;
}
#endif

void main() {
    vec2 run = seg_end.xy - seg_start.xy, centre = gl_FragCoord.xy - seg_start.xy;
#if FEATURE_LINE_ENDS
    bool start = (seg_ids.y & 1u) != 0u, cap = (seg_ids.y & 2u) != 0u;
    float s = end_at(ClippedSegment(seg_start, seg_end, 0.0, 1.0, start, cap, 0.0, false), centre, run, half_line_width);
    if (s < 0.0) discard;
    vec2 away = centre - s * run;
#else
    float foot = dot(centre, run) / max(dot(run, run), 1e-12), s = clamp(foot, 0.0, 1.0);
    vec2 away = centre - s * run;
    if (foot < 0.0 && (seg_ids.y & 1u) == 0u || dot(away, away) > half_line_width * half_line_width) discard;
    if (foot > 1.0 && beyond_joint(seg_onward, centre - run)) discard;
#endif
#if FEATURE_CLIP_PLANES
    if (!brush_kept(s, away)) discard;
#endif
    gl_FragDepth = clamp(seg_start.z + (seg_end.z - seg_start.z) * s, 0.0, 0.99999988);
#if FEATURE_LINE_ENDS
    write(s, capsule_edges(away, vec2(0.0), half_line_width), gl_FragDepth);
#else
    write(s, capsule_edges(centre, run, half_line_width), gl_FragDepth);
#endif
}
#else

void main() {
    vec2 first = pixel_of(seg_start), run = pixel_of(seg_end) - first, at = floor(gl_FragCoord.xy) - first;
    Cells cells = cells_between(ivec2(first), ivec2(first + run));
    bool start = (seg_ids.y & 1u) != 0u, cap = (seg_ids.y & 2u) != 0u, steep = abs(run.y) > abs(run.x);
    float s = 1.0;
    if (at == run) {
        if (!cap) discard;
    } else {
        float major = steep ? at.y : at.x, way = steep ? run.y : run.x, steps = abs(major);
        if (major * way < 0.0 || steps >= float(cells.count)) discard;
        vec2 line = floor(0.5 + CELL_SHIFT + (steps - cells.shift) * cells.inverse * run);
        if (steep ? line.x != at.x : line.y != at.y) discard;
        s = dot(at - CELL_SHIFT, run) * cells.square;
    }
    float z = gl_FragCoord.z;
    if (SPRITES) gl_FragDepth = z = clamp(mix(seg_start.z, seg_end.z, s), 0.0, 0.99999988);
    vec4 ends = vec4(in_picture(seg_start), in_picture(seg_end)), parts = floor((ends - floor(ends)) * 256.0) / 256.0;
    write(s, thin_edges(ivec2(first), ivec2(first + run), at, parts, start, cap), z);
}
#endif
