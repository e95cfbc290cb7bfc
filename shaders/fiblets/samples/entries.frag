// Which lines the sixteen samples of a pixel show: of each, how many samples, and one sample that stands for them.
//
// Samples of a streamline that bends within the pixel count as lines of their own, by the tangents that their light depends on.
//
//   drawn_depth   by sample (FEATURE_SUBSAMPLES), 4 x 4 texels a pixel
//   drawn_ids     streamlines and tangents
//   drawn_set     sets, 0x7FFF where no line is, if samples are `claimed` (fiblets/samples/claim.frag): there are several, or other
//                 things than lines; else no line is where the depth is 0xFFFFFFFF
//   entries       16 bytes, from the lowest, that of no line first, then those with most samples: 16 (samples - 1) + the
//                 sample's number

#version 430

uniform usampler2D drawn_depth;
uniform usampler2D drawn_ids;
uniform usampler2D drawn_set;
uniform int claimed;
out uvec4 entries;

const int ALIKE = 3000;   // of the 32767 steps of a tangent's packed halves

bool alike(uint one, uint other) {
    ivec2 apart = abs(ivec2(int(one << 16) >> 16, int(one) >> 16) - ivec2(int(other << 16) >> 16, int(other) >> 16));
    return max(apart.x, apart.y) <= ALIKE;
}

// samples: a bit each
uint entry_of(uint samples) {
    uint many = uint(bitCount(samples)), middle = samples;
    for (uint skipped = (many - 1u) / 2u; skipped > 0u; --skipped) middle &= middle - 1u;
    return (many - 1u) << 4u | uint(findLSB(middle));
}

void main() {
    ivec2 at = 4 * ivec2(gl_FragCoord.xy);
    uint lines[16], tangents[16], sets[16];
    uint differing = 0u, none = 0u;
    for (int i = 0; i < 16; ++i) {
        ivec2 sample_at = at + ivec2(i & 3, i >> 2);
        uint set = claimed != 0 ? texelFetch(drawn_set, sample_at, 0).x : 0u;
        bool empty = claimed != 0 ? set == 0x7FFFu : texelFetch(drawn_depth, sample_at, 0).x == 0xFFFFFFFFu;
        uvec2 ids = empty ? uvec2(0u) : texelFetch(drawn_ids, sample_at, 0).xy;
        lines[i] = ids.x;
        tangents[i] = ids.y;
        sets[i] = empty ? 0u : set;
        none |= empty ? 1u << i : 0u;
        differing |= (lines[i] ^ lines[0]) | (sets[i] ^ sets[0]) | (alike(tangents[i], tangents[0]) ? 0u : 1u);
    }
    if (none != 0xFFFFu) differing |= none;
    entries = uvec4(0xF0u, 0u, 0u, 0u);
    if (differing == 0u) return;
    uint found[16], left = 0xFFFFu;
    int count = 0;
    if (none != 0u) {
        found[count++] = entry_of(none);
        left &= ~none;
    }
    int first_line = count;
    for (; left != 0u; ++count) {
        int first = findLSB(left);
        uint line = lines[first], set = sets[first], tangent = tangents[first], same = 0u;
        for (int i = 0; i < 16; ++i) same |= lines[i] == line && sets[i] == set && alike(tangents[i], tangent) ? 1u << i : 0u;
        same &= left;
        left &= ~same;
        uint entry = entry_of(same);
        int place = count;
        for (; place > first_line && found[place - 1] < entry; --place) found[place] = found[place - 1];
        found[place] = entry;
    }
    entries = uvec4(0u);
    for (int i = 0; i < count; ++i) entries[i >> 2] |= found[i] << (8 * (i & 3));
}
