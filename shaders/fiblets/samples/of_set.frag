// Depths of a layer (fiblets/samples/layer.frag) where it shows one of several sets.

#version 430

uniform usampler2D drawn_depth;
uniform usampler2D shares;
uniform uint set;

out uint depth;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    bool shown = texelFetch(shares, at, 0).x >> 17u == set;
    depth = shown ? texelFetch(drawn_depth, at, 0).x : 0xFFFFFFFFu;
}
