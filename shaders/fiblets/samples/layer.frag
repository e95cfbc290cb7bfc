// One layer of the lines that pixels' samples show (fiblets/samples/entries.frag): the k-th of each pixel, as a G-buffer, and in
// place of the owner the share of the pixel that shows it, in 65536ths, and above its 17 bits the line's set. Where samples show more lines than there may be layers,
// those that are left out count in proportion to the lines that are not: what no line covers keeps its share.
//
//   entries, drawn_depth, drawn_ids, drawn_position   of the samples of a part of the picture
//   drawn_set                                         where samples are `claimed`: a sample's
//   others                                            whether there is more than lines: it has no share here
//   corner                                            pixel of the picture where that part begins

#version 430

uniform usampler2D entries;
uniform usampler2D drawn_depth;
uniform usampler2D drawn_set;
uniform usampler2D drawn_ids;
uniform sampler2D drawn_position;
uniform int layer;
uniform int layers;     // that there may be
uniform int claimed;
uniform int others;
uniform ivec2 corner;

layout(location = 0) out uint depth;
layout(location = 1) out uint share;
layout(location = 2) out uvec2 ids;
layout(location = 3) out vec2 position;

uint samples_of(uint entry) { return (entry >> 4u) + 1u; }

ivec2 place_of(uint entry, ivec2 pixel) { return 4 * pixel + ivec2(entry & 3u, (entry >> 2u) & 3u); }

bool shows_line(ivec2 at) {
    return claimed != 0 ? texelFetch(drawn_set, at, 0).x != 0x7FFFu : texelFetch(drawn_depth, at, 0).x != 0xFFFFFFFFu;
}

uint entry_of(uvec4 words, int k) { return (words[k >> 2] >> (8 * (k & 3))) & 0xFFu; }

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy) - corner;
    uvec4 words = texelFetch(entries, pixel, 0);
    uint listed = 0u, before = 0u;
    for (int k = 0; k < layers && listed < 16u; ++k) {
        if (k == layer) before = listed;
        listed += samples_of(entry_of(words, k));
        if (listed >= 16u && k < layer) discard;
    }
    uint first = entry_of(words, 0), entry = entry_of(words, layer);
    uint none = shows_line(place_of(first, pixel)) ? 0u : samples_of(first);
    ivec2 at = place_of(entry, pixel);
    bool empty = layer == 0 && none > 0u;
    depth = empty ? 0xFFFFFFFFu : texelFetch(drawn_depth, at, 0).x;
    // Rounded so that all together are 65536.
    uint of_lines = 4096u * (16u - none), lines = max(listed - none, 1u), from = before - min(before, none);
    uint part = empty ? (others != 0 ? 0u : 4096u * none)
        : of_lines * (from + samples_of(entry)) / lines - of_lines * from / lines;
    share = part | (claimed != 0 ? texelFetch(drawn_set, at, 0).x << 17u : 0u);
    ids = texelFetch(drawn_ids, at, 0).xy;
    position = texelFetch(drawn_position, at, 0).xy;
}
