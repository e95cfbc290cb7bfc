// The outline of what effects/selection_mask.frag has marked: pixels that are not marked, at most width pixels from one that is.
//
// Out: the nearest key of the marked pixels so near, which is where the outline lies; EMPTY where there is none.

#version 430

uniform usampler2D marked;
uniform float width;
out uint outline;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy), last = textureSize(marked, 0) - 1;
    outline = 0xFFFFFFFFu;
    if (texelFetch(marked, pixel, 0).r != 0xFFFFFFFFu) return;
    int side = int(width);
    for (int y = max(pixel.y - side, 0); y <= min(pixel.y + side, last.y); ++y)
    {
        for (int x = max(pixel.x - side, 0); x <= min(pixel.x + side, last.x); ++x)
        {
            vec2 away = vec2(x - pixel.x, y - pixel.y);
            if (dot(away, away) <= width * width) outline = min(outline, texelFetch(marked, ivec2(x, y), 0).r);
        }
    }
}
