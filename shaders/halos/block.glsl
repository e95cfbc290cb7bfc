// What all passes over lines and points with halos share; pvfiblets/engine/halos/uniform_blocks.py declares and packs it.
//
// Symbols
//   w_line, w_strip, d_max, f, n_tapered, t_tapered    of Everts et al. 2009, sections 3.2 to 3.4; here mm of the data
//   window       (X, Y, U, W), homogeneous: X / W and Y / W are pixels from the picture's middle, 1 - depth is U / W
//   reach        pixels times W: the length of a mm on the screen, times W, does not depend on where it is

#include "uniforms/Halos.glsl"
