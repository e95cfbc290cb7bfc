// The direction of a line where all lines of a pixel are added up: that of the segment, as a unit vector. Among many lines on each
// other, its jumps between segments are invisible.

vec3 run_direction(vec3 run) {
    float square = dot(run, run);
    return square > 0.0 ? run * inversesqrt(square) : vec3(1.0, 0.0, 0.0);
}
