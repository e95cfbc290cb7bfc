// How many segments a mesh work group draws, and by how many vertices.
//
// Budget: OpenGL promises a mesh stage 256 vertices, 512 primitives and 16,384 bytes of outputs and shared memory together.
// Shared memory takes 3,328 bytes at most (fiblets/decode/parallel.glsl, fiblets/mesh/together.glsl), a vertex 16 and a primitive 4 bytes for each component
// of fiblets/hardware_raster/varyings.glsl (of nearest thin lines there are 6), and 2 or 3 for its indices:
//
//                         segments   vertices      primitives   components   bytes
//   thin, uncut              60      61            60           11           3,736
//   thin, may be cut         60      120           60           12           4,920
//   wide                     15      60            30           23           3,810    60 in four shares
//
// Sizes that are multiples of 32 fit into the driver's granularity; a wide line's share is as many rectangles as half a warp
// has invocations, less one.

#if FEATURE_WIDE_LINES
const uint SHARE = 15u, SHARES = 4u;
#else
const uint SHARE = 60u, SHARES = 1u;
#endif
