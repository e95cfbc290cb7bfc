// The greatest number of lines in each square of {{ greatest_side }} x {{ greatest_side }} pixels.

#version 430

#if FEATURE_GATHER_WORDS
uniform usampler2DArray gathered;
#else
uniform sampler2DArray gathered;
#endif
uniform int layer;                 // that holds them
uniform int channel;

out float greatest;

void main() {
    ivec2 from = ivec2(gl_FragCoord.xy) * {{ greatest_side }}, to = min(from + {{ greatest_side }}, textureSize(gathered, 0).xy);
    greatest = 0.0;
    for (int y = from.y; y < to.y; ++y) {
        for (int x = from.x; x < to.x; ++x) {
            vec4 sum = vec4(texelFetch(gathered, ivec3(x, y, layer), 0));
            greatest = max(greatest, channel == 0 ? sum.x : sum.w);
        }
    }
}
