// What all passes over spline tubes share; pvfiblets/engine/tubes/uniform_blocks.py packs it.
//
// Symbols
//   c            share of a derivative that leads from a node to the next control point (tubes/segment.glsl)
//   U            1 - depth is U / W. Where that is small, it has all its digits, and Z / W has lost them
//   place        nodes lie on a lattice of integers: differences are exact however far from the origin they are

layout(std140, binding = 8) uniform Splines {
    vec4 tube_scale;     // x: mm per integer of a place; y: c; z: mm, over W, of half the least width; w: 1 where
                           // derivatives are by length, 0 where they are by the parameter of a segment
    ivec4 tube_counts;   // x: steps of a root search; y: segments
    vec4 tube_rows[8];   // from local mm to X, Y, W of the window and to U = W - Z, each as a sum of two: float64
                           // rounded to float32, and what that leaves
};
