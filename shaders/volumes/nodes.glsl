// The octree: how far along a ray there is nothing to see.
// Paper: Lesar 2015, section III.C. Nodes of 8 voxels and up lie in one list, level by level. Traversal is kd-restart: the node
// of a place is found from the root anew each time, the largest that need not be looked into.

#if FEATURE_VOLUME_WHOLE
// Without an octree there is something to see everywhere; rays are taken in the same pieces.
float node_of(ivec3 cell, float threshold, out ivec3 low, out ivec3 high) {
    low = cell >> 3 << 3;
    high = low + 8;
    return 3e38;
}
#else
uniform samplerBuffer nodes;      // one number for each; a node is skipped if it is not above a threshold
#if FEATURE_VOLUME_HOMOGENEOUS
uniform samplerBuffer means;      // of each: where its number is 2 it may be taken as that
float mean_of_node;
#endif

// The number of the node of a cell, which is that of all from low to before high.
float node_of(ivec3 cell, float threshold, out ivec3 low, out ivec3 high) {
    ivec3 leaf = cell >> 3, node;
    int level = top_level;
    float number;
    for (;;) {
        node = leaf >> level;
        ivec3 shape = octree_shapes[level];
        int place = octree_starts[level] + node.x + shape.x * (node.y + shape.y * node.z);
        number = texelFetch(nodes, place).x;
#if FEATURE_VOLUME_HOMOGENEOUS
        mean_of_node = texelFetch(means, place).x;
        if (number > 1.5) break;
#endif
        if (number <= threshold || level == 0) break;
        --level;
    }
    low = node << (level + 3);
    high = low + (8 << level);
    return number;
}
#endif

// Mm from t to where the node there ends, at least 0; number is the node's.
float to_end_of_node(Ray ray, float t, float threshold, out float number) {
    vec3 p = at(ray, t);
    ivec3 low, high;
    number = node_of(clamp(ivec3(floor(p)), ivec3(0), ivec3(volume_shape) - 2), threshold, low, high);
    vec3 out_of = (mix(vec3(high), vec3(low), lessThan(ray.d, vec3(0.0))) - p) * ray.inverse;
    return max(min(out_of.x, min(out_of.y, out_of.z)), 0.0);
}
