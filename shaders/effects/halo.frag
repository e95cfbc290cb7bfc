// Depth-dependent halos (Everts et al. 2009, section 3.3), gathered from the picture instead of drawn as strips.
//
// Every pixel q that shows a line, at distance z(q), gives the pixels p around it a halo at the distance
//
//   z(q) + depth * |p - q| / w(q),   |p - q| <= w(q) = min(width in pixels at z(q), widest)          equation (3), f(x) = x
//
// The nearest halo of a pixel shows where it is nearer than the pixel's own line. As its depth grows with |p - q|, lines
// that lie side by side at about one depth leave each other alone, and the wider apart two lines are in depth, the wider
// is the gap that the front one cuts into the other.
//
// Exact, with few fetches: pixels are looked at by tiles. A tile whose nearest line is at t and whose nearest pixel is d
// away gives no halo nearer than t + depth * d / w(t), because w falls with the distance; and none at all if d > w(t).
//
//   distances   r32f, of pixels        tiles    r32f, the nearest of TILE x TILE pixels
//   width       mm                     depth    mm
//   widest      pixels                 reach    pixels; no halo of this picture is wider
//
// Out: key of the halo, EMPTY where the pixel shows none.

#version 430

#include "effects/view_position.glsl"

uniform sampler2D distances;
uniform sampler2D tiles;
uniform float width;
uniform float depth;
uniform float widest;
uniform int reach;
out uint halo;

const int TILE = {{ tile }};

float width_at(float distance)
{
    return min(width * pixels_per_mm(distance), widest);
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy), last = textureSize(distances, 0) - 1;
    float own = texelFetch(distances, pixel, 0).r;
    float best = own;
    ivec2 low = max(pixel - reach, 0), high = min(pixel + reach, last);
    for (int ty = low.y / TILE; ty <= high.y / TILE; ++ty)
    {
        for (int tx = low.x / TILE; tx <= high.x / TILE; ++tx)
        {
            float front = texelFetch(tiles, ivec2(tx, ty), 0).r;
            if (front >= best) continue;
            float span = width_at(front);
            ivec2 corner = ivec2(tx, ty) * TILE;
            float away = length(vec2(max(max(corner - pixel, pixel - corner - (TILE - 1)), 0)));
            if (away > span || front + depth * away / span >= best) continue;
            int side = int(span);
            ivec2 from = max(corner, pixel - side), to = min(min(corner + (TILE - 1), pixel + side), last);
            for (int y = from.y; y <= to.y; ++y)
            {
                for (int x = from.x; x <= to.x; ++x)
                {
                    float there = texelFetch(distances, ivec2(x, y), 0).r;
                    if (there >= best) continue;
                    float w = width_at(there), d = length(vec2(x - pixel.x, y - pixel.y));
                    if (d <= w) best = min(best, there + depth * d / w);
                }
            }
        }
    }
    halo = EMPTY;
    if (best < own)
    {
        // What is nearer in float may round to the same key.
        uint key = texelFetch(keys, pixel, 0).r;
        halo = min(key_at(pixel, best), max(key, 1u) - 1u);
    }
}
