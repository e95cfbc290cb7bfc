// What the G-buffer says of a pixel beside its depth (pvfiblets/engine/gbuffer.py): streamline, tangent, place along the
// streamline, and the per-point value if the style asks for one.
//
// Use: begin_pixels(f) once for a fiblet, start_segment() before the pixels of each of its segments, the walk at its end;
// then pixel_ids(t) and pixel_place(segment, t) for every pixel.

#include "fiblets/attributes/place.glsl"
#include "fiblets/attributes/values.glsl"
#include "fiblets/attributes/walked_tangents.glsl"

uint pixel_streamline;
float pixel_first_point;   // index within the streamline of the fiblet's anchor

void begin_pixels(uint f) {
    pixel_streamline = streamline_of(f);
    pixel_first_point = float(points_before(f));
    begin_values(f);
}

float pixel_steps;         // how many steps from point to point the segment stands for: more than one in far views

void start_segment(uint segment, vec3 delta, float steps) {
    start_tangents(segment, delta);
    pixel_steps = steps;
    start_values(segment, delta, steps);
}

// Streamline; tangent.
uvec2 pixel_ids(float t) { return uvec2(pixel_streamline, packed_tangent_between(tangents(), t)); }

// A segment that stands for a whole fiblet counts its points as if they were evenly spread.
vec2 pixel_place(uint segment, float t) {
    float at = t * pixel_steps, whole = floor(clamp(at, 0.0, max(pixel_steps - 1.0, 0.0)));
    return vec2(pixel_first_point + float(segment) + at, value_along(segment, t, uint(whole), at - whole));
}
