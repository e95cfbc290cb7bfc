// What all passes over spline tubes share; pvfiblets/engine/tubes/uniform_blocks.py declares and packs it.
//
// Symbols
//   c            share of a derivative that leads from a node to the next control point (tubes/segment.glsl)
//   U            1 - depth is U / W. Where that is small, it has all its digits, and Z / W has lost them
//   place        nodes lie on a lattice of integers: differences are exact however far from the origin they are

#include "uniforms/Splines.glsl"
