// A long list of colours in a texture, row by row: nth_colour().

vec4 nth_colour(sampler2D colours, uint n) {
    uint row = uint(textureSize(colours, 0).x);
    return texelFetch(colours, ivec2(int(n % row), int(n / row)), 0);
}
