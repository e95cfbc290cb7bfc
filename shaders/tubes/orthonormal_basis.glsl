// Two directions across a unit vector and each other (Duff et al. 2017, "Building an orthonormal basis, revisited").

void across(vec3 d, out vec3 y_axis, out vec3 z_axis) {
    float side = d.z >= 0.0 ? 1.0 : -1.0, a = -1.0 / (side + d.z), b = d.x * d.y * a;
    y_axis = vec3(1.0 + side * d.x * d.x * a, side * b, -side * d.x);
    z_axis = vec3(b, side + d.y * d.y * a, -d.y);
}
