// The octree: how far along a ray there is nothing to see.
// Paper: Lesar 2015, section III.C. Nodes of 8 voxels and up lie in one list, level by level. Traversal is kd-restart: the node
// of a place is found from the root anew each time, the largest that need not be looked into.

#if FEATURE_VOLUME_WHOLE
// Without an octree there is something to see everywhere; rays are taken in the same pieces.
float to_end_of_node(Ray ray, float t, float threshold, out float number) {
    vec3 p = at(ray, t), low = vec3(clamp(ivec3(floor(p)), ivec3(0), ivec3(volume_shape) - 2) >> 3 << 3), high = low + 8.0;
    vec3 out_of = (vec3(ray.d.x < 0.0 ? low.x : high.x, ray.d.y < 0.0 ? low.y : high.y, ray.d.z < 0.0 ? low.z : high.z) - p) * ray.inverse;
    number = 3e38;
    return max(min(out_of.x, min(out_of.y, out_of.z)), 0.0);
}
#else
uniform samplerBuffer nodes;      // one number for each; a node is skipped if it is not above a threshold
#if FEATURE_VOLUME_HOMOGENEOUS
uniform samplerBuffer means;      // of each: where its number is 2 it may be taken as that
float mean_of_node;
#endif

// Mm from t to where that node ends, at least 0; number is the node's.
float to_end_of_node(Ray ray, float t, float threshold, out float number) {
    vec3 p = at(ray, t);
    ivec3 leaf = clamp(ivec3(floor(p)), ivec3(0), ivec3(volume_shape) - 2) >> 3;
    int level = top_level;
    ivec3 node;
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
    vec3 low = vec3(node << (level + 3)), high = low + float(8 << level);
    vec3 out_of = (vec3(ray.d.x < 0.0 ? low.x : high.x, ray.d.y < 0.0 ? low.y : high.y, ray.d.z < 0.0 ? low.z : high.z) - p) * ray.inverse;
    return max(min(out_of.x, min(out_of.y, out_of.z)), 0.0);
}
#endif
