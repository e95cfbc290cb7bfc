// The widest disc in front of the plane in focus, of every square of TILE x TILE pixels.

#version 430

uniform sampler2D blurs;
out float radius;

const int TILE = {{ tile }};

void main()
{
    ivec2 corner = ivec2(gl_FragCoord.xy) * TILE, last = textureSize(blurs, 0) - 1;
    radius = 0.0;
    for (int y = corner.y; y <= min(corner.y + TILE - 1, last.y); ++y)
        for (int x = corner.x; x <= min(corner.x + TILE - 1, last.x); ++x)
            radius = max(radius, -texelFetch(blurs, ivec2(x, y), 0).g);
}
