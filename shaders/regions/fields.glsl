// Closed surfaces and label volumes by their distance fields (pvfiblets/query/regions/fields.py): a texel holds a lower bound of
// the distance from its centre to the nearest place where inside and outside change, positive inside. From a texel g at a
// distance |q - g| of a ball's centre q, the ball of radius r is sure where |d| - |q - g| > r.
//
// Of label volumes a texel is a voxel: what does not reach across its faces is as the voxel is.

#if FEATURE_REGION_FIELDS
uniform sampler3D region_fields;  // all fields of a region

int region_field_ball(int leaf, vec3 centre, float radius) {
    vec3 slack, u = region_unit(leaf, centre, slack), pace = region_field_steps[leaf];
    vec3 top = vec3(region_field_shapes[leaf] - 1);
    float margin = radius * region_whole_slopes[leaf] + length(slack * pace);
    // Outside of the grid there is no field; the texels at its edge reach half a step further.
    vec3 beyond = max(abs(u - 0.5 * top) - (0.5 * top + 0.5), 0.0);
    if (length(beyond * pace) * (1.0 - REGION_ROUNDING) > margin) return -1;
    vec3 g = clamp(floor(u + 0.5), vec3(0.0), top);
    ivec3 texel = clamp(ivec3(g), ivec3(0), region_field_shapes[leaf] - 1);  // g may be no number
    float d = texelFetch(region_fields, region_field_corners[leaf] + texel, 0).x;
    int side = d > 0.0 ? 1 : -1;
    if (abs(d) * (1.0 - REGION_ROUNDING) - length((u - g) * pace) * (1.0 + REGION_ROUNDING) > margin) return side;
    vec3 reach = abs(u - g) + slack + radius * region_slopes[leaf];
    if (region_kinds[leaf] == REGION_LABELS && all(lessThan(reach, vec3(0.5)))) return side;
    return 0;
}

// A capsule by the ball around it, or by four balls along it.
int region_field_capsule(int leaf, vec3 a, vec3 b, float radius) {
    float half_length = 0.5 * distance(a, b);
    int side = region_field_ball(leaf, 0.5 * (a + b), radius + half_length);
    if (side != 0 || half_length <= 0.5 * radius) return side;
    float piece = radius + 0.25 * half_length;
    side = region_field_ball(leaf, mix(a, b, 0.125), piece);
    for (int k = 1; k < 4 && side != 0; ++k) {
        if (region_field_ball(leaf, mix(a, b, 0.125 + 0.25 * float(k)), piece) != side) side = 0;
    }
    return side;
}
#endif
