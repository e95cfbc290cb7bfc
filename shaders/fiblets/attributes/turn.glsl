// Curvature of a polyline at a point: the angle between the segments before and after it, over half of their joint length
// (1/mm). A segment of no length turns nothing. 2 atan(|a - b|, |a + b|) of unit vectors keeps its digits at all angles.

float turn(vec3 a, vec3 b) {
    float la = length(a), lb = length(b);
    if (la == 0.0 || lb == 0.0) return 0.0;
    a /= la;
    b /= lb;
    return 4.0 * atan(length(a - b), length(a + b)) / (la + lb);
}
