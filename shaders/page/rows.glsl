// Place of an element of a long array in its texture: in rows of 2^ROW_BITS texels. Where textures hold no rows that long
// the client writes a smaller number (client/src/gl.ts).

const int ROW_BITS = 12;

ivec2 texel(uint index) { return ivec2(int(index & ((1u << uint(ROW_BITS)) - 1u)), int(index >> uint(ROW_BITS))); }
