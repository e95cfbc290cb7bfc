// Whether a position of the picture lies in the caller's region: by the window depths at which the region begins and ends
// along each pixel's ray, which pvfiblets/engine/regions/ray_intervals.py draws for a camera.
//
// This work is based on: Schertzer et al. 2022, section 5.1 and figure 10, which keep one front and one back depth of a
// mesh, hence cut right by convex ones. Here a pixel has as many as there are.
//
// Symbols
//   z            window depth in 0..1, before it becomes a key
//   boundary     depth from which on the region holds, or no longer holds; ascending, four to a texel and layer. One of -1
//                comes first where the region holds in front of them all; 2 stands where there are no more.
//
// The region holds at z if an odd number of boundaries is not beyond it.

uniform sampler2DArray region_boundaries;
uniform int region_layers;

// The boundary number k, from 0; 2 behind the last.
float region_boundary(ivec2 pixel, int k) {
    return k < 4 * region_layers ? texelFetch(region_boundaries, ivec3(pixel, k >> 2), 0)[k & 3] : 2.0;
}

bool region_keeps(ivec2 pixel, float z) {
    bool kept = false;
    for (int layer = 0; layer < region_layers; ++layer) {
        vec4 boundaries = texelFetch(region_boundaries, ivec3(pixel, layer), 0);
        bvec4 before = lessThanEqual(boundaries, vec4(z));
        kept = kept != (((int(before.x) + int(before.y) + int(before.z) + int(before.w)) & 1) == 1);
        if (!before.w) break;
    }
    return kept;
}
