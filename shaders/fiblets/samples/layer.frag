// One layer of the lines that pixels' samples show (fiblets/samples/entries.frag): the k-th of each pixel, as a G-buffer, and in
// place of the owner the number of samples that show it. What is left in the last layer that there may be counts to its line.
//
//   entries, drawn_depth, drawn_ids, drawn_position   of the samples of a part of the picture
//   corner                                            pixel of the picture where that part begins

#version 430

uniform usampler2D entries;
uniform usampler2D drawn_depth;
uniform usampler2D drawn_ids;
uniform sampler2D drawn_position;
uniform int layer;
uniform int last;       // whether it is the last one that there may be
uniform ivec2 corner;

layout(location = 0) out uint depth;
layout(location = 1) out uint samples;
layout(location = 2) out uvec2 ids;
layout(location = 3) out vec2 position;

uint entry_of(uvec4 words, int k) { return (words[k >> 2] >> (8 * (k & 3))) & 0xFFu; }

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy) - corner;
    uvec4 words = texelFetch(entries, pixel, 0);
    uint before = 0u;
    for (int k = 0; k < layer; ++k) before += (entry_of(words, k) >> 4u) + 1u;
    if (before >= 16u) discard;
    uint entry = entry_of(words, layer), number = entry & 15u;
    ivec2 at = 4 * pixel + ivec2(number & 3u, number >> 2u);
    depth = texelFetch(drawn_depth, at, 0).x;
    samples = last != 0 ? 16u - before : (entry >> 4u) + 1u;
    ids = texelFetch(drawn_ids, at, 0).xy;
    position = texelFetch(drawn_position, at, 0).xy;
}
