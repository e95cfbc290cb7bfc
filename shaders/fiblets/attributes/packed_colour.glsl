// Colours of points in place of per-point values: whole numbers that float32 holds exactly, so that textures of floats can carry them.
//
//   c            colour, RGBA, each channel in 0..1
//   opaque       r + 2^8 g + 2^16 b, channels in 0..255
//   else         -1 - (r + 2^6 g + 2^12 b + 2^18 a), channels in 0..63
//
// shaders/colour/point_packed.glsl unpacks them.

float packed_colour(vec4 c, bool opaque) {
    if (opaque) return dot(floor(255.0 * c.rgb + 0.5), vec3(1.0, 256.0, 65536.0));
    return -1.0 - dot(floor(63.0 * c + 0.5), vec4(1.0, 64.0, 4096.0, 262144.0));
}

vec4 unpacked_colour(float value) {
    bool opaque = value >= 0.0;
    int n = int(opaque ? value : -1.0 - value), bits = opaque ? 8 : 6, most = (1 << bits) - 1;
    vec4 c = vec4(n & most, (n >> bits) & most, (n >> (2 * bits)) & most, (n >> (3 * bits)) & most) / float(most);
    return vec4(c.rgb, opaque ? 1.0 : c.a);
}
