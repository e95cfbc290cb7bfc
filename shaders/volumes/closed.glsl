// Faces of the volume's box close surfaces: what is at least an isovalue there is inside of its surface.

// The greatest isovalue that a face closes; -3e38 for none.
float closed_value(float at_face) {
    float found = -3e38;
    for (int k = 0; k < isovalue_count; ++k) {
        if (isovalues[k] <= at_face) found = max(found, isovalues[k]);
    }
    return found;
}

// The axis, by voxels, of the face on which a place lies.
vec3 axis_of_face(vec3 p) {
    vec3 away = min(abs(p - box_low), abs(p - box_high));
    if (away.x <= min(away.y, away.z)) return vec3(1.0, 0.0, 0.0);
    return away.y <= away.z ? vec3(0.0, 1.0, 0.0) : vec3(0.0, 0.0, 1.0);
}
