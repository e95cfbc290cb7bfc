// Beginnings of the slices of each pixel (pvfiblets/engine/fiblets/gather/gathering.py): at the nearest line, and at shares of the distance
// from there to the far end of the data.
//
// Symbols
//   c            1 - window depth, formed on the integers, as float32 loses the digits of far points
//   d            distance along the view, linear in space: (p + q c) / (r + s c), mm or what w counts
//   edges        of the slices, from the nearest line, 0, to the far end, 1

#version 430

uniform usampler2D nearest_depth;
uniform vec4 slice_distances;      // p, q, r, s
uniform float slice_far;           // d of the far end
uniform vec3 slice_edges;

out uvec4 slice_keys;

const uint EMPTY = 0xFFFFFFFFu;

uint key_at(float d) {
    float c = (slice_distances.x - d * slice_distances.z) / (d * slice_distances.w - slice_distances.y);
    return EMPTY - uint(clamp(c, 1e-9, 0.9999999) * 4294967295.0);
}

void main() {
    uint first = texelFetch(nearest_depth, ivec2(gl_FragCoord.xy), 0).x;
    float c = float(EMPTY - first) / 4294967295.0;
    float near = (slice_distances.x + slice_distances.y * c) / (slice_distances.z + slice_distances.w * c), far = max(slice_far, near);
    slice_keys = uvec4(first, EMPTY, EMPTY, EMPTY);
    if (first == EMPTY) return;
    uint last = first;
    for (int k = 0; k < 3; ++k) {
        last = max(last, key_at(mix(near, far, slice_edges[k])));
        slice_keys[k + 1] = last;
    }
}
