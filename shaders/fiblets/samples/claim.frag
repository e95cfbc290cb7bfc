// The set of each sample (fiblets/samples/entries.frag): this one where a fiblet of it has taken the sample. Before, it is 0x7FFF.
//
//   drawn_owner   fiblets of this set; 0xFFFFFFFF where it does not show
//   set           its number

#version 430

uniform usampler2D drawn_owner;
uniform uint set;

out uint claimed;

void main() {
    if (texelFetch(drawn_owner, ivec2(gl_FragCoord.xy), 0).x == 0xFFFFFFFFu) discard;
    claimed = set;
}
