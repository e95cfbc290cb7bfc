// What rays through a volume are made of; pvfiblets/engine/volumes/uniform_blocks.py packs it.
//
// Symbols
//   voxels       place in the volume in voxels: whole at the voxels' centres, 0 to n - 1 along each axis
//   O, D         start and direction of a pixel's ray, in voxels: linear in the pixel's place from the picture's middle. O lies
//                beside the volume however far away the eye is, so that float32 rounds relative to the volume
//   t            mm along the ray from O
//   U, W         1 - depth is U / W

layout(std140, binding = 10) uniform Raycast {
    vec4 ray_start[3];       // O = 0 + x 1 + y 2
    vec4 ray_way[3];         // D likewise
    vec4 ray_to_mm[3];       // columns: from voxels to mm, for directions
    vec4 ray_to_voxels[3];   // rows of its inverse: gradients by voxels times them are gradients by mm
    vec4 ray_depth[2];       // rows: from voxels to U, to W
    vec4 ray_planes[{{ max_planes }}];     // kept where they are not negative: near, far, the caller's
    vec4 ray_low;            // xyz: corners of what is there, in voxels; w: mm of a step
    vec4 ray_high;           // w: opacity at which a ray ends
    vec4 ray_size;           // xyz: voxels along each axis; w: half the picture's width
    vec4 ray_values;         // x, y: scale and shift from what the texture holds; z, w: least and greatest value that is there
    vec4 ray_table;          // x, y: values at the ends of the colours; z: half the picture's height; w: threshold of peaks
    vec4 ray_surfaces[2];    // values of surfaces
    ivec4 ray_counts;        // planes, surfaces, steps of a refinement, topmost level of the octree
    ivec4 ray_levels[{{ max_levels }}];    // of each level: nodes along each axis, place of the first in the list
};
