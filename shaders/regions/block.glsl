// The region that the caller drew or asked about: shapes and the expression that joins them. pvfiblets/engine/regions/uniform_block.py
// declares and packs the block, pvfiblets/query/regions/shapes.py says what the unit shapes are.
//
// Symbols
//   u            coordinates in which a leaf is its unit shape, from local millimetres by an affine map that is composed in
//                float64; for leaves with a distance field they are the field's texel coordinates, texel centres at integers
//   slack        greatest error of u: the rounding of p, of the map, of the product, and of the composition

#include "uniforms/Regions.glsl"

const int REGION_AND = -1, REGION_OR = -2, REGION_NOT = -3;
const int REGION_PLANE = 0, REGION_SLAB = 1, REGION_BOX = 2, REGION_SPHERE = 3, REGION_SURFACE = 4, REGION_LABELS = 5;

const float REGION_ROUNDING = 1.0e-6;  // eight times the unit of the last place: half a unit each for p (which may be a
                                       // mean of two anchors), the map's numbers, three products and their sum

vec3 region_unit(int leaf, vec3 p, out vec3 slack) {
    vec4 x = region_rows[3 * leaf], y = region_rows[3 * leaf + 1], z = region_rows[3 * leaf + 2];
    precise vec3 u = vec3(dot(x.xyz, p) + x.w, dot(y.xyz, p) + y.w, dot(z.xyz, p) + z.w);
    vec3 q = abs(p);
    vec3 sizes = vec3(dot(abs(x.xyz), q), dot(abs(y.xyz), q), dot(abs(z.xyz), q)) + abs(vec3(x.w, y.w, z.w));
    slack = REGION_ROUNDING * sizes + region_slacks[leaf];
    return u;
}
