// How wide the discs are that may reach into a square of pixels from in front of the plane in focus.
//
// What lies behind that plane is the less blurred the nearer it is, so a disc that covers a pixel from in front of it is
// no wider than the pixel's own, unless it is one of these.

#version 430

uniform sampler2D tiles;
uniform int around;      // squares to look at on each side
out float reach;

const int TILE = {{ tile }};

void main()
{
    ivec2 tile = ivec2(gl_FragCoord.xy), last = textureSize(tiles, 0) - 1;
    reach = 0.0;
    for (int y = max(tile.y - around, 0); y <= min(tile.y + around, last.y); ++y)
    {
        for (int x = max(tile.x - around, 0); x <= min(tile.x + around, last.x); ++x)
        {
            float radius = texelFetch(tiles, ivec2(x, y), 0).r;
            vec2 gap = max(vec2(abs(ivec2(x, y) - tile)) * float(TILE) - float(TILE - 1), 0.0);
            if (length(gap) < radius + 0.5) reach = max(reach, radius);
        }
    }
}
