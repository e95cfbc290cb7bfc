// Functions of GLSL 4.00 that 3.30 lacks, for the geometry pipeline on OpenGL 3.3.
#define precise
uint bitfieldExtract(uint value, int offset, int bits) {
    return bits == 32 ? value : (value >> uint(offset)) & ((1u << uint(bits)) - 1u);
}
int bitfieldExtract(int value, int offset, int bits) {
    return bits == 32 ? value : (value << (32 - offset - bits)) >> (32 - bits);
}
int bitCount(uint value) {
    int bits = 0;
    for (; value != 0u; value &= value - 1u) ++bits;
    return bits;
}
// Index of the lowest bit set, and of the highest; -1 where there is none.
int findLSB(uint value) { return value == 0u ? -1 : bitCount((value & (~value + 1u)) - 1u); }
int findMSB(uint value) {
    int at = value == 0u ? -1 : 0;
    for (int width = 16; width > 0; width >>= 1) {
        if ((value >> uint(width)) != 0u) { value >>= uint(width); at += width; }
    }
    return at;
}
int findMSB(int value) { return findMSB(uint(value < 0 ? ~value : value)); }
uint packUnorm4x8(vec4 value) {
    uvec4 bytes = uvec4(round(clamp(value, 0.0, 1.0) * 255.0));
    return bytes.x | bytes.y << 8u | bytes.z << 16u | bytes.w << 24u;
}
vec4 unpackUnorm4x8(uint word) { return vec4(word & 255u, word >> 8u & 255u, word >> 16u & 255u, word >> 24u) / 255.0; }
