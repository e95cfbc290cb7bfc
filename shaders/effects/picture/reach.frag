// How wide the discs are that may reach into a square of pixels from in front of the plane in focus; -1 if all the light
// that may reach into it, from wherever, is the same.
//
// What lies behind that plane is the less blurred the nearer it is, so a disc that covers a pixel from in front of it is
// no wider than the pixel's own, unless it is one of these.
//
//   tiles      widest discs, from effects/picture/tiles.frag
//   lights     the light of squares that have but one
//   around     squares on each side from which light may come

#version 430

uniform sampler2D tiles;
uniform sampler2D lights;
uniform int around;
out float reach;

const int TILE = {{ tile }};

void main()
{
    ivec2 tile = ivec2(gl_FragCoord.xy), last = textureSize(tiles, 0) - 1;
    vec4 light = texelFetch(lights, tile, 0);
    bool same = light.a >= 0.0;
    reach = 0.0;
    for (int y = max(tile.y - around, 0); y <= min(tile.y + around, last.y); ++y)
    {
        for (int x = max(tile.x - around, 0); x <= min(tile.x + around, last.x); ++x)
        {
            float radius = texelFetch(tiles, ivec2(x, y), 0).r;
            vec2 gap = max(vec2(abs(ivec2(x, y) - tile)) * float(TILE) - float(TILE - 1), 0.0);
            if (length(gap) < radius + 0.5) reach = max(reach, radius);
            same = same && texelFetch(lights, ivec2(x, y), 0) == light;
        }
    }
    if (same) reach = -1.0;
}
