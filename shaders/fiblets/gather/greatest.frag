// The greatest number of lines in each square of {{ greatest_side }} x {{ greatest_side }} pixels.

#version 430

#if FEATURE_GATHER_WORDS
uniform usampler2DArray gathered;
uniform ivec2 word_shape;
#if FEATURE_PAINTED
float lines_of(ivec2 pixel) { return float(texelFetch(gathered, ivec3((pixel + 1) * word_shape - 1, 0), 0).x); }
#else
float lines_of(ivec2 pixel) { return float(texelFetch(gathered, ivec3(pixel, 0), 0).x); }
#endif
#else
uniform sampler2DArray gathered;
float lines_of(ivec2 pixel) { return texelFetch(gathered, ivec3(pixel, 0), 0).w; }
#endif
uniform ivec2 size;    // of the picture

out float greatest;

void main() {
    ivec2 from = ivec2(gl_FragCoord.xy) * {{ greatest_side }}, to = min(from + {{ greatest_side }}, size);
    greatest = 0.0;
    for (int y = from.y; y < to.y; ++y) {
        for (int x = from.x; x < to.x; ++x) greatest = max(greatest, lines_of(ivec2(x, y)));
    }
}
