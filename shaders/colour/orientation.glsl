// Direction-encoded colour: |tangent| in data coordinates as red (left-right), green (back-front),
// blue (down-up). The tangent is a unit vector, so the brightest channel is never below 0.57.

vec4 line_colour(uint streamline, vec3 tangent, float value) { return vec4(abs(tangent), 1.0); }
