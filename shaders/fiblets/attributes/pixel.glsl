// Contents of the G-buffer for a pixel, beside its depth (pvfiblets/engine/gbuffer.py): streamline, tangent, place along the
// streamline, and the per-point value if the style asks for one.
//
// Use: begin_pixels(f) once for a fiblet, before it is walked along; start_segment() before the pixels of each of its segments;
// then pixel_ids(t) and pixel_place(segment, t) for every pixel.

#include "fiblets/attributes/streamline_index.glsl"
#include "fiblets/attributes/values.glsl"
#include "fiblets/attributes/walked_tangents.glsl"

uint pixel_streamline;
float pixel_first_point;   // index within the streamline of the fiblet's anchor

void begin_pixels(uint f) {
    pixel_streamline = streamline_of(f);
    pixel_first_point = float(points_before(f));
    begin_values(f);
    begin_tangents(f);
}

void start_segment(uint segment, vec3 to, vec3 delta, vec3 ahead) {
    start_tangents(segment, delta, ahead);
    start_values(segment, to, delta, polyline.steps);
}

// Streamline; tangent.
uvec2 pixel_ids(float t) { return uvec2(pixel_streamline, packed_tangent(tangent_between(tangents, t), 0u)); }

// A segment that stands for a whole fiblet counts its points as if they were evenly spread.
vec2 pixel_place(uint segment, float t) {
    float at = t * polyline.steps, whole = floor(clamp(at, 0.0, max(polyline.steps - 1.0, 0.0)));
    return vec2(pixel_first_point + float(segment) + at, value_along(segment, t, uint(whole), at - whole));
}
