// Length in the window of a step in space.

#include "frame/project.glsl"

vec3 window_gradient(int row) { return vec3(window_from_local[0][row], window_from_local[1][row], window_from_local[2][row]); }

// |J|, the largest stretch of a step in space to a step in the window, at W = 1.
float pixel_derivative_at(vec2 s) {
    vec3 w = window_gradient(3), x = window_gradient(0) - s.x * w, y = window_gradient(1) - s.y * w;
    float p = dot(x, x), q = dot(y, y), m = dot(x, y), half_difference = 0.5 * (p - q);
    return sqrt(0.5 * (p + q) + sqrt(half_difference * half_difference + m * m));
}
