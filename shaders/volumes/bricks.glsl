// A volume in bricks, for those that no 3-D texture takes; pvfiblets/engine/volumes/bricks.py lays them out.
//
// A brick's slices lie one to a layer of a texture, all at the same place of it, beside those of other bricks. Bricks share the voxels
// at their faces, so that each cell lies in one of them: within a slice the hardware interpolates, where it is
// exact enough. Between two slices, which may lie in
// two bricks, the mean is taken here.
//
// Symbols
//   page         a texture, where there are several
//   slot         a brick's number in its page, row by row

uniform sampler2DArray voxels;
#if FEATURE_VOLUME_PAGES
uniform sampler2DArray voxels_1;
uniform sampler2DArray voxels_2;
uniform sampler2DArray voxels_3;
uniform sampler2DArray voxels_4;
uniform sampler2DArray voxels_5;
uniform sampler2DArray voxels_6;
uniform sampler2DArray voxels_7;
#endif
uniform ivec3 brick_step;         // voxels from a brick to the next
uniform ivec3 brick_count;
uniform ivec2 brick_size;         // texels in a layer
uniform ivec2 bricks_in_page;     // columns and rows

// The page of a cell's brick, its corner in texels, and its first voxel.
int brick_of(ivec3 cell, out ivec2 corner, out ivec3 first) {
    ivec3 brick = min(cell / brick_step, brick_count - 1);
    int number = brick.x + brick_count.x * (brick.y + brick_count.y * brick.z), per_page = bricks_in_page.x * bricks_in_page.y;
    int page = number / per_page, slot = number - page * per_page, row = slot / bricks_in_page.x;
    corner = ivec2(slot - row * bricks_in_page.x, row) * brick_size;
    first = brick * brick_step;
    return page;
}

float fetch_page(int page, ivec3 texel) {
#if FEATURE_VOLUME_PAGES
    if (page == 1) return texelFetch(voxels_1, texel, 0).x;
    if (page == 2) return texelFetch(voxels_2, texel, 0).x;
    if (page == 3) return texelFetch(voxels_3, texel, 0).x;
    if (page == 4) return texelFetch(voxels_4, texel, 0).x;
    if (page == 5) return texelFetch(voxels_5, texel, 0).x;
    if (page == 6) return texelFetch(voxels_6, texel, 0).x;
    if (page == 7) return texelFetch(voxels_7, texel, 0).x;
#endif
    return texelFetch(voxels, texel, 0).x;
}

float read_voxel(ivec3 voxel) {
    ivec2 corner;
    ivec3 first;
    int page = brick_of(voxel, corner, first);
    return fetch_page(page, ivec3(corner, 0) + voxel - ivec3(first));
}

float fetched_slice(vec2 p, int z) {
    ivec2 corner, last = ivec2(volume_shape.xy) - 1, cell = clamp(ivec2(p), ivec2(0), max(last - 1, 0));
    ivec3 first;
    int page = brick_of(ivec3(cell, z), corner, first);
    ivec3 a = ivec3(corner + cell - first.xy, z - first.z), b = a + ivec3(min(cell + 1, last) - cell, 0);
    vec2 x = p - vec2(cell);
    vec2 edges = mix(vec2(fetch_page(page, a), fetch_page(page, ivec3(a.x, b.yz))),
                     vec2(fetch_page(page, ivec3(b.x, a.yz)), fetch_page(page, b)), x.x);
    return mix(edges.x, edges.y, x.y);
}

float read_page(int page, vec3 place) {
#if FEATURE_VOLUME_PAGES
    if (page == 1) return textureLod(voxels_1, place, 0.0).x;
    if (page == 2) return textureLod(voxels_2, place, 0.0).x;
    if (page == 3) return textureLod(voxels_3, place, 0.0).x;
    if (page == 4) return textureLod(voxels_4, place, 0.0).x;
    if (page == 5) return textureLod(voxels_5, place, 0.0).x;
    if (page == 6) return textureLod(voxels_6, place, 0.0).x;
    if (page == 7) return textureLod(voxels_7, place, 0.0).x;
#endif
    return textureLod(voxels, place, 0.0).x;
}

float sampled_slice(vec2 p, int z) {
    ivec2 corner;
    ivec3 first;
    int page = brick_of(ivec3(min(ivec2(p), ivec2(volume_shape.xy) - 2), z), corner, first);
    vec2 size = vec2(brick_size * bricks_in_page);
    return read_page(page, vec3((vec2(corner - first.xy) + p + 0.5) / size, float(z - first.z)));
}

float sampled(vec3 p) {
    p = clamp(p, vec3(0.0), volume_shape - 1.0);
    float z = min(floor(p.z), volume_shape.z - 2.0);
    return mix(sampled_slice(p.xy, int(z)), sampled_slice(p.xy, int(z) + 1), p.z - z);
}

float fetched(vec3 p) {
    p = clamp(p, vec3(0.0), volume_shape - 1.0);
    float z = min(floor(p.z), volume_shape.z - 2.0);
    return mix(fetched_slice(p.xy, int(z)), fetched_slice(p.xy, int(z) + 1), p.z - z);
}
