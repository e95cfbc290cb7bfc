// A pixel of a wide line, as fiblets/compute/software_raster/segments.glsl finds it for the compute pipeline: its centre is at most half the width from
// the segment; the round end at a segment's start is left out where another segment ends, for it is that one's; what lies
// beyond a plane of the caller's at the depth that it shows is left out. A pixel of a tube: fiblets/segments/line_tube.glsl.

#version 430
#if FEATURE_PER_PRIMITIVE
#include "fiblets/mesh/fragment_extension.glsl"
#endif

#include "codec/layout.glsl"
#include "fiblets/hardware_raster/shade.glsl"
#include "frame/clip_planes.glsl"

#if FEATURE_TUBES
#include "fiblets/segments/line_tube.glsl"
#endif
#if FEATURE_TUBES
void main() {
    precise vec4 c0 = to_homogeneous(varying_from), c1 = to_homogeneous(varying_to);
#if FEATURE_CLIP_REGION
    vec3 ahead = varying_ahead;
#else
    vec3 ahead = vec3(0.0);
#endif
    Tube body = tube_of(varying_from, varying_to, c0, (varying_ids.y & 0x10000u) != 0u, (varying_ids.y & 0x20000u) != 0u, ahead);
    Hit hit;
#if FEATURE_PEEL || FEATURE_GATHER_SLICES
    Outline outline;
    if (!outline_of(c0, c1, outline) || !tube_at(body, c0, outline, gl_FragCoord.xy, hit)) discard;
    peel_segment(outline.a.xy, outline.b.xy, outline.reach, float((varying_ids.y >> 8u) & 255u));
#else
    if (!tube_found(body, c0, c1, gl_FragCoord.xy, hit)) discard;
#endif
    shade(hit.t, 1.0, hit.z);
}
#else
#if FEATURE_LINE_ENDS
#include "fiblets/segments/clipped_segment.glsl"
#include "fiblets/segments/ends.glsl"
#else
#include "fiblets/segments/joint.glsl"
#endif

#if FEATURE_CLIP_PLANES
// Heights over clip w are linear in the window; `away` is how far the pixel is from the segment's point s.
bool brush_kept(float s, vec2 away) {
    for (int plane = 0; plane < clip_plane_count; ++plane) {
        vec2 heights = vec2(clip_height_of(plane, varying_from), clip_height_of(plane, varying_to));
        precise vec2 h = max(heights / max(vec2(varying_start.w, varying_end.w), vec2(1e-30)), vec2(0.0));
        precise float there = h.x + s * (h.y - h.x) + dot(clip_tilts[plane], away);
        if (there < 0.0) return false;
    }
    return true;
}
#endif

void main() {
    vec2 run = varying_end.xy - varying_start.xy, centre = gl_FragCoord.xy - varying_start.xy;
#if FEATURE_LINE_ENDS
    bool start = (varying_ids.y & 0x10000u) != 0u, cap = (varying_ids.y & 0x20000u) != 0u;
    float s = end_at(ClippedSegment(varying_start, varying_end, 0.0, 1.0, start, cap, 0.0, false), centre, run, half_line_width);
    if (s < 0.0) discard;
    vec2 away = centre - s * run;
#else
    float foot = dot(centre, run) * (1.0 / max(dot(run, run), 1e-12));
    precise float s = clamp(foot, 0.0, 1.0);
    vec2 away = centre - s * run;
    if (foot < 0.0 && (varying_ids.y & 0x10000u) == 0u || dot(away, away) > half_line_width * half_line_width) discard;
    if (foot > 1.0 && beyond_joint(unpacked_onward(varying_onward), centre - run)) discard;
#endif
#if FEATURE_CLIP_PLANES
    if (!brush_kept(s, away)) discard;
#endif
    precise float depth = varying_start.z + (varying_end.z - varying_start.z) * s;
    shade(s, varying_start.w / varying_end.w, depth);
}
#endif
