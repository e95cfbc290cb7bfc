// What the last stage before the rasteriser hands to the fragments of a segment. The including stage says which way:
// `#define VARYING flat out`, or `flat in` for the fragment stage. OpenGL's last vertex decides (its default), so that the
// vertices of a strip carry the segment that ends there. A mesh stage has primitives carry it (shaders/fiblets/mesh/outputs.glsl), and
// declares arrays: `#define EACH []`. Nothing is interpolated by OpenGL: fragments compute depth and place from their
// pixel, which is the same on all drivers and in all pipelines.
//
// A picture of the nearest lines is a visibility buffer (Burns and Hunt, "The Visibility Buffer: A Cache-Friendly Approach to Deferred
// Shading", JCGT 2(2), 2013): fragments keep depth, fiblet and segment, and fiblets/hardware_raster/resolve.frag finds all else once for each pixel.
// Lines that are added up show all at once: their fragments are handed what colours read.
//
// Budget: how many components a vertex has, its position included, decides how many vertices a geometry stage may emit
// (pvfiblets/engine/fiblets/pipelines/geometry.py).
//
//                        thin lines   wide lines   tubes
//   position                  4            4         4
//   varying_ids               2            2         2
//   varying_cells, _depths    4            0         0
//   varying_start, _end       0            8         0
//   varying_onward            0            1         0
//   varying_from, _to         0            6         6     of wide lines, at planes of the caller's
//   varying_ahead             0            0         3     at a region of the caller's
//   varying_first             0            1         1     behind layers, and in slices
//   varying_streamline        1            1         1     the same, and where colours are added up
//   varying_tangent           1            1         1     where colours are added up
//   varying_ratio             1            0         0     the same
//   varying_part              1            1         0     the same, where segments may be cut
//   varying_values            2            2         2     the same, with some per-point values

#ifndef EACH
#define EACH
#endif

VARYING uvec2 varying_ids EACH;      // fiblet counted over all chunks; segment, its steps in bits 8 to 15, and whether the streamline
                                   // starts here in bit 16, ends in bit 17
#if FEATURE_TUBES
VARYING vec3 varying_from EACH;      // ends of the segment, local mm
VARYING vec3 varying_to EACH;
#if FEATURE_CLIP_REGION
VARYING vec3 varying_ahead EACH;     // the next segment's run: fiblets/segments/line_tube.glsl
#endif
#else
#if FEATURE_WIDE_LINES
VARYING vec4 varying_start EACH;     // ends of the part that is drawn: window x, y; depth; clip w
VARYING vec4 varying_end EACH;
VARYING uint varying_onward EACH;    // which way the line goes on from there: fiblets/segments/joint.glsl
#else
VARYING uvec2 varying_cells EACH;    // pixels of its ends, x in the lower half
VARYING vec2 varying_depths EACH;    // and their depths
#endif
#if FEATURE_WIDE_LINES && FEATURE_CLIP_PLANES
VARYING vec3 varying_from EACH;      // the part's ends, local mm
VARYING vec3 varying_to EACH;
#endif
#endif
#if FEATURE_PAINTED || FEATURE_WIDE_LINES && (FEATURE_PEEL || FEATURE_GATHER_SLICES)
VARYING uint varying_streamline EACH;
#endif
#if FEATURE_WIDE_LINES && (FEATURE_PEEL || FEATURE_GATHER_SLICES)
VARYING float varying_first EACH;    // index of the fiblet's first point within the streamline
#endif
#if FEATURE_PAINTED
VARYING uint varying_tangent EACH;
#if !FEATURE_WIDE_LINES
VARYING float varying_ratio EACH;    // clip w at the part's start over that at its end: corrects perspective
#endif
#if FEATURE_CLIPPING && !FEATURE_TUBES
VARYING uint varying_part EACH;      // which part of the segment it is: start and end in 65535ths, rounded inwards
#endif
#if FEATURE_VALUES_ARC_LENGTH || FEATURE_VALUES_VOLUME
VARYING vec2 varying_values EACH;    // at the segment's ends
#endif
#endif
