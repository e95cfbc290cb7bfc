// The nearest distance of every tile of {{ tile }} x {{ tile }} pixels; NOTHING for empty tiles.

#version 430

uniform sampler2D distances;
out float nearest;

const int TILE = {{ tile }};

void main()
{
    ivec2 corner = ivec2(gl_FragCoord.xy) * TILE, last = textureSize(distances, 0) - 1;
    nearest = 3.0e38;
    for (int y = corner.y; y <= min(corner.y + TILE - 1, last.y); ++y)
        for (int x = corner.x; x <= min(corner.x + TILE - 1, last.x); ++x)
            nearest = min(nearest, texelFetch(distances, ivec2(x, y), 0).r);
}
