// What rays through a volume are made of; pvfiblets/engine/volumes/uniform_blocks.py declares and packs it.
//
// Symbols
//   voxels       place in the volume in voxels: whole at the voxels' centres, 0 to n - 1 along each axis
//   O, D         start and direction of a pixel's ray, in voxels: linear in the pixel's place from the picture's middle. O lies
//                beside the volume however far away the eye is, so that float32 rounds relative to the volume
//   t            mm along the ray from O
//   U, W         1 - depth is U / W

#include "uniforms/Raycast.glsl"
