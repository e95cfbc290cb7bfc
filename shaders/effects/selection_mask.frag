// Key of the pixels that show a chosen streamline, EMPTY elsewhere.
//
//   chosen   r8ui, one texel per streamline, row by row: 0 or 1

#version 430

uniform usampler2D keys;
uniform usampler2D ids;
uniform usampler2D chosen;
out uint key;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    key = texelFetch(keys, pixel, 0).r;
    if (key == 0xFFFFFFFFu) return;
    uint id = texelFetch(ids, pixel, 0).r, row = uint(textureSize(chosen, 0).x);
    ivec2 texel = ivec2(int(id % row), int(id / row));
    if (texel.y >= textureSize(chosen, 0).y || texelFetch(chosen, texel, 0).r == 0u) key = 0xFFFFFFFFu;
}
