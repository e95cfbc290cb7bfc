// What GLSL 3.30 lacks of 4.00, for the geometry pipeline on OpenGL 3.3.
#define precise
uint bitfieldExtract(uint value, int offset, int bits) {
    return bits == 32 ? value : (value >> uint(offset)) & ((1u << uint(bits)) - 1u);
}
int bitfieldExtract(int value, int offset, int bits) {
    return bits == 32 ? value : (value << (32 - offset - bits)) >> (32 - bits);
}
// Of the highest bit set; -1 where there is none.
int findMSB(uint value) {
    int at = value == 0u ? -1 : 0;
    for (int width = 16; width > 0; width >>= 1) {
        if ((value >> uint(width)) != 0u) { value >>= uint(width); at += width; }
    }
    return at;
}
int findMSB(int value) { return findMSB(uint(value < 0 ? ~value : value)); }
