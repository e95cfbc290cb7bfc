// The default light of lines (shaders/resolve/line_light.glsl has its rules): what the nearest line, sums of lines and pages share.

const float GENTLE_FLOOR = 0.8;   // of its colour, that every line keeps
const vec3 SHOULDER = vec3(-0.57735027, 0.57735027, 0.57735027);   // whence the camera's lights come, in view coordinates

// Share of a light in direction d that falls on a line: 1 - (L.T)^4.
float across_line(vec3 tangent, vec3 d) {
    float along = dot(tangent, d);
    along *= along;
    return max(0.0, 1.0 - along * along);
}

float gentle_light(float share) { return mix(GENTLE_FLOOR, 1.0, share); }
