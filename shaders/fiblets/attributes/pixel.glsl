// What the G-buffer says of a pixel beside its depth (pvfiblets/engine/gbuffer.py): streamline, tangent, place along the
// streamline, and the per-point value if the style asks for one.
//
// Use: begin_pixels(f) once for a fiblet, start_segment() before the pixels of each of its segments, then pixel_ids and
// pixel_place(segment, t) for every pixel.

#include "fiblets/attributes/streamline_index.glsl"
#include "fiblets/attributes/values.glsl"
#include "frame/tangent.glsl"

uvec2 pixel_ids;           // streamline; tangent
float pixel_first_point;   // index within the streamline of the fiblet's anchor

void begin_pixels(uint f) {
    pixel_ids = uvec2(streamline_of(f), 0u);  // +x, where a streamline has no length
    pixel_first_point = float(points_before(f));
    begin_values(f);
}

float pixel_steps;         // how many steps from point to point the segment stands for: more than one in far views

// A segment of no length keeps the tangent of the one before it.
void start_segment(uint segment, vec3 delta, float steps) {
    pixel_ids.y = packed_tangent(delta, pixel_ids.y);
    pixel_steps = steps;
    start_values(segment, delta, steps);
}

// A segment that stands for a whole fiblet counts its points as if they were evenly spread.
vec2 pixel_place(uint segment, float t) {
    float at = t * pixel_steps, whole = floor(clamp(at, 0.0, max(pixel_steps - 1.0, 0.0)));
    return vec2(pixel_first_point + float(segment) + at, value_along(segment, t, uint(whole), at - whole));
}
