// To which sum of its pixel a line adds: without FEATURE_GATHER_SLICES there is one, of all lines. Else the nearest line is in
// none, and the others are told apart by how far behind it they are, in slices that grow with that distance
// (pvfiblets/engine/fiblets/gathering.py).
//
// Symbols
//   key          depth key; c = 1 - window depth, formed on the integers, as float32 loses the digits of far points
//   d            distance along the view, linear in space: (p + q c) / (r + s c), mm or what w counts
//   u            0 at the pixel's nearest line, 1 at the far end of the data
//   edges        of the slices in u

#if FEATURE_GATHER_SLICES
uniform usampler2D nearest_depth;
uniform usampler2D nearest_owner;
uniform vec4 slice_distances;      // p, q, r, s
uniform float slice_far;           // d at u = 1
uniform vec3 slice_edges;          // between the first and the second slice, and so on

float slice_distance(uint key) {
    float c = float(0xFFFFFFFFu - key) / 4294967295.0;
    return (slice_distances.x + slice_distances.y * c) / (slice_distances.z + slice_distances.w * c);
}
#endif
#if FEATURE_GATHER_OUTSIDE
uniform usampler2D outside_depth;  // of what hides lines, keys
#endif

// -1: to none.
int slice_of(ivec2 pixel, uint key, uint owner) {
#if FEATURE_GATHER_OUTSIDE
    if (key > texelFetch(outside_depth, pixel, 0).x) return -1;
#endif
#if FEATURE_GATHER_SLICES
    uint first = texelFetch(nearest_depth, pixel, 0).x;
    if (key == first && owner == texelFetch(nearest_owner, pixel, 0).x) return -1;
    float near = slice_distance(first), u = (slice_distance(key) - near) / max(slice_far - near, 1e-20);
    return int(u > slice_edges.x) + int(u > slice_edges.y) + int(u > slice_edges.z);
#else
    return 0;
#endif
}
